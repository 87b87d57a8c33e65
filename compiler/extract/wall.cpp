#include "compiler/extract/wall.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace wale {
namespace {

constexpr int scan_lines = 5;          // in each of four directions
constexpr double step = 0.5e-3;        // m between the places of a scan
constexpr int steps_free = 8;          // 4 mm without force before a face, which no texture has
constexpr int steps_deep = 3;          // 1.5 mm over which the force has to grow in proportion
constexpr double least_push = 0.02;    // N at that depth
constexpr double proportional = 0.15;  // how far it may be from a straight line, of the force
constexpr double slow = 0.02;          // m/s, at which damping is looked at

struct Scan {
  glm::dvec2 from{0}, direction{0};
  std::size_t first = 0, count = 0;  // of the hands
};

Force force_at(const Bank& bank, glm::dvec2 place, glm::dvec2 velocity) {
  Hand hand;
  hand.position = hand.workspace = glm::vec2(place);
  hand.velocity = hand.raw_velocity = glm::vec2(velocity);
  std::array<Force, 1> force{};
  tick_all(bank, {&hand, 1}, force);
  return force[0];
}

}  // namespace

std::optional<WallFace> wall_face(const Bank& bank) {
  const PatchSize patch = bank.size();
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  std::vector<Scan> scans;
  std::vector<Hand> hands;
  for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
    for (int line = 0; line < scan_lines; ++line) {
      const glm::dvec2 across{std::abs(direction.y), std::abs(direction.x)};
      const double length = 2 * glm::dot(half, glm::abs(direction));
      Scan scan{-half * direction + half * across * ((line + 0.5) / (0.5 * scan_lines) - 1), direction, hands.size(),
                static_cast<std::size_t>(length / step)};
      for (std::size_t i = 0; i < scan.count; ++i) {
        Hand& hand = hands.emplace_back();
        hand.position = hand.workspace = glm::vec2(scan.from + static_cast<double>(i) * step * direction);
      }
      scans.push_back(scan);
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);

  std::optional<WallFace> stiffest;
  for (const Scan& scan : scans) {
    const auto against = [&](std::size_t i) { return -glm::dot(glm::dvec2(forces[scan.first + i]), scan.direction); };
    std::size_t free = 0;
    for (std::size_t i = 0; i + steps_deep + 1 < scan.count; ++i) {
      const bool touched = glm::length(forces[scan.first + i]) > 1e-4f;
      if (touched && free >= steps_free) {
        // The force at the two ends of a straight line tells where it began, at most a step before.
        const double near = against(i), far = against(i + steps_deep), slope = (far - near) / (steps_deep * step);
        const double middle = against(i + 1), expected = near + slope * step;
        const bool straight = std::abs(middle - expected) <= proportional * far;
        const double depth = slope > 0 ? near / slope : -1;
        if (far > least_push && straight && depth >= 0 && depth <= 1.05 * step &&
            (!stiffest || slope > stiffest->stiffness)) {
          const glm::dvec2 here = scan.from + static_cast<double>(i) * step * scan.direction;
          stiffest = WallFace{here - depth * scan.direction, scan.direction, slope, 0, 0};
        }
      }
      free = touched ? 0 : free + 1;
    }
  }
  if (!stiffest) return stiffest;
  const glm::dvec2 inside = stiffest->place + 2 * step * stiffest->inward, in = slow * stiffest->inward;
  const auto against = [&](glm::dvec2 velocity) {
    return -glm::dot(glm::dvec2(force_at(bank, inside, velocity)), stiffest->inward);
  };
  const double still = against({0, 0});
  stiffest->damping = (against(in) - still) / slow;
  stiffest->release = (still - against(-in)) / slow;
  return stiffest;
}

}  // namespace wale
