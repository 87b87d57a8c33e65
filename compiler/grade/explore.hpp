#pragma once

#include <vector>

#include "compiler/grade/grade.hpp"

namespace wale {

/// One second of a hand that strokes to and fro, then one second of a hand that circles; each begins by entering.
struct Exploration {
  std::vector<Hand> hands;     ///< one per tick
  std::vector<float> states;   ///< before each tick, hand by hand
  std::vector<char> changing;  ///< for each state, whether it changed after it was entered
  double gained_joule = 0;     ///< largest net energy that the hand keeps when it goes back to where it began
  double moved_joule = 0;      ///< sum of the energies in both directions, of the second in which it is larger
};

/// Runs the program under such hands at its device's rate, without guards. The hand's radius is limited to the room on
/// the patch. Deterministic.
Exploration explore(Bank bank, const GradingHand& hand);

/// A change of the force, N, between two hands that explore alike, one a little ahead of the other, in the same tick.
struct StepAhead {
  double newton = 0;
  Hand hand;
  bool jumps = false;  ///< most of it also shows between hands that are far less than an encoder count apart
};

/// The largest such change between hands that are at most an encoder count apart. Since each has its own past, it also
/// shows jumps that come through memory, as those of a delayed force. Nothing for a program that would take too long.
/// Deterministic.
StepAhead largest_step_ahead(const Bank& bank, const GradingHand& hand);

}  // namespace wale
