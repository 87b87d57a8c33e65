#pragma once

#include "runtime/machine/arithmetic.hpp"
#include "wale/instruction.hpp"

namespace wale {

/// The result of an operation on its operands, for all interpreters: the column `meaning` of
/// `schema/include/wale/instruction.def`. SPECIAL operations have none.
template <Operation>
struct Meaning;

// clang-format off
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative)                                 \
  template <>                                                                                                 \
  struct Meaning<Operation::name> {                                                                           \
    static float of([[maybe_unused]] float a, [[maybe_unused]] float b, [[maybe_unused]] float c) {           \
      return meaning;                                                                                         \
    }                                                                                                         \
  };
#include "wale/instruction.def"
// clang-format on

}  // namespace wale
