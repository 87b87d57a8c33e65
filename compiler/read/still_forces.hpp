#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// The force on hands at rest that have just entered, at one place in each cell of a square lattice. Where in its cell
/// a place lies is as if by chance, so waves that are too fine for the cells become noise and never look like slower
/// ones.
struct StillForces {
  std::size_t side = 0;            ///< cells along each axis; row by row from (-, -)
  glm::dvec2 centre{0}, size{0};   ///< m, of the lattice
  std::vector<glm::dvec2> places;  ///< m from the patch's centre
  std::vector<glm::dvec2> forces;  ///< N

  glm::dvec2 cell() const { return size / static_cast<double>(side); }
};

/// A field over the patch: its values at some places, m from the patch's centre.
using StillField = std::function<std::vector<glm::dvec2>(std::span<const glm::dvec2> places)>;

/// Samples a field in `side` * `side` cells of a window. Deterministic.
StillForces still_forces(const StillField& field, glm::dvec2 centre, glm::dvec2 size, std::size_t side);

/// The forces at these places.
std::vector<glm::dvec2> forces_at(const Bank& bank, std::span<const glm::dvec2> places);

/// Means over blocks of neighbouring cells of a lattice with `side` cells along each axis: of forces, nearly free of
/// texture.
std::vector<glm::dvec2> cell_means(std::size_t side, std::span<const glm::dvec2> values);

/// Every so-many-th of the values at a lattice's places, so that about `most` are left.
std::vector<glm::dvec2> some_of(std::span<const glm::dvec2> all, std::size_t most);

/// A linear field: the force at the origin, and its change along each axis (N/m).
struct LinearForce {
  glm::dvec2 mean{0}, by_x{0}, by_y{0};

  glm::dvec2 at(glm::dvec2 place) const { return mean + place.x * by_x + place.y * by_y; }
  /// The stiffness that draws the hand back to a point, N/m; negative if the force pushes away.
  double stiffness() const { return -0.5 * (by_x.x + by_y.y); }
};

/// The linear field nearest to these forces by least squares.
LinearForce linear_force(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces);

/// The mean square of some forces, N^2.
double mean_square(std::span<const glm::dvec2> forces);

}  // namespace wale
