#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "compiler/read/motion.hpp"
#include "compiler/read/obstacles.hpp"
#include "compiler/read/other_force.hpp"
#include "compiler/read/relief.hpp"
#include "compiler/read/swing.hpp"

namespace wale {

/// Signs and directions of forces that mirrored programs have the other way round. Angles are rad.
struct Directions {
  double aside = 0;  ///< N at 0.2 m/s: pushes a moving hand to its left; negative: to its right
  double swirl = 0;  ///< N/m: of the part of a linear field that turns resting hands about, counterclockwise
  Principal drag;    ///< N at 0.2 m/s: a resistance that no friction and viscosity tell
  std::optional<double> travel;     ///< in [0, 2 pi): towards where what time changes goes
  glm::dvec2 steps{0};              ///< N: the largest change that steps make on the way up or to the right
  glm::dvec2 step_push{0};          ///< N: the largest force beside steps
  std::optional<double> step_axis;  ///< in [0, pi): across the line of the largest step
};

/// Of a moving hand, and of what time changes.
Directions directions_of_motion(const Bank& bank, const OpposingForce& opposing, const Swing& sway,
                                const Swing& vibration, const OtherForce& other);
/// Tells `aside` and `drag` anew, of strokes where `opposing` was read: outside of `wall`, if there is one.
void tell_directions_of_drag(Directions& found, const Bank& bank, const OpposingForce& opposing, const WallFace* wall);
/// Adds those of resting hands: `steps` beside a linear field.
void tell_still_directions(Directions& found, const std::vector<StaticStep>& steps, const LinearForce& trend,
                           glm::dvec2 half);

}  // namespace wale
