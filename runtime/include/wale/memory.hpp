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

/// What one placed program remembers from tick to tick: its states and the cells of its grids. It outlives banks: a
/// parameter that changes makes a new bank and leaves the memory as it is. One thread at a time may use it.
///
/// Grids begin at their initial values when the memory is made and keep what is written; states begin anew whenever the
/// hand enters. Before the first `enter` a state is the number of its range that is nearest to 0.
class Memory {
 public:
  /// Allocates all that the program will ever remember.
  explicit Memory(const Program& program);

  /// Allocates it for a program that takes the place of another one: what has the same name and unit as in
  /// `predecessor`'s program (grids: all of them the same names, units and sizes) goes on from there, once `succeed` is called.
  Memory(const Program& program, std::shared_ptr<Memory> predecessor);

  /// Takes over from the predecessor, which has taken over from its own, what goes on: the grids and, where the hand
  /// was on the patch all the time, the states; after `enter`, so that what is new begins as on entering. Only the
  /// first call does anything. Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void succeed(bool with_states) noexcept;
  /// Whether `other` is a predecessor, however many came between, that has not been succeeded. Real-time likewise.
  bool follows(const Memory* other) const noexcept;
  /// Lets the predecessor go if it has been succeeded. For the side that allocates.
  void forget_predecessor();

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
  std::shared_ptr<Memory> predecessor_;
  std::vector<std::pair<std::uint16_t, std::uint16_t>> kept_states_;  // there and here
  bool keeps_grids_ = false;
  /// Set by the real-time side, read by the other; a copy of a memory copies what it was.
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

/// One execution of the program: its force on the hand, in N, and what it remembers from here on. States read as they
/// were when the tick began; at its end each becomes its next value, held in its range, or its initial value again when
/// that is not a number; then grids are written, from registers that know nothing of these writes. `memory` was made
/// for the bank's program; otherwise it is left alone and the tick is one without memory.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
Force tick(Bank& bank, Memory& memory, const Hand& hand) noexcept;

}  // namespace wale
