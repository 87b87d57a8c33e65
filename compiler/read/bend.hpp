#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace wale {

/// Solves a small system, whose right side is the last column and becomes the solution; false if it is singular.
template <std::size_t N>
bool solve(std::array<std::array<double, N + 1>, N>& rows) {
  constexpr int n = static_cast<int>(N);
  Eigen::Map<Eigen::Matrix<double, n, n + 1, Eigen::RowMajor>> system(rows.front().data());
  const Eigen::PartialPivLU<Eigen::Matrix<double, n, n>> factors(system.template leftCols<n>());
  if (!(factors.matrixLU().diagonal().cwiseAbs().minCoeff() > 1e-12)) return false;
  system.col(n) = factors.solve(system.col(n)).eval();
  return true;
}

/// Where along one coordinate a line bends or jumps. Of the values beyond the bend: their slope is steeper by `slope`,
/// and they are larger by `jump` at the bend.
struct Bend {
  double at = 0, slope = 0, jump = 0;
  double left = HUGE_VAL;  ///< mean square of what the bent line leaves
};

struct PlaceOnLine {
  double at = 0, value = 0;
};

/// What a line may do at one place.
enum class BendKind { bends, jumps, bends_and_jumps };

/// The best bend of all: least squares of a line, the depth behind the bend and a jump there, for each place of the
/// bend, or each `every`-th.
Bend best_bend(const std::vector<PlaceOnLine>& line, BendKind kind, std::size_t every = 1);
/// Of places that are sorted along the line.
Bend best_bend_of_sorted(std::vector<PlaceOnLine> line, BendKind kind, std::size_t every = 1);

/// Where a line bends twice, by means over parts of it; the nearer bend first. Nothing if it is too short.
std::optional<std::array<Bend, 2>> best_two_bends(const std::vector<PlaceOnLine>& line);

}  // namespace wale
