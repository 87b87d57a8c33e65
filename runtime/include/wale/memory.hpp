#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// The memory of one placed program from tick to tick: its states and the cells of its grids. It outlives banks: a
/// change of a parameter makes a new bank and leaves the memory as it is. One thread at a time may use it.
///
/// Grids begin at their initial values when the memory is made, and then keep the values written to them. States begin
/// anew whenever the hand enters. Before the first `enter` a state is the number of its range that is nearest to 0.
class Memory {
 public:
  /// Allocates all states and cells.
  explicit Memory(const Program& program);

  /// The memory of a program that replaces `predecessor`'s. When `succeed` is called, states of the same name and unit
  /// keep their values, and so do the grids if all have the same names, units and sizes. Allocates.
  Memory(const Program& program, std::shared_ptr<Memory> predecessor);

  /// Takes over values from the predecessor, which first does so from its own predecessor: the grids and, if
  /// `with_states` (the hand stayed on the patch), the states. Call it after `enter`, so that new states begin as on
  /// entering. Calls after the first do nothing. Real-time: allocates nothing, takes no lock, makes no system call.
  void succeed(bool with_states) noexcept;
  /// Whether `other` is a direct or earlier predecessor that has not been succeeded.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  bool follows(const Memory* other) const noexcept;
  /// How many predecessors, one behind the other, have not been succeeded. For the control side.
  std::size_t predecessors() const noexcept;
  /// Releases the predecessor if it has been succeeded; false if it is still needed. For the control side: it frees
  /// memory.
  bool forget_predecessor();

  /// The hand enters: runs the program's `enter` section and sets the states, each clamped to its range. A state whose
  /// initial value is not a number gets the number of its range that is nearest to 0. Does nothing if `bank` is of
  /// another program.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void enter(Bank& bank, const Hand& hand) noexcept;

  /// Copies values from another memory of the same program: cells from number `first` on, at most `most`, and with the
  /// first cells the states. Returns how many cells it copied. Real-time: allocates nothing, takes no lock, makes no
  /// system call, does not throw.
  std::size_t copy_from(const Memory& other, std::size_t first, std::size_t most) noexcept;

  const Program& program() const { return program_; }
  /// The states' values, in the order of `description().states`.
  std::span<const float> states() const { return states_; }
  /// The cells of grid `index`, row by row from the lower left.
  std::span<const float> grid(std::size_t index) const;
  /// The cells of all grids in their order, each row by row from the lower left.
  std::span<const float> cells() const { return cells_; }
  /// How many times a state's value was not a number and the state got its initial value again.
  long restored() const { return restored_; }

 private:
  friend Force tick(Bank& bank, Memory& memory, const Hand& hand) noexcept;

  /// Ends a tick: stores its results, which are in `registers`, in the states and grids.
  void remember(const float* registers) noexcept;

  Program program_;
  std::vector<float> states_, initial_states_;
  std::vector<float> cells_;
  long restored_ = 0;
  std::shared_ptr<Memory> predecessor_;
  std::vector<std::pair<std::uint16_t, std::uint16_t>> kept_states_;  // number in the predecessor, and in this memory
  bool keeps_grids_ = false;
  /// Set by the real-time side, read by the control side; a copy of a memory copies its value.
  struct Succeeded : std::atomic<bool> {
    Succeeded() : std::atomic<bool>(true) {}
    Succeeded(const Succeeded& other) : std::atomic<bool>(other.load()) {}
    Succeeded& operator=(const Succeeded& other) {
      store(other.load());
      return *this;
    }
  };
  Succeeded succeeded_;
};

/// Runs the program once: returns its force on the hand, in N, and updates the memory. During the tick states have the
/// values from its beginning. At its end each state gets its next value, clamped to its range, or its initial value
/// when that is not a number. Then the grids are written, with values computed before any of these writes. A `memory`
/// of another program is left unchanged, and the tick runs without memory.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
Force tick(Bank& bank, Memory& memory, const Hand& hand) noexcept;

}  // namespace wale
