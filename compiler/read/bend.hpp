#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace wale {

/// Solves a small symmetric system by Gauss and Jordan, the right side in the last column; false if it is singular.
template <std::size_t N>
bool solve(std::array<std::array<double, N + 1>, N>& rows) {
  for (std::size_t i = 0; i < N; ++i) {
    std::size_t best = i;
    for (std::size_t k = i + 1; k < N; ++k)
      if (std::abs(rows[k][i]) > std::abs(rows[best][i])) best = k;
    std::swap(rows[i], rows[best]);
    if (!(std::abs(rows[i][i]) > 1e-12)) return false;
    for (std::size_t k = 0; k < N; ++k) {
      if (k == i) continue;
      const double times = rows[k][i] / rows[i][i];
      for (std::size_t column = i; column <= N; ++column) rows[k][column] -= times * rows[i][column];
    }
  }
  for (std::size_t i = 0; i < N; ++i) rows[i][N] /= rows[i][i];
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
Bend best_bend(std::vector<PlaceOnLine> line, BendKind kind, std::size_t every = 1);

}  // namespace wale
