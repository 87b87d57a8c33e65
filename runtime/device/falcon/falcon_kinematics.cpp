#include "runtime/device/falcon/falcon_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

namespace wale::falcon {
namespace {

constexpr double pi = 3.14159265358979323846;

// Metres: FalconGeometry.h's a, b, c, d and e together, f, r, s.
constexpr double thigh = 0.060, shin = 0.1025, handle_out = 0.01443, joints = 0.0225, handle_aside = -0.025;
constexpr double base_out = 0.0400, base_aside = -0.02309;

// The encoder is on the motor, whose shaft drives the arm's drum by a cable: FalconGeometry.h, FalconKinematic.h.
constexpr double slots = 320, shaft = 0.01425, drum = 0.110, angle_of_zero = 35 * pi / 180;
constexpr double radians_per_count = 2 * pi / (4 * slots) * shaft / drum;

/// The axes of each arm's own frame: outwards and aside, as cosines and sines of 105, -15 and -135 degrees.
struct Arm {
  double cosine, sine;
};
constexpr double near = 0.25881904510252076, far = 0.96592582628906829, half = 0.70710678118654752;
constexpr Arm arms[3] = {{-near, far}, {far, -near}, {-half, -half}};

/// A place in an arm's frame, from its shoulder to where the shin holds the handle.
struct Reach {
  double out = 0, aside = 0, up = 0;
  double shin_seen = 0;  // the shin's length as seen along the shoulder's axis, without joints; 0: too far aside
  double length() const { return joints + shin_seen; }
};

Reach reach(const Arm& arm, const glm::dvec3& place) noexcept {
  Reach reach;
  reach.out = arm.cosine * place.x + arm.sine * place.y - base_out + handle_out;
  reach.aside = -arm.sine * place.x + arm.cosine * place.y - base_aside + handle_aside;
  reach.up = place.z;
  reach.shin_seen = std::sqrt(std::max(0.0, shin * shin - reach.aside * reach.aside));
  return reach;
}

/// How the gap between the knee and the end of the shin grows with the handle's movement, per metre.
glm::dvec3 gap_gradient(const Arm& arm, const Reach& reach, double along, double up, double distance) noexcept {
  const double out = along / distance, aside = reach.aside / reach.shin_seen;
  return {out * arm.cosine - aside * arm.sine, out * arm.sine + aside * arm.cosine, up / distance};
}

}  // namespace

glm::dvec3 angles_of(const Encoders& encoders) noexcept {
  return glm::dvec3(encoders[0], encoders[1], encoders[2]) * radians_per_count + angle_of_zero;
}

Encoders encoders_of(const glm::dvec3& angles) noexcept {
  Encoders encoders{};
  for (int i = 0; i < 3; ++i) {
    const double counts = (angles[i] - angle_of_zero) / radians_per_count;
    encoders[static_cast<std::size_t>(i)] =
        static_cast<std::int16_t>(std::lround(std::clamp(counts, -32768.0, 32767.0)));
  }
  return encoders;
}

std::optional<glm::dvec3> inverse(const glm::dvec3& place) noexcept {
  glm::dvec3 angles(0);
  for (int i = 0; i < 3; ++i) {
    const Reach to = reach(arms[i], place);
    if (!(to.shin_seen > 0)) return std::nullopt;
    // The knee is `thigh` from the shoulder and `length` from the handle: the law of cosines.
    const double distance = std::hypot(to.out, to.up);
    const double cosine = (distance * distance + thigh * thigh - to.length() * to.length()) / (2 * thigh * distance);
    if (!(std::abs(cosine) <= 1)) return std::nullopt;
    angles[i] = std::atan2(to.up, to.out) - std::acos(cosine);  // knees outwards
  }
  return angles;
}

std::optional<glm::dvec3> forward(const glm::dvec3& angles) noexcept {
  // Newton's method on the gaps between knees and shins. It always starts at the same place, so that the same counts
  // give the same bits.
  constexpr int most_steps = 20;
  constexpr double near_enough = 1e-10, farthest = 0.3;
  glm::dvec3 place = workspace_centre;
  for (int step = 0; step < most_steps; ++step) {
    glm::dmat3 rows(0);
    glm::dvec3 gaps(0);
    for (int i = 0; i < 3; ++i) {
      const Reach to = reach(arms[i], place);
      if (!(to.shin_seen > 0)) return std::nullopt;
      const double along = to.out - thigh * std::cos(angles[i]), up = to.up - thigh * std::sin(angles[i]);
      const double distance = std::hypot(along, up);
      if (!(distance > 0)) return std::nullopt;
      gaps[i] = distance - to.length();
      rows[i] = gap_gradient(arms[i], to, along, up, distance);
    }
    const double determinant = glm::determinant(rows);
    if (!(std::abs(determinant) > 1e-6)) return std::nullopt;
    const glm::dvec3 move = gaps * glm::inverse(rows);  // as a row: rows are columns to glm
    place -= move;
    if (!(glm::dot(place, place) < farthest * farthest)) return std::nullopt;
    if (glm::dot(move, move) >= near_enough * near_enough) continue;
    // The shins also meet elsewhere, where knees point inwards or the handle is inside the base.
    const auto back = inverse(place);
    constexpr double alike = 1e-6;  // rad
    if (!back || !glm::all(glm::lessThan(glm::abs(*back - angles), glm::dvec3(alike)))) return std::nullopt;
    return place;
  }
  return std::nullopt;
}

std::optional<glm::dmat3> turning(const glm::dvec3& place, const glm::dvec3& angles) noexcept {
  glm::dmat3 rows(0);
  for (int i = 0; i < 3; ++i) {
    const Reach to = reach(arms[i], place);
    if (!(to.shin_seen > 0)) return std::nullopt;
    const double cosine = std::cos(angles[i]), sine = std::sin(angles[i]);
    const double along = to.out - thigh * cosine, up = to.up - thigh * sine, distance = std::hypot(along, up);
    if (!(distance > 0)) return std::nullopt;
    const double by_angle = thigh * (along * sine - up * cosine) / distance;  // how the gap grows, per radian
    if (!(std::abs(by_angle) > 1e-6)) return std::nullopt;
    rows[i] = gap_gradient(arms[i], to, along, up, distance) / -by_angle;
  }
  return glm::transpose(rows);
}

std::optional<glm::dvec3> torques_for(const glm::dmat3& turning, const glm::dvec3& force) noexcept {
  const double determinant = glm::determinant(turning);
  if (!(std::abs(determinant) > 1)) return std::nullopt;  // 1/m^3; some thousands in the workspace
  return glm::inverse(glm::transpose(turning)) * force;
}

glm::dvec3 force_by(const glm::dmat3& turning, const glm::dvec3& torques) noexcept {
  return glm::transpose(turning) * torques;
}

}  // namespace wale::falcon
