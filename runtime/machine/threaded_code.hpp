#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "runtime/machine/grid.hpp"
#include "runtime/machine/spline.hpp"
#include "wale/instruction.hpp"

namespace wale {

/// How the machine gets from one instruction to the next. All ways give the same bits.
enum class Dispatch {
  wide_tail_calls,  ///< as `tail_calls`, with AVX instructions, which not every processor has
  tail_calls,       ///< each instruction holds the address of its function, which jumps to the next instruction's
  portable_switch,  ///< each instruction holds a number, and one switch chooses
};

/// The fastest that this build and this processor have.
Dispatch fastest_dispatch();

/// An instruction decoded for one lane: its handler and its registers. Each handler is made for a choice of operands
/// that are the last instruction's result, and takes these from a processor register instead of from memory.
struct alignas(16) ThreadedInstruction {
  std::uintptr_t handler = 0;
  RegisterNumber destination = 0, a = 0, b = 0, c = 0;
};
static_assert(sizeof(ThreadedInstruction) == 16);

/// The data that code reads besides registers: the program's tables and grids, and the cells of all grids.
struct LaneLookups {
  const std::reference_wrapper<const Spline>* splines = nullptr;
  const GridShape* grids = nullptr;
  const float* cells = nullptr;
};

/// Straight-line code for one lane.
struct ThreadedCode {
  std::vector<ThreadedInstruction> instructions;  ///< the last one stops
  Dispatch dispatch = Dispatch::portable_switch;
};

/// Decodes the verified code of a section other than setup (which alone runs peaks). A `dispatch` that this build or
/// this processor lacks becomes the fastest that they have.
ThreadedCode decode_threaded(std::span<const Instruction> code, Dispatch dispatch = fastest_dispatch());

/// Runs the code once over the program's registers. The caller holds a `FloatingPointMode`.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
void run_threaded(const ThreadedCode& code, const LaneLookups& lookups, float* registers) noexcept;

}  // namespace wale
