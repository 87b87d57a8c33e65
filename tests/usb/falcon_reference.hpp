#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>

namespace wale::test {

// The Falcon's arms as plainly as they can be said: lengths of libnifalcon's FalconGeometry.h (metres), the shin's
// attitude by angles as in Stamper's thesis, the arm's angle by halving an interval, slopes by differences.

constexpr double falcon_pi = 3.14159265358979323846;

/// How far the handle's end of a shin is from its knee beyond the shin's length, when arm 0, 1 or 2 is at `angle` and
/// the handle at `place`. Nothing where the shin cannot lean so far aside.
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

/// The angle of an arm whose knee points outwards, in radians; the handle's place is one that it reaches.
inline double arm_angle(int arm, const glm::dvec3& place) {
  // Folded out the knee is too far away, folded in it is too near: in between it fits.
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

/// How the three angles change by a movement along an axis, rad/m.
inline glm::dvec3 arm_slopes(int axis, const glm::dvec3& place) {
  constexpr double step = 1e-6;
  glm::dvec3 there = place, here = place;
  there[axis] += step;
  here[axis] -= step;
  return (arm_angles(there) - arm_angles(here)) / (2 * step);
}

}  // namespace wale::test
