#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "runtime/machine/verify.hpp"
#include "schema/without_place.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/program.hpp"

namespace wale::example {

/// Loads a valid program. Throws std::runtime_error where it is refused.
inline Program loaded(PatchProgram program) {
  auto result = Program::load(std::move(program));
  if (!result) throw std::runtime_error(in_words(result.error()));
  return *result;
}

/// The sentence with which `verify` refuses the program; empty when it accepts it.
inline std::string refusal_of(const PatchProgram& program) {
  const auto verified = verify(program);
  return verified ? "" : in_words_without_place(verified.error());
}

}  // namespace wale::example
