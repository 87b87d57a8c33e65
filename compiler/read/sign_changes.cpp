#include "compiler/read/sign_changes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace wale {
namespace {

constexpr std::size_t walks = 8, points = 384;
constexpr double a_period = 24;          // points
constexpr double without_a_sign = 0.05;  // of the amplitude

}  // namespace

double sign_changes(const SplitRelief& split, const Relief& relief, double finest) {
  const glm::dvec2 room = split.whole.size;
  const double longest = 0.7 * std::min(room.x, room.y);
  const double length = std::min(longest, points * finest / a_period), step = length / points;
  std::vector<glm::dvec2> places, ways;
  for (std::size_t line = 0; line < walks; ++line) {
    // Without a direction, along several.
    const double turned = relief.oriented() ? 0 : std::numbers::pi * static_cast<double>(line) / walks;
    const double angle = relief.orientation + turned;
    const glm::dvec2 way{std::cos(angle), std::sin(angle)};
    // Kronecker's sequence puts the middles of the walks all over the patch.
    const auto part = [&](double ratio) { return std::fmod(ratio * static_cast<double>(line + 1), 1) - 0.5; };
    const glm::dvec2 half = 0.5 * length * glm::abs(way);
    const glm::dvec2 middle =
        split.whole.centre + glm::dvec2(part(0.7549), part(0.5698)) * glm::max(room - 2.0 * half, glm::dvec2(0));
    ways.push_back(relief.push ? glm::dvec2(std::cos(*relief.push), std::sin(*relief.push)) : way);
    for (std::size_t i = 0; i < points; ++i)
      places.push_back(middle + (static_cast<double>(i) - 0.5 * (points - 1)) * step * way);
  }
  std::vector<glm::dvec2> forces = split.field(places);
  std::vector<Feature> trends;
  for (const Feature& each : split.features)
    if (each.monotone) trends.push_back(each);
  std::size_t changes = 0;
  for (std::size_t line = 0; line < walks; ++line) {
    int sign = 0;
    for (std::size_t i = line * points; i < (line + 1) * points; ++i) {
      const glm::dvec2 force = beside(trends, places[i], forces[i] - split.trend.at(places[i]));
      const double along = glm::dot(force, ways[line]);
      if (std::abs(along) < without_a_sign * relief.amplitude) continue;
      const int now = along > 0 ? 1 : -1;
      changes += sign != 0 && now != sign;
      sign = now;
    }
  }
  return static_cast<double>(changes) / (walks * length);
}

}  // namespace wale
