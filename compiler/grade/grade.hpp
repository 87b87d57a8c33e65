#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "wale/program.hpp"

namespace wale {

/// Whether the loop of device, program and hand can gain energy by itself.
enum class Standing {
  passive,             ///< the device's own damping takes up all that sampling and the program can give
  stable_in_the_hand,  ///< the device's and the hand's together do
  unstable,            ///< not even both do
  active,        ///< the program itself gives energy: a moving source, a force along the motion, a field that turns
  ungraded,      ///< the device's damping is not known, and the program is not active
  not_analysed,  ///< larger than what can be derived
};

/// "passive", "stable in the hand", …
std::string_view standing_word(Standing standing);

/// Where a figure is at its worst.
struct WorstPlace {
  glm::vec2 position{0.0f};  ///< m, on the patch
  glm::vec2 velocity{0.0f};  ///< m/s
};

/// The hand that a grade leans on and the pace at which it explores.
struct GradingHand {
  double damping = 0;          ///< N s/m
  double radius = 0;           ///< m, of its circles, and to either side of its strokes
  double frequency = 0;        ///< Hz, of both
  std::string name;            ///< of its declaration
  double fewest_counts = 0;    ///< of the encoder in a period: with less it is not felt as it is
  double faithful_counts = 0;  ///< from which on it is
  double fewest_levels = 0;    ///< command steps of the largest force that are not felt as steps
};

/// Energy that a program gives to the hand by itself, at a hand's own pace.
struct Energy {
  bool conservative = true;  ///< the force at rest has no curl, so that no loop gains energy
  double curl_watt = 0;      ///< what a hand gains that circles where the field turns most
  double motion_watt = 0;    ///< the largest power of what the force adds when the hand moves
  double source_watt = 0;    ///< net power over a second of exploring, of what is remembered or moves by itself; of the
                             ///< latter at least half of the energy that went either way
  std::vector<std::string> reasons;  ///< why it gives energy, in words; none where it does not

  bool active() const { return !reasons.empty(); }
  /// The most that it gives, by these figures.
  double watt() const;
};

/// The effect of a program's force on the stability of the loop, from the program alone. SI units.
struct Grade {
  Standing standing = Standing::not_analysed;

  double required_damping = 0;  ///< N s/m: from which on the device alone would be passive
  WorstPlace worst;             ///< where it is needed
  double device_damping = 0;    ///< N s/m, as the profile has it
  bool damping_known = false;   ///< measured, not assumed
  double hand_damping = 0;      ///< N s/m

  double stiffness = 0;    ///< N/m: the greatest spectral norm of the force's slope by place
  WorstPlace stiffest;     ///< where that is
  double step_newton = 0;  ///< the largest change of force between two neighbouring encoder counts
  bool jumps = false;      ///< that change is far more than the slope: the force jumps
  /// Whether stick friction holds the handle against one count's change, |step| <= 2 c (Abbott and Okamura 2005); else
  /// it may buzz. Only where the friction is known.
  std::optional<bool> buzzes;
  double friction = 0;  ///< N, as the profile has it
  bool friction_known = false;

  /// m: the period of the sine whose slope changes from one encoder count to the next as much as this force's does, in
  /// the root mean square over the patch, and so its finest strong detail; infinite for a slope that never changes.
  double finest_period = 0;
  double counts_per_period = 0;  ///< encoder counts over it
  double fastest_hand = 0;       ///< m/s: from which on less than two ticks fall into it
  double force_levels = 0;       ///< command steps that the largest force uses
  double fewest_counts = 0, faithful_counts = 0, fewest_levels = 0;  ///< of the hand: see `GradingHand`

  Energy energy;

  /// Known damping less what is required; only where it is known.
  std::optional<double> margin() const;
};

/// The part of a grade that says whether a program must say `active`: quicker.
Energy energy_of(const Bank& bank, const GradingHand& hand);

/// Grades a program at a bank's parameters (one that only vibrates a pad closes no loop and is not analysed), in a
/// hand. Deterministic; some milliseconds.
Grade grade(const Bank& bank, const GradingHand& hand);

/// The hand called `normal` (calibration/hands/hands.wale); where none is declared, one without damping.
GradingHand normal_hand(const Declarations& declarations);

}  // namespace wale
