#include "runtime/machine/single.hpp"

#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/meaning.hpp"

namespace wale {
namespace {

// Not inlined; see FloatingPointMode.
[[gnu::noinline]] float evaluate(Operation operation, float a, float b, float c) {
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) \
  case Operation::name: return Meaning<Operation::name>::of(a, b, c);
#define SPECIAL(number, name, fields, results, cost) \
  case Operation::name: break;
#include "wale/instruction.def"
  }
  // clang-format on
  return 0;
}

}  // namespace

float result_of(Operation operation, float a, float b, float c) {
  const FloatingPointMode mode;
  return evaluate(operation, a, b, c);
}

}  // namespace wale
