#include "compiler/read/read.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/read/breakaway.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/tolerances.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

constexpr int places_a_side = 12;   // at which a trend's stiffness is looked at
constexpr double beside_it = 1e-3;  // m: half the step for it
constexpr double alike = 0.15;      // relative difference at which two stiffnesses count as one
constexpr double mostly = 0.5;      // of the places: a spring's

/// The stiffness that draws the hand back, if it is alike at most places.
double even_stiffness(const StaticForce& still, PatchSize patch) {
  if (still.features.empty()) return still.trend.stiffness();
  const auto trend = [&](glm::dvec2 place) {
    glm::dvec2 force = still.trend.at(place);
    for (const Feature& each : still.features)
      if (each.monotone) force += each.at(place);
    return force;
  };
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  std::vector<double> all;
  for (int row = 0; row < places_a_side; ++row)
    for (int column = 0; column < places_a_side; ++column) {
      const glm::dvec2 place = half * ((glm::dvec2(column, row) + 0.5) / (0.5 * places_a_side) - 1.0);
      const glm::dvec2 x(beside_it, 0), y(0, beside_it);
      const double along_x = (trend(place - x) - trend(place + x)).x, along_y = (trend(place - y) - trend(place + y)).y;
      // A wall and a spring that has saturated along one axis are stiff along the other only.
      if (std::abs(along_x - along_y) <= alike * std::abs(along_x + along_y))
        all.push_back((along_x + along_y) / (4 * beside_it));
    }
  if (all.empty()) return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::ranges::nth_element(all, middle);
  const double stiffness = *middle;
  const auto near = std::ranges::count_if(
      all, [&](double each) { return std::abs(each - stiffness) <= alike * std::abs(stiffness); });
  return static_cast<double>(near) >= mostly * places_a_side * places_a_side ? stiffness : 0;
}

}  // namespace

ForceReading read(const Bank& bank, const Declarations&, ReadParts wanted) {
  if (bank.program().description().vibrates()) return {};  // such a program has no force
  ForceReading found;
  const bool remembers = remembers_anything(bank.program().description());
  const auto read_still = [&] { found.still = static_force(bank); };
  const auto read_moving = [&] {
    found.opposing = opposing_force(bank);
    found.breakaway = breakaway_of(bank, found.opposing.friction);
    found.inertia = inertia(bank);
    tell_swings(bank, found.sway, found.vibration);
  };
  const auto part = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i == 0 && wanted.still) read_still();
      if (i == 1 && wanted.moving) read_moving();
    }
  };
  // Strokes that run tick by tick take as long as all static measurements together.
  const std::size_t parts = leaves_out_motion(bank.program().description()) ? 1 : 2;
  if (remembers && wanted.still && wanted.moving)
    in_parallel(parts, part);
  else
    part(0, parts);
  if (!wanted.still) return found;
  // A face bends the force, unless the program has memory and yielded to the hands that were placed behind the face.
  if (remembers) found.wall = wall_face(bank);
  if (!found.wall && !found.still.features.empty()) found.wall = wall_face(bank, found.still.features);
  if (!found.wall && !remembers && !found.still.features.empty()) found.wall = wall_face(bank);
  if (!found.wall || !found.still.features.empty()) found.stiffness = even_stiffness(found.still, bank.size());
  if (found.wall && std::abs(found.stiffness - found.wall->stiffness) < alike * found.wall->stiffness)
    found.stiffness = 0;
  return found;
}

}  // namespace wale
