#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace wale::falcon {

// The Novint Falcon is a delta robot: three arms on its base hold the handle, each by a shin of two parallel rods, so
// that the handle keeps its attitude. R. E. Stamper, "A Three Degree of Freedom Parallel Manipulator with Only
// Translational Degrees of Freedom", PhD 97-4, University of Maryland 1997; the lengths are those that libnifalcon has
// (include/falcon/core/FalconGeometry.h). Places are in metres from the middle of the base: x to the right, y up, z out
// of the device towards the user.
//
// All of it is real-time: allocates nothing, takes no lock, makes no system call, does not throw.

/// Encoder counts of the three motors: top, right, left.
using Encoders = std::array<std::int16_t, 3>;

/// The place at which the workspace is widest: the arms reach 55 mm to every side of it.
constexpr glm::dvec3 workspace_centre{0, 0, 0.12};

/// The angle of an arm in radians: 0 points away from the device's axis, positive angles turn towards the user.
glm::dvec3 angles_of(const Encoders& encoders) noexcept;
/// Rounded to the nearest count, and limited to 16 bits.
Encoders encoders_of(const glm::dvec3& angles) noexcept;

/// The angles of the arms (rad) while the handle is at `place` (m); empty if the arms do not reach it.
std::optional<glm::dvec3> inverse(const glm::dvec3& place) noexcept;

/// The place of the handle (m) at these angles (rad), to a nanometre; empty if the shins cannot meet with all knees
/// outwards.
std::optional<glm::dvec3> forward(const glm::dvec3& angles) noexcept;

/// The derivative of the arms' angles by the handle's place, rad/m: column i is the change of the three angles by a
/// movement along axis i. `angles` must be those of `place`. Empty if an arm is stretched out and cannot turn.
std::optional<glm::dmat3> turning(const glm::dvec3& place, const glm::dvec3& angles) noexcept;

/// The torques of the arms (N m) that push the handle with `force` (N), and the reverse. No power is lost between the
/// two, so force = transposed(turning) * torque. Empty if the arms cannot push in every direction.
std::optional<glm::dvec3> torques_for(const glm::dmat3& turning, const glm::dvec3& force) noexcept;
glm::dvec3 force_by(const glm::dmat3& turning, const glm::dvec3& torques) noexcept;

}  // namespace wale::falcon
