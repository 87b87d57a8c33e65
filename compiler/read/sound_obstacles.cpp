#include "compiler/read/sound_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr double least_beside = 0.012;                      // of the places, on either side of an obstacle
constexpr double least_push_of_wall = 0.02;                 // N, at its deepest
constexpr double more_than_all = 1.3;                       // times: a change of a fit and that of all forces
constexpr double mended = 0.2;                              // of a wall's stiffness
constexpr double widest_step = 5e-3;                        // m
constexpr double apart_at_least = 4e-3;                     // m between two steps
constexpr double facing_alike = 0.94, opposed_ways = -0.9;  // cosines

/// N: between the least and the greatest of some forces along an axis of length 1.
double range_along(std::span<const glm::dvec2> forces, glm::dvec2 axis) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const glm::dvec2& force : forces) {
    const double along = glm::dot(force, axis);
    least = std::min(least, along), most = std::max(most, along);
  }
  return most - least;
}

/// Whether some change of a force along an axis is more than the forces ever differ by. Parts of a model that cancel
/// each other are none of the force.
bool is_more_than_all(glm::dvec2 change, std::span<const glm::dvec2> forces) {
  const double size = glm::length(change);
  return size > 0 && size > least_force + more_than_all * range_along(forces, change / size);
}

}  // namespace

bool is_sound(const ObstacleFit& fit, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  const auto count = static_cast<double>(places.size());
  const auto share = [&](const auto& beyond) {
    return static_cast<double>(std::ranges::count_if(places, beyond)) / count;
  };
  const std::vector<Wall>& walls = fit.found.walls;
  const std::vector<StaticStep>& steps = fit.found.steps;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& wall = walls[i];
    double deepest = 0;
    for (const glm::dvec2& place : places) deepest = std::max(deepest, wall.depth(place));
    const double inside = share([&](glm::dvec2 place) { return wall.depth(place) > 0; });
    const double rise = wall.stiffness * deepest;
    if (inside < least_beside || inside > 1 - least_beside || wall.stiffness < least_stiffness ||
        rise < least_push_of_wall || wall.preload < -least_force || wall.preload > rise)
      return false;
    if (!wall.round() && is_more_than_all((wall.preload + rise) * wall.inward, forces)) return false;
    // A wall that mends what the even force pushes away is no wall.
    const glm::dvec2 in = wall.round() ? glm::dvec2(1, 0) : wall.inward;
    if (glm::dot(in, in.x * fit.even.by_x + in.y * fit.even.by_y) > mended * wall.stiffness) return false;
    for (std::size_t k = 0; k < i; ++k) {
      const Wall& other = walls[k];
      if (wall.round() || other.round()) return false;
      const double cosine = glm::dot(wall.inward, other.inward);
      // One wall that bends a little, and a spring that ends.
      if ((cosine > facing_alike && std::abs(wall.offset - other.offset) < apart_at_least) ||
          (cosine < opposed_ways && wall.offset + other.offset < 0))
        return false;
    }
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const StaticStep& step = steps[i];
    // Two in one place are no two.
    for (std::size_t k = 0; k < i; ++k) {
      const double cosine = glm::dot(step.way, steps[k].way);
      if (std::abs(cosine) > facing_alike &&
          std::abs(step.offset - std::copysign(1.0, cosine) * steps[k].offset) < apart_at_least)
        return false;
    }
    if (step.width > widest_step || is_more_than_all(step.change, forces)) return false;
    const double beyond = share([&](glm::dvec2 place) { return glm::dot(place, step.way) > step.offset; });
    if (beyond < least_beside || beyond > 1 - least_beside || glm::length(step.change) < 2 * least_force) return false;
  }
  return true;
}

}  // namespace wale
