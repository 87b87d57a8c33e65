#include "runtime/machine/threaded_code.hpp"

#include <array>

#include "runtime/machine/meaning.hpp"

// Direct-threaded code (J. R. Bell, "Threaded code", CACM 16(6), 1973): every handler ends in a jump of its own to the
// next one, so that a processor predicts each by what came before it. GCC would merge these jumps into one again: the
// options that stop it stand in runtime/CMakeLists.txt.

namespace wale {
namespace {

/// A handler for each operation and each choice of operands that are the last result: a counts 1, b 2.
constexpr unsigned forwardings = 4;
/// No operation has this number: it ends the code.
constexpr unsigned stop = 0;

constexpr unsigned handler_number(unsigned operation, unsigned forwarded) {
  return operation * forwardings + forwarded;
}

constexpr std::size_t handlers = [] {
  std::size_t end = 0;
  for (std::size_t number = 0; number < operation_table.size(); ++number)
    if (!operation_table[number].name.empty()) end = handler_number(static_cast<unsigned>(number) + 1, 0);
  return end;
}();

/// Runs one instruction and gives its first result, which the next one may take as `last`.
template <Operation operation, unsigned forwarded>
[[gnu::always_inline]] inline float step(const ThreadedInstruction& i, [[maybe_unused]] float last, float* registers,
                                         [[maybe_unused]] const LaneLookups& lookups) {
  const float a = (forwarded & 1) != 0 ? last : registers[i.a];
  [[maybe_unused]] const float b = (forwarded & 2) != 0 ? last : registers[i.b];
  float* results = registers + i.destination;
  const auto three = [results](const auto& sample) {
    results[0] = sample.value;
    results[1] = sample.along_a;
    results[2] = sample.along_b;
    return sample.value;
  };
  if constexpr (operation == Operation::sample) {
    return three(sample_of(lookups.splines[i.c], a, b));
  } else if constexpr (operation == Operation::recall) {
    return three(recall_of(lookups.grids[i.c], lookups.cells, a, b));
  } else if constexpr (operation == Operation::cell) {
    return *results = lookups.cells[cell_at(lookups.grids[i.c], a, b)];
  } else if constexpr (operation == Operation::peak) {
    return last;  // setup's alone, which is not decoded
  } else if constexpr (operation == Operation::limit) {
    // What is within stays as it is. The branch is foreseen, where a minimum and a maximum would be waited for. These
    // flush subnormals, so such are left to them.
    const bool within = a >= -b && a <= b && absolute(a) >= arithmetic::least_normal;
    if (within) [[likely]]
      return *results = a;
    return *results = limited(a, b);
  } else {
    return *results = Meaning<operation>::of(a, b, registers[i.c]);
  }
}

// clang-format off
#define WALE_ALL_FORWARDINGS(name) WALE_HANDLER(name, 0) WALE_HANDLER(name, 1) WALE_HANDLER(name, 2) WALE_HANDLER(name, 3)
#define WALE_STEP(name, forwarded) step<Operation::name, forwarded>(*at, last, registers, lookups)
// clang-format on

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void run_by_switch(const ThreadedInstruction* at, const LaneLookups& lookups, float* registers) noexcept {
  for (float last = 0;; ++at) {
    // clang-format off
    switch (at->handler) {
#define WALE_HANDLER(name, forwarded) \
      case handler_number(static_cast<unsigned>(Operation::name), forwarded): last = WALE_STEP(name, forwarded); break;
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) WALE_ALL_FORWARDINGS(name)
#define SPECIAL(number, name, fields, results, cost) WALE_ALL_FORWARDINGS(name)
#include "schema/instruction.def"
#undef WALE_HANDLER
      default: return;
    }
    // clang-format on
  }
}

#if defined(__GNUC__) && !defined(WALE_PORTABLE_DISPATCH)

using Labels = std::array<std::uintptr_t, handlers>;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"  // labels have no address in ISO C++

/// Runs code whose handlers are labels of this function; given none, says where they are.
__attribute__((noinline, flatten)) void run_by_goto(const ThreadedInstruction* at, const LaneLookups& lookups,
                                                    float* registers, Labels* labels) noexcept {
  float last = 0;
  if (at == nullptr) [[unlikely]] {
    // clang-format off
#define WALE_HANDLER(name, forwarded) \
    (*labels)[handler_number(static_cast<unsigned>(Operation::name), forwarded)] = \
        reinterpret_cast<std::uintptr_t>(&&name##_##forwarded);
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) WALE_ALL_FORWARDINGS(name)
#define SPECIAL(number, name, fields, results, cost) WALE_ALL_FORWARDINGS(name)
#include "schema/instruction.def"
#undef WALE_HANDLER
    // clang-format on
    (*labels)[stop] = reinterpret_cast<std::uintptr_t>(&&finish);
    return;
  }
  goto* reinterpret_cast<const void*>(at->handler);
  // clang-format off
#define WALE_HANDLER(name, forwarded)                  \
  name##_##forwarded:                                  \
    last = WALE_STEP(name, forwarded);                 \
    ++at;                                              \
    goto* reinterpret_cast<const void*>(at->handler);
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) WALE_ALL_FORWARDINGS(name)
#define SPECIAL(number, name, fields, results, cost) WALE_ALL_FORWARDINGS(name)
#include "schema/instruction.def"
#undef WALE_HANDLER
  // clang-format on
finish:;
}

#pragma GCC diagnostic pop

const Labels& labels() {
  static const Labels all = [] {
    Labels found{};
    run_by_goto(nullptr, {}, nullptr, &found);
    return found;
  }();
  return all;
}

#endif

/// What the handlers are called under a way of dispatch, by number; null where by their numbers.
const std::uintptr_t* handler_names([[maybe_unused]] Dispatch dispatch) {
#if defined(__GNUC__) && !defined(WALE_PORTABLE_DISPATCH)
  if (dispatch == Dispatch::computed_goto) return labels().data();
#endif
  return nullptr;
}

}  // namespace

ThreadedCode decode_threaded(std::span<const Instruction> code, Dispatch dispatch) {
  ThreadedCode decoded;
  if (fastest_dispatch == Dispatch::portable_switch) dispatch = fastest_dispatch;
  decoded.dispatch = dispatch;
  const std::uintptr_t* names = handler_names(dispatch);
  const auto named = [names](unsigned number) { return names ? names[number] : std::uintptr_t{number}; };
  decoded.instructions.resize(code.size() + 1);
  ThreadedInstruction* next = decoded.instructions.data();
  constexpr unsigned nothing = register_limit;  // no register: what comes before the first instruction
  unsigned last = nothing;
  for (const Instruction& i : code) {
    const int operands = operation_table[i.operation].operands;
    const unsigned forwarded = (operands > 0 && i.a == last ? 1u : 0u) | (operands > 1 && i.b == last ? 2u : 0u);
    *next++ = {named(handler_number(i.operation, forwarded)), i.destination, i.a, i.b, i.c};
    last = i.destination;
  }
  *next = {named(stop)};
  return decoded;
}

void run_threaded(const ThreadedCode& code, const LaneLookups& lookups, float* registers) noexcept {
#if defined(__GNUC__) && !defined(WALE_PORTABLE_DISPATCH)
  if (code.dispatch == Dispatch::computed_goto) {
    return run_by_goto(code.instructions.data(), lookups, registers, nullptr);
  }
#endif
  run_by_switch(code.instructions.data(), lookups, registers);
}

}  // namespace wale
