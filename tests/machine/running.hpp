#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "runtime/machine/verify.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/program.hpp"

namespace wale::example {

/// Loads a program that is expected to load.
inline Program loaded(PatchProgram program) {
  auto result = Program::load(std::move(program));
  if (const auto* refusal = std::get_if<Refusal>(&result)) throw std::runtime_error(refusal->reason);
  return std::get<Program>(result);
}

/// The reason for which `verify` refuses, or nothing.
inline std::string refusal_of(const PatchProgram& program) {
  const auto refusal = verify(program);
  return refusal ? refusal->reason : "";
}

}  // namespace wale::example
