#include "compiler/read/pair_of_waves.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace wale {
namespace {

constexpr double fewest_of_pair = 1.5, most_of_pair = 12, between_pairs = 0.25;  // periods over the length
constexpr double least_apart = 0.75;                         // of a pair: nearer ones are one wave that fades
constexpr int of_line = 3;                                   // columns: a constant, and along each axis

}  // namespace

std::array<glm::dvec2, 2> best_pair_along(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                                          glm::dvec2 way, double length) {
  const auto count = static_cast<int>((most_of_pair - fewest_of_pair) / between_pairs) + 1;
  const auto periods = [](int wave) { return fewest_of_pair + between_pairs * wave; };
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(places.size()), of_line + 2 * count);
  Eigen::MatrixXd felt(columns.rows(), 2);
  for (Eigen::Index row = 0; row < columns.rows(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    const double along = glm::dot(places[i], way) / length;
    columns(row, 0) = 1, columns(row, 1) = places[i].x / length, columns(row, 2) = places[i].y / length;
    for (int wave = 0; wave < count; ++wave) {
      const double angle = 2 * std::numbers::pi * periods(wave) * along;
      columns(row, of_line + 2 * wave) = std::cos(angle), columns(row, of_line + 2 * wave + 1) = std::sin(angle);
    }
    felt(row, 0) = forces[i].x, felt(row, 1) = forces[i].y;
  }
  // Every pair's normal equations are parts of those of all waves at once.
  const Eigen::MatrixXd products = columns.transpose() * columns, with_force = columns.transpose() * felt;
  constexpr int unknowns = of_line + 4;
  Eigen::Matrix<double, unknowns, unknowns> system;
  Eigen::Matrix<double, unknowns, 2> right;
  double most = -HUGE_VAL;
  std::array<glm::dvec2, 2> best{};
  for (int one = 0; one < count; ++one)
    for (int other = one + 1; other < count; ++other) {
      if (periods(other) - periods(one) < least_apart) continue;
      const std::array<int, unknowns> from{0, 1, 2, of_line + 2 * one, of_line + 2 * one + 1, of_line + 2 * other,
                                           of_line + 2 * other + 1};
      for (int row = 0; row < unknowns; ++row) {
        for (int column = 0; column < unknowns; ++column) system(row, column) = products(from[row], from[column]);
        right.row(row) = with_force.row(from[row]);
      }
      const double explained = system.ldlt().solve(right).cwiseProduct(right).sum();
      if (explained > most) most = explained, best = {periods(one) / length * way, periods(other) / length * way};
    }
  return best;
}

}  // namespace wale
