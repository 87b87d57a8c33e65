#include "compiler/read/still_forces.hpp"

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "compiler/measure/coarseness.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

constexpr std::size_t cells_a_mean = 4;
constexpr std::size_t hands_at_once = 2048;  // so many stay in the cache
/// Work above this, in units of cost over all hands, is worth another thread: about a millisecond.
constexpr double worth_another_thread = 2e6;

/// A number from 0 to 1 for each `index`, without order: the finaliser of MurmurHash3.
double scattered(std::uint64_t index) {
  index = (index ^ index >> 33) * 0xff51afd7ed558ccdu;
  index = (index ^ index >> 33) * 0xc4ceb9fe1a85ec53u;
  return static_cast<double>((index ^ index >> 33) >> 11) * 0x1p-53;
}

}  // namespace

std::vector<glm::dvec2> forces_at(const Bank& bank, std::span<const glm::dvec2> places) {
  std::vector<glm::dvec2> forces(places.size());
  // Each part writes only its own forces, so the division among threads does not change the result.
  const auto run = [&](std::size_t begin, std::size_t end) {
    std::vector<Hand> hands(std::min(hands_at_once, end - begin));
    std::vector<Force> felt(hands.size());
    for (std::size_t first = begin; first < end; first += hands_at_once) {
      const std::size_t count = std::min(hands_at_once, end - first);
      for (std::size_t i = 0; i < count; ++i) hands[i].position = hands[i].workspace = glm::vec2(places[first + i]);
      tick_coarsely(bank, std::span(hands).first(count), std::span(felt).first(count));
      std::copy_n(felt.begin(), count, forces.begin() + static_cast<std::ptrdiff_t>(first));
    }
  };
  const PatchProgram& program = bank.program().description();
  const auto cost = static_cast<double>(cost_of(program.enter) + cost_of(program.tick));
  if (static_cast<double>(places.size()) * cost < worth_another_thread)
    run(0, places.size());
  else
    in_parallel(places.size(), run);
  return forces;
}

StillForces still_forces(const StillField& field, glm::dvec2 centre, glm::dvec2 size, std::size_t side) {
  StillForces still{side, centre, size, {}, {}};
  still.places.reserve(side * side);
  const glm::dvec2 cell = still.cell();
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column) {
      const std::uint64_t number = 2 * (row * side + column) + 1;
      const glm::dvec2 inside{scattered(number), scattered(number + 1)};
      still.places.push_back(centre - 0.5 * size + cell * (glm::dvec2(column, row) + inside));
    }
  still.forces = field(still.places);
  return still;
}

std::vector<glm::dvec2> cell_means(std::size_t side, std::span<const glm::dvec2> values) {
  std::vector<glm::dvec2> means;
  for (std::size_t top = 0; top < side; top += cells_a_mean)
    for (std::size_t left = 0; left < side; left += cells_a_mean) {
      glm::dvec2 sum{0};
      for (std::size_t row = top; row < top + cells_a_mean; ++row)
        for (std::size_t column = left; column < left + cells_a_mean; ++column) sum += values[row * side + column];
      means.push_back(sum / (1.0 * cells_a_mean * cells_a_mean));
    }
  return means;
}

std::vector<glm::dvec2> some_of(std::span<const glm::dvec2> all, std::size_t most) {
  std::size_t every = 1;
  // The next prime does not stay within some columns of the lattice.
  for (const std::size_t prime : {std::size_t{3}, std::size_t{7}, std::size_t{11}, std::size_t{13}})
    if (all.size() > most * every * 4 / 3) every = prime;
  std::vector<glm::dvec2> some;
  for (std::size_t i = 0; i < all.size(); i += every) some.push_back(all[i]);
  return some;
}

LinearForce linear_force(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) {
  LinearForce found;
  glm::dvec2 middle{0};
  for (const glm::dvec2& place : places) middle += place;
  middle /= static_cast<double>(places.size());
  double xx = 0, xy = 0, yy = 0;
  glm::dvec2 fx{0}, fy{0}, mean{0};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 at = places[i] - middle;
    xx += at.x * at.x, xy += at.x * at.y, yy += at.y * at.y;
    mean += forces[i], fx += at.x * forces[i], fy += at.y * forces[i];
  }
  mean /= static_cast<double>(places.size());
  const double area = xx * yy - xy * xy;
  if (area > 0) {
    found.by_x = (yy * fx - xy * fy) / area;
    found.by_y = (xx * fy - xy * fx) / area;
  }
  found.mean = mean - middle.x * found.by_x - middle.y * found.by_y;
  return found;
}

double mean_square(std::span<const glm::dvec2> forces) {
  double sum = 0;
  for (const glm::dvec2& force : forces) sum += glm::dot(force, force);
  return forces.empty() ? 0 : sum / static_cast<double>(forces.size());
}

}  // namespace wale
