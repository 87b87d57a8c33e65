#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>

namespace wale::test {

// A simple reference for the Falcon's arms. Lengths are those of libnifalcon's FalconGeometry.h, in metres. The shin's
// attitude has angles as in Stamper's thesis. The arm's angle is found by bisection, slopes by finite differences.

constexpr double falcon_pi = 3.14159265358979323846;

/// The distance from the knee to the handle's end of the shin, minus the shin's length, for arm 0, 1 or 2 at `angle`
/// and the handle at `place`. Empty if the shin cannot lean so far to the side.
inline std::optional<double> gap(int arm, double angle, const glm::dvec3& place) {
  const double a = 0.060, b = 0.1025, c = 0.01443, d = 0.01125, e = d, f = -0.025, r = 0.0400, s = -0.02309;
  const double degrees[3] = {90 + 15, -30 + 15, -150 + 15};
  const double phi = degrees[arm] * falcon_pi / 180;
  const double u = std::cos(phi) * place.x + std::sin(phi) * place.y - r;
  const double v = -std::sin(phi) * place.x + std::cos(phi) * place.y - s;
  if (std::abs(v + f) > b) return std::nullopt;
  const double lean = std::acos((v + f) / b);
  const double knee_u = a * std::cos(angle), knee_w = a * std::sin(angle);
  return std::hypot(u + c - knee_u, place.z - knee_w) - (d + e + b * std::sin(lean));
}

/// The angle of an arm whose knee points outwards, in radians. The arm must reach `place`.
inline double arm_angle(int arm, const glm::dvec3& place) {
  // With the arm folded out the knee is too far away, with the arm folded in it is too near. The angle is in between.
  double out = -falcon_pi / 2, in = out;
  while (gap(arm, in, place).value() > 0) in += 0.1;
  for (int i = 0; i < 48; ++i) {
    const double middle = (out + in) / 2;
    (*gap(arm, middle, place) > 0 ? out : in) = middle;
  }
  return (out + in) / 2;
}

inline glm::dvec3 arm_angles(const glm::dvec3& place) {
  return {arm_angle(0, place), arm_angle(1, place), arm_angle(2, place)};
}

/// The derivative of the three angles with respect to the place along an axis, in rad/m.
inline glm::dvec3 arm_slopes(int axis, const glm::dvec3& place) {
  constexpr double step = 1e-6;
  glm::dvec3 there = place, here = place;
  there[axis] += step;
  here[axis] -= step;
  return (arm_angles(there) - arm_angles(here)) / (2 * step);
}

}  // namespace wale::test
