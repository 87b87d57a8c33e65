#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "compiler/read/slow_change.hpp"

namespace wale {

/// Forces that none of the other cues reads, N, by what brings them about.
struct OtherForce {
  double button = 0;      ///< on a hand that presses the button
  double slowly = 0;      ///< on a hand that holds still: it changes slower than a sway, or once
  double remembered = 0;  ///< on a hand that has been elsewhere before; no friction is so large
  double moving = 0;      ///< on a hand at 0.25 m/s somewhere in the patch, where nothing else resists
  double rehearsed = 0;   ///< the largest force found on all these hands
  /// What the button adds on the mean over the patch, and what comes with time: towards where they push.
  glm::dvec2 button_push{0}, slow_push{0};
  /// N: what the force may come to after the seconds that were looked at, if that is more than all that may come before
  /// (both proved).
  double later = 0;

  /// The largest that no other cue reads.
  double largest() const;
  /// The push of the larger of both if it is much the same at all places, else 0.
  glm::dvec2 push() const;
};

/// The force on hands that move, beyond that on resting ones at the same places: its 99th percentile, N. 0 of a program
/// that remembers or does not look at the motion.
double force_on_moving(const Bank& bank);

/// Rehearses hands that press the button, and that come back to rest from a tour of the patch. `felt` are the forces on
/// hands that hold still (`felt_at_rest`), with what comes slowly and with the amplitude of their swings, N; `held` (N)
/// is what friction holds a resting hand with at most.
OtherForce other_force(const Bank& bank, const std::vector<std::vector<Force>>& felt, const SlowChange& slow,
                       double swinging, double held);

}  // namespace wale
