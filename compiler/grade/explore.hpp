#pragma once

#include <vector>

#include "compiler/grade/grade.hpp"

namespace wale {

/// A second of a hand that strokes to and fro and then one that circles, each from entering on.
struct Exploration {
  std::vector<Hand> hands;     ///< one a tick
  std::vector<float> states;   ///< before that tick, hand by hand
  std::vector<char> changing;  ///< for each state, whether it changed after it was entered
  double gained_joule = 0;     ///< the most that the program had given the hand, net, at any moment of either second
  double moved_joule = 0;      ///< the sum of what went either way, of the second in which that is more
};

/// Runs the program under such hands at its device's rate, by its own ticks, guarded by nothing. The hand's radius is
/// cut to what the patch has room for.
Exploration explore(Bank bank, const GradingHand& hand);

}  // namespace wale
