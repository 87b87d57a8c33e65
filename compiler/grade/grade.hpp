#pragma once

#include <glm/vec2.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "wale/program.hpp"

namespace wale {

/// Whether the loop of device, program and hand can gain energy by itself.
enum class Standing {
  passive,             ///< the device's own damping absorbs all energy that sampling and the program can give
  stable_in_the_hand,  ///< the damping of device and hand together absorbs it
  unstable,            ///< both together do not absorb it
  active,        ///< the program itself gives energy: a moving source, a force along the motion, a field with a curl
  unknown,       ///< the device's damping is not known, and the program is not active
  not_analysed,  ///< the program is too large to be derived, or only vibrates
};

/// "passive", "stable in the hand", …
std::string_view standing_word(Standing standing);

/// The place and motion at which a figure is worst.
struct WorstPlace {
  glm::vec2 position{0.0f};  ///< m, on the patch
  glm::vec2 velocity{0.0f};  ///< m/s
};

/// The hand that a grade assumes, and the pace at which it explores.
struct GradingHand {
  double damping = 0;          ///< N s/m
  double radius = 0;           ///< of its circles, and to both sides of its strokes, m
  double frequency = 0;        ///< of circles and strokes, Hz
  std::string name;            ///< of its declaration
  double fewest_counts = 0;    ///< encoder counts per period below which a texture is distorted
  double faithful_counts = 0;  ///< encoder counts per period from which on it is faithful
  double fewest_levels = 0;    ///< command steps in the largest force below which steps are felt

  double speed() const { return 2 * std::numbers::pi * radius * frequency; }  ///< of its circles, m/s
};

/// Energy that a program gives to the hand by itself, at a hand's own pace.
struct Energy {
  bool conservative = true;  ///< the force at rest has no curl of which drag leaves any power
  double curl_watt = 0;      ///< power gained by a hand that circles where the curl is largest, less what drag takes
  double motion_watt = 0;    ///< largest power of the part of the force that motion adds
  double source_watt = 0;    ///< net power of exploring, from memory, where and when it is largest; for sources that
                             ///< move by themselves at least the mean of what they push, less what drag takes then
  double button_watt = 0;    ///< power gained by a hand that strokes, and holds the button on the ways back alone
  std::vector<std::string> reasons;  ///< why it gives energy, in words; empty if it gives none

  bool active() const { return !reasons.empty(); }
  /// The largest of these powers.
  double watt() const;
};

/// The effect of a program's force on the stability of the loop, from the program alone. SI units.
struct Grade {
  Standing standing = Standing::not_analysed;

  double required_damping = 0;  ///< N s/m: the damping from which on the device alone is passive
  WorstPlace worst;             ///< where that damping is needed
  double device_damping = 0;    ///< N s/m, from the profile
  bool damping_known = false;   ///< it was measured, not assumed
  double hand_damping = 0;      ///< N s/m

  double stiffness = 0;    ///< N/m: the largest spectral norm of the force's slope by place
  WorstPlace stiffest;     ///< where that is
  double step_newton = 0;  ///< the largest change of force between two neighbouring encoder counts
  bool jumps = false;      ///< that change is far more than the slope predicts
  /// Whether the handle may buzz: static friction c does not hold it against the change over one count, |step| > 2 c
  /// (Abbott and Okamura 2005). Empty if the friction is not known.
  std::optional<bool> buzzes;
  double friction = 0;  ///< N, from the profile
  bool friction_known = false;

  /// m: the period of its finest strong detail. It is the period of the sine whose slope changes over one encoder count
  /// as much as that of this force, in the root mean square over the patch; infinite for a constant slope.
  double finest_period = 0;
  double counts_per_period = 0;  ///< encoder counts in `finest_period`
  double fastest_hand = 0;       ///< m/s: the speed above which there are fewer than two ticks in `finest_period`
  double largest_newton = 0;     ///< the largest force at the places that were looked at
  double force_levels = 0;       ///< command steps that the largest force uses
  double fewest_counts = 0, faithful_counts = 0, fewest_levels = 0;  ///< from the hand: see `GradingHand`

  Energy energy;
  /// N: what the force may come to after the first seconds, if that is more than before (proved). Those seconds are all
  /// that the grade looks at.
  double later_newton = 0;

  /// The standing by the device's damping as it is assumed, if the standing is unknown for want of a measured one;
  /// nothing if nobody assumed it either.
  std::optional<Standing> assumed_standing() const;
  /// The device's damping minus the required one, N s/m; empty if the device's is not known.
  std::optional<double> margin() const;
};

/// Only the part of a grade that decides whether a material must state `active`; faster than `grade`.
Energy energy_of(const Bank& bank, const GradingHand& hand);

/// Grades a program at a bank's parameters, in a hand. A program that only vibrates a pad closes no loop and is not
/// analysed. Deterministic; takes some milliseconds.
Grade grade(const Bank& bank, const GradingHand& hand);

/// The hand called `normal` (calibration/hands/hands.wale); if it is not declared, one without damping.
GradingHand normal_hand(const Declarations& declarations);

}  // namespace wale
