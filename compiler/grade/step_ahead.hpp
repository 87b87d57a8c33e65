#pragma once

#include "compiler/grade/grade.hpp"

namespace wale {

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
