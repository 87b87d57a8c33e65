#include "compiler/read/slow_sine.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "compiler/read/obstacle_fit.hpp"

namespace wale {
namespace {

constexpr double fewest_of_a_sine = 0.95, most_of_a_sine = 3;  // over the patch
constexpr double bends_back = 0.5;     // of how the force bends, that goes against the force itself
constexpr double as_a_sine = 1e-6;       // of what a line leaves: no other law comes so near to a sine
constexpr std::size_t places_of_a_sine = 1500;
constexpr int steps_of_fit = 20;
constexpr std::size_t cells_of_a_mean = 4;  // along each axis

/// A sine and its second derivatives are in one proportion everywhere, whatever its phase: minus the square of its wave.
/// This is how one of them goes with the force beside a line.
struct Bending {
  double by_force = 0;   ///< 1/m^2
  double explained = 0;  ///< 0 .. 1: of its square
};

Bending bending_of(const Eigen::MatrixXd& force_and_line, const Eigen::VectorXd& bent) {
  const Eigen::Vector4d found = (force_and_line.transpose() * force_and_line).ldlt().solve(force_and_line.transpose() * bent);
  const double all = bent.squaredNorm();
  return {found[0], all > 0 ? 1 - (bent - force_and_line * found).squaredNorm() / all : 0};
}

/// The wave to begin with, by how means over small cells bend; nothing if they do not bend as a sine does.
std::optional<glm::dvec2> first_wave(const StillForces& whole) {
  const auto side = static_cast<Eigen::Index>(whole.side / cells_of_a_mean);
  const std::vector<glm::dvec2> forces = cell_means(whole.side, whole.forces), places = cell_means(whole.side, whole.places);
  const LinearForce line = linear_force(places, forces);
  double xx = 0, xy = 0, yy = 0;
  std::vector<glm::dvec2> beside = forces;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    beside[i] -= line.at(places[i]);
    xx += beside[i].x * beside[i].x, xy += beside[i].x * beside[i].y, yy += beside[i].y * beside[i].y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const glm::dvec2 push(std::cos(angle), std::sin(angle)), apart = whole.size / static_cast<double>(side);
  const auto at = [&](Eigen::Index row, Eigen::Index column) {
    return glm::dot(beside[static_cast<std::size_t>(row * side + column)], push);
  };
  const Eigen::Index inner = side - 2;
  Eigen::MatrixXd known(inner * inner, 4);
  Eigen::VectorXd by_xx(inner * inner), by_yy(inner * inner), by_xy(inner * inner);
  for (Eigen::Index row = 0; row < inner; ++row)
    for (Eigen::Index column = 0; column < inner; ++column) {
      const Eigen::Index i = row * inner + column, r = row + 1, c = column + 1;
      const glm::dvec2 place = places[static_cast<std::size_t>(r * side + c)];
      known.row(i) << at(r, c), 1, place.x / whole.size.x, place.y / whole.size.y;
      by_xx[i] = (at(r, c - 1) - 2 * at(r, c) + at(r, c + 1)) / (apart.x * apart.x);
      by_yy[i] = (at(r - 1, c) - 2 * at(r, c) + at(r + 1, c)) / (apart.y * apart.y);
      by_xy[i] = (at(r + 1, c + 1) - at(r + 1, c - 1) - at(r - 1, c + 1) + at(r - 1, c - 1)) / (4 * apart.x * apart.y);
    }
  const Bending all = bending_of(known, by_xx + by_yy);
  if (!(all.by_force < 0) || all.explained < bends_back) return std::nullopt;
  const double x = std::sqrt(std::max(0.0, -bending_of(known, by_xx).by_force)),
               y = std::sqrt(std::max(0.0, -bending_of(known, by_yy).by_force));
  const double same_way = bending_of(known, by_xy).by_force < 0 ? 1 : -1;
  const glm::dvec2 waves = glm::dvec2(x, same_way * y) / (2 * std::numbers::pi);
  const double periods = glm::length(waves * whole.size);
  if (!(periods > 0.5 * fewest_of_a_sine) || periods > 1.5 * most_of_a_sine) return std::nullopt;
  return waves;
}

}  // namespace

std::optional<SlowSine> slow_sine(const StillForces& whole) {
  const auto first = first_wave(whole);
  if (!first) return std::nullopt;
  const std::vector<glm::dvec2> places = some_of(whole.places, places_of_a_sine), forces = some_of(whole.forces, places_of_a_sine);
  ObstacleFit fit;
  fit.even = linear_force(places, forces);
  const double by_line = mean_square(fit.rest(places, forces));
  // The parts of the sine are found with it: at first it has none, and its wave does not matter.
  fit.waves.push_back({*first, {{{glm::dvec2(0), glm::dvec2(0)}}}});
  if (!(fit.improve(places, forces, steps_of_fit) < as_a_sine * by_line)) return std::nullopt;
  const glm::dvec2 waves = fit.waves.front().waves;
  const double periods = glm::length(waves * whole.size);
  return periods >= fewest_of_a_sine && periods <= most_of_a_sine ? std::optional(SlowSine{waves, fit.even}) : std::nullopt;
}

}  // namespace wale
