#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "compiler/read/swing.hpp"

namespace wale {

/// What comes or goes with time on a hand that holds still, N: slower than a sway, or once.
struct SlowChange {
  double newton = 0;   ///< the largest at any place; 0 if a swing or noise may leave as much
  glm::dvec2 push{0};  ///< the mean over the places
  /// Of a change that is alike at all places: the mean force at the beginning without the swings, and by how much it is
  /// lower and higher at other times, along each axis. Otherwise 0.
  glm::dvec2 at_first{0}, lower{0}, higher{0};
  bool settles = true;  ///< such a change is over before the end of the time

  /// What remains of a push (N) at all times, along each axis; 0 of one that is still on its way to something else.
  glm::dvec2 remaining(glm::dvec2 push_at_first) const;
};

/// Tells it from the forces on hands that hold still (`felt_at_rest`) with their swings.
SlowChange slow_change(const Bank& bank, const std::vector<std::vector<Force>>& felt, const Swing& sway,
                       const Swing& vibration);

/// Such forces without what changes slower than a vibration of `swing`'s frequency, so that its size shows alone; 0
/// where they jump. Nothing if no change is a part of its size, or too much of the time would be left out.
std::optional<std::vector<std::vector<Force>>> without_slow_change(const Bank& bank,
                                                                   const std::vector<std::vector<Force>>& felt,
                                                                   const Swing& swing);

}  // namespace wale
