#include "compiler/read/encoder_pattern.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

namespace wale {

std::optional<ReliefWave> encoder_pattern(const ReliefWave& wave, double count) {
  if (!(wave.period > 0) || !(count > 0)) return std::nullopt;
  const glm::dvec2 waves = glm::dvec2(std::cos(wave.orientation), std::sin(wave.orientation)) * (count / wave.period);
  const glm::dvec2 left = {waves.x - std::round(waves.x), waves.y - std::round(waves.y)};
  if (left == waves) return std::nullopt;
  constexpr double hardly_any = 1e-6;  // waves to the count
  const double length = glm::length(left);
  ReliefWave met = wave;
  met.period = length > hardly_any ? count / length : std::numeric_limits<double>::infinity();
  met.orientation = std::fmod(std::atan2(left.y, left.x) + 2 * std::numbers::pi, std::numbers::pi);
  return met;
}

}  // namespace wale
