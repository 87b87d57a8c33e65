#include "runtime/machine/threaded_code.hpp"

#include <algorithm>
#include <array>

#include "runtime/machine/lane_spline.hpp"
#include "runtime/machine/meaning.hpp"

// Direct-threaded code (J. R. Bell, "Threaded code", CACM 16(6), 1973). Each handler is a function that ends with a
// jump to the next one. Values that all handlers need stay in the registers of the calling convention, each handler
// saves only the registers that it uses, and the processor predicts each handler's jump separately.

// A function must end with a jump to the next one, or the stack would grow with the program. GCC and Clang make that
// jump when they optimise and no work is left at the function's end; sanitizers leave some. With sanitizers, other
// compilers or WALE_PORTABLE_DISPATCH only the switch is built. tests/machine/threaded_code.cpp checks the stack.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WALE_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define WALE_SANITIZED
#endif
#endif
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(WALE_SANITIZED) && !defined(WALE_PORTABLE_DISPATCH)
#define WALE_TAIL_CALLS
#endif

namespace wale {
namespace {

/// Each operation has a handler for each choice of operands that are the last result: a counts 1, b 2.
constexpr unsigned forwardings = 4;
/// No operation has this number: it ends the code.
constexpr unsigned stop = 0;

constexpr unsigned handler_number(unsigned operation, unsigned forwarded) {
  return operation * forwardings + forwarded;
}

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
    return three(sample_in_lane(lookups.splines[i.c], a, b));
  } else if constexpr (operation == Operation::recall) {
    return three(recall_of(lookups.grids[i.c], lookups.cells, a, b));
  } else if constexpr (operation == Operation::cell) {
    return *results = lookups.cells[cell_at(lookups.grids[i.c], a, b)];
  } else if constexpr (operation == Operation::select) {
    return *results = registers[a != 0.0f ? i.b : i.c];
  } else if constexpr (operation == Operation::peak) {
    return last;  // only setup has peaks, and it is not decoded
  } else if constexpr (operation == Operation::limit) {
    // The processor predicts this branch; the next instruction would have to wait for a minimum and a maximum.
    if (absolute(a) <= b) [[likely]]
      return *results = a;
    return *results = limited(a, b);
  } else {
    return *results = Meaning<operation>::of(a, b, registers[i.c]);
  }
}

// clang-format off
#define WALE_ALL_FORWARDINGS(name) \
  WALE_HANDLER(name, 0) WALE_HANDLER(name, 1) WALE_HANDLER(name, 2) WALE_HANDLER(name, 3)
#define WALE_STEP(name, forwarded) step<Operation::name, forwarded>(*at, last, registers, lookups)
// clang-format on

#if defined(WALE_TAIL_CALLS)
[[gnu::cold]]  // only compared with the others there: small
#endif
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
#include "wale/instruction.def"
#undef WALE_HANDLER
      default: return;
    }
    // clang-format on
  }
}

#if defined(WALE_TAIL_CALLS)

constexpr std::size_t handlers = [] {
  std::size_t end = 0;
  for (std::size_t number = 0; number < operation_table.size(); ++number)
    if (!operation_table[number].name.empty()) end = handler_number(static_cast<unsigned>(number) + 1, 0);
  return end;
}();

using Handler = void (*)(const ThreadedInstruction* at, const LaneLookups& lookups, float* registers,
                         float last) noexcept;

// The asm keeps the increment of `at` in place; without it GCC computes the next pointer in a copy and moves it back.
#define WALE_RUN_FROM_HERE                                          \
  last = step<operation, forwarded>(*at, last, registers, lookups); \
  ++at;                                                             \
  asm("" : "+r"(at));                                               \
  return reinterpret_cast<Handler>(at->handler)(at, lookups, registers, last)

template <Operation operation, unsigned forwarded>
void run_from(const ThreadedInstruction* at, const LaneLookups& lookups, float* registers, float last) noexcept {
  WALE_RUN_FROM_HERE;
}

#if defined(__x86_64__)
template <Operation operation, unsigned forwarded>
[[gnu::target("avx")]] void run_wide_from(const ThreadedInstruction* at, const LaneLookups& lookups, float* registers,
                                          float last) noexcept {
  WALE_RUN_FROM_HERE;
}

bool has_wide_instructions() { return __builtin_cpu_supports("avx") != 0; }
#else
bool has_wide_instructions() { return false; }
#endif

template <bool wide, Operation operation, unsigned forwarded>
constexpr Handler handler() {
#if defined(__x86_64__)
  if (wide) return run_wide_from<operation, forwarded>;
#endif
  return run_from<operation, forwarded>;
}

void finish(const ThreadedInstruction*, const LaneLookups&, float*, float) noexcept {}

template <bool wide>
constexpr auto handlers_by_number = [] {
  std::array<Handler, handlers> all{};
  all[stop] = finish;
  // clang-format off
#define WALE_HANDLER(name, forwarded)                                        \
  all[handler_number(static_cast<unsigned>(Operation::name), forwarded)] = \
      handler<wide, Operation::name, forwarded>();
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) WALE_ALL_FORWARDINGS(name)
#define SPECIAL(number, name, fields, results, cost) WALE_ALL_FORWARDINGS(name)
#include "wale/instruction.def"
#undef WALE_HANDLER
  // clang-format on
  return all;
}();

#endif

/// The number or address of an instruction's handler under a dispatch.
std::uintptr_t handler_of(unsigned number, [[maybe_unused]] Dispatch dispatch) {
#if defined(WALE_TAIL_CALLS)
  if (dispatch == Dispatch::wide_tail_calls) return reinterpret_cast<std::uintptr_t>(handlers_by_number<true>[number]);
  if (dispatch == Dispatch::tail_calls) return reinterpret_cast<std::uintptr_t>(handlers_by_number<false>[number]);
#endif
  return number;
}

}  // namespace

Dispatch fastest_dispatch() {
#if defined(WALE_TAIL_CALLS)
  return has_wide_instructions() ? Dispatch::wide_tail_calls : Dispatch::tail_calls;
#else
  return Dispatch::portable_switch;
#endif
}

ThreadedCode decode_threaded(std::span<const Instruction> code, Dispatch dispatch) {
  ThreadedCode decoded;
  decoded.dispatch = dispatch = std::max(dispatch, fastest_dispatch());  // fastest first
  decoded.instructions.resize(code.size() + 1);
  ThreadedInstruction* next = decoded.instructions.data();
  constexpr unsigned nothing = register_limit;  // no register: the first instruction has no last result
  unsigned last = nothing;
  for (const Instruction& i : code) {
    const int operands = operation_table[i.operation].operands;
    const unsigned forwarded = (operands > 0 && i.a == last ? 1u : 0u) | (operands > 1 && i.b == last ? 2u : 0u);
    *next++ = {handler_of(handler_number(i.operation, forwarded), dispatch), i.destination, i.a, i.b, i.c};
    last = i.destination;
  }
  *next = {handler_of(stop, dispatch)};
  return decoded;
}

void run_threaded(const ThreadedCode& code, const LaneLookups& lookups, float* registers) noexcept {
#if defined(WALE_TAIL_CALLS)
  if (code.dispatch != Dispatch::portable_switch) {
    const ThreadedInstruction* const first = code.instructions.data();
    return reinterpret_cast<Handler>(first->handler)(first, lookups, registers, 0.0f);
  }
#endif
  run_by_switch(code.instructions.data(), lookups, registers);
}

}  // namespace wale
