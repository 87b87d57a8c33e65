#pragma once

#include <complex>
#include <glm/vec2.hpp>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// The force on hands at rest that have just entered, on a lattice of `side` * `side` positions, row by row from (-,
/// -).
struct ForceField {
  std::size_t side = 0;
  glm::dvec2 centre{0};   ///< m from the patch's centre
  glm::dvec2 spacing{0};  ///< m between neighbours
  std::vector<Force> forces;

  glm::dvec2 place(std::size_t column, std::size_t row) const {
    const double middle = 0.5 * (static_cast<double>(side) - 1);
    return centre + spacing * glm::dvec2(static_cast<double>(column) - middle, static_cast<double>(row) - middle);
  }
  glm::dvec2 extent() const { return spacing * static_cast<double>(side); }
};

/// Runs the program over a window of `size` (m) about `centre`. Deterministic.
ForceField sample_force_field(const Bank& bank, glm::dvec2 centre, glm::dvec2 size, std::size_t side);

/// A plane fitted to a field: the mean force and its change with position.
struct LinearField {
  glm::dvec2 mean{0};
  glm::dvec2 by_x{0}, by_y{0};  ///< N/m: d force / dx and d force / dy, by least squares

  /// The stiffness that draws the hand back to a point, N/m; negative if the force pushes away.
  double stiffness() const { return -0.5 * (by_x.x + by_y.y); }
};

LinearField linear_part(const ForceField& field);

/// A part of a field: `side` rows and columns from this row and column on.
ForceField part_of(const ForceField& field, std::size_t first_column, std::size_t first_row, std::size_t side);

/// The field without its mean and its slope.
ForceField without(ForceField field, const LinearField& part);

/// The forces as complex numbers x + i y.
std::vector<std::complex<float>> as_complex(const std::vector<Force>& forces);

inline float squared(Force force) { return force.x * force.x + force.y * force.y; }

/// The quantile of the values at `share`, 0 .. 1. Reorders its copy; 0 for no values.
double quantile(std::vector<float> values, double share);

}  // namespace wale
