#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// What one placed program remembers from tick to tick: its states and the cells of its grids. It outlives banks: a
/// parameter that changes makes a new bank and leaves the memory as it is. One thread at a time may use it.
///
/// Grids begin at their initial values when the memory is made and keep what is written; states begin anew whenever the
/// hand enters. Before the first `enter` a state is the number of its range that is nearest to 0.
class Memory {
 public:
  /// Allocates all that the program will ever remember.
  explicit Memory(const Program& program);

  /// The hand has come in: runs the program's `enter` section and sets the states, each held in its range; one whose
  /// initial value is not a number gets the number of its range that is nearest to 0. `bank` is of the same program, or
  /// nothing happens.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void enter(Bank& bank, const Hand& hand) noexcept;

  const Program& program() const { return program_; }
  /// The states' values, in the order of `description().states`.
  std::span<const float> states() const { return states_; }
  /// The cells of grid `index`, row by row from the lower left.
  std::span<const float> grid(std::size_t index) const;
  /// The cells of all grids in their order, each row by row from the lower left.
  std::span<const float> cells() const { return cells_; }
  /// How many times a state came out as not-a-number and got its initial value again.
  long restored() const { return restored_; }

 private:
  friend Force tick(Bank& bank, Memory& memory, const Hand& hand) noexcept;

  /// The end of a tick, which left its results in `registers`.
  void remember(const float* registers) noexcept;

  Program program_;
  std::vector<float> states_, initial_states_;
  std::vector<float> cells_;
  long restored_ = 0;
};

/// One execution of the program: its force on the hand, in N, and what it remembers from here on. States read as they
/// were when the tick began; at its end each becomes its next value, held in its range, or its initial value again when
/// that is not a number; then grids are written, from registers that know nothing of these writes. `memory` was made
/// for the bank's program; otherwise it is left alone and the tick is one without memory.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
Force tick(Bank& bank, Memory& memory, const Hand& hand) noexcept;

}  // namespace wale
