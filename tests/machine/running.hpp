#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

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

/// Puts a picture of straight-line code together: constants first, then instructions that each get a new temporary.
class Sketch {
 public:
  Sketch() { program_ = least(); }

  RegisterNumber constant(float value) {
    program_.constants.push_back(value);
    return static_cast<RegisterNumber>(first_constant + program_.constants.size() - 1);
  }

  /// The program with `code` for its picture, where temporaries are written as 1000, 1001, …
  PatchProgram picture(std::vector<Instruction> code, unsigned relief, unsigned temporaries) {
    program_.temporaries = static_cast<std::uint16_t>(temporaries);
    const unsigned first = program_.first_temporary();
    const auto place = [first](RegisterNumber& number) {
      if (number >= 1000) number = static_cast<RegisterNumber>(number - 1000 + first);
    };
    for (Instruction& i : code) {
      place(i.destination);
      place(i.a);
      place(i.b);
      place(i.c);
    }
    auto value = static_cast<RegisterNumber>(relief);
    place(value);
    program_.picture = {std::move(code), value};
    program_.tick = {instruction(Operation::limit, first, 16, 17)};
    program_.outputs = {{OutputQuantity::force, 0, static_cast<RegisterNumber>(first), 17},
                        {OutputQuantity::force, 1, static_cast<RegisterNumber>(first), 17}};
    return program_;
  }

  PatchProgram& program() { return program_; }

 private:
  PatchProgram program_;
};

}  // namespace wale::example
