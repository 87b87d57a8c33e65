#include "compiler/read/spring_end.hpp"

#include <array>
#include <glm/geometric.hpp>

#include "compiler/read/still_forces.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {

bool changes_evenly(const std::vector<glm::dvec2>& places, std::vector<glm::dvec2> forces, double unevenly) {
  constexpr std::size_t fewest = 12;
  if (places.size() < fewest) return false;
  const double all = mean_square(forces);
  const LinearForce line = linear_force(places, forces);
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= line.at(places[i]);
  return mean_square(forces) < unevenly * all;
}

double end_of_a_spring(const std::vector<glm::dvec2>& places, const std::vector<glm::dvec2>& off) {
  constexpr double rounding = 1e-3;  // of the mean square
  std::array<std::vector<glm::dvec2>, 2> places_on, off_on;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t side = glm::dot(off[i], off.front()) > 0 ? 0 : 1;
    places_on[side].push_back(places[i]), off_on[side].push_back(off[i]);
  }
  for (const std::size_t side : {0, 1})
    if (!changes_evenly(places_on[side], off_on[side], rounding)) return 0;
  // Less the force with which it ends, both sides are one line.
  const LinearForce one = linear_force(places_on[0], off_on[0]), other = linear_force(places_on[1], off_on[1]);
  const double slope = glm::length(one.by_x) + glm::length(one.by_y);
  if (glm::length(one.by_x - other.by_x) + glm::length(one.by_y - other.by_y) > 0.01 * slope) return 0;
  const double newton = 0.5 * glm::length(one.mean - other.mean);
  return newton >= least_force ? newton : 0;
}

}  // namespace wale
