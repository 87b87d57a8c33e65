#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "compiler/read/other_force.hpp"
#include "compiler/read/swing.hpp"

namespace wale {

/// How a force that comes with time comes to hands that hold still.
struct ComingForce {
  double after = 0;   ///< s: half of it is there; 0 if none comes, or beside what swings
  bool goes = false;  ///< it ends: it is there at first, and later no more
  /// N: what comes after the seconds that were looked at, if it is much the same everywhere.
  glm::dvec2 later_push{0};
  /// N and Hz: what of it swings, which is no push.
  double later_swing = 0, later_rate = 0;
};

/// Of the forces on hands that hold still (`felt_at_rest`) and, if `other.later` says that more may come, on hands that
/// hold still for longer.
ComingForce coming_force(const Bank& bank, const std::vector<std::vector<Force>>& felt, const OtherForce& other);

/// Looks all over the patch for the largest of the forces that the button and time bring, which `other` has of few
/// places. Of a program that remembers nothing.
void look_all_over(const Bank& bank, const std::vector<std::vector<Force>>& felt, OtherForce& other);

}  // namespace wale
