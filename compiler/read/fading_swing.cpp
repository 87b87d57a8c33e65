#include "compiler/read/fading_swing.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/relief_figures.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t most_apart = 128;     // ticks between the samples of a recurrence
constexpr double not_explained = 0.02;      // of the changing force, as root of the mean square
constexpr double told_exactly = 1e-4;
constexpr double fewest_swings_lasting = 0.4;  // in the time in which it falls to 1/e
constexpr double slowest_fading = 0.4;      // Hz
constexpr double falls_to_half = 0.5;
constexpr double plainly_one_axis = 0.5, nearly_turned_about = 1e-3;

/// cos and sin of a swing whose size changes by an exponential, and 1.
Eigen::Vector3d fading_at(double seconds, double frequency, double change) {
  const double size = std::exp(change * seconds), angle = 2 * std::numbers::pi * frequency * seconds;
  return {size * std::cos(angle), size * std::sin(angle), 1};
}

using Fading = Eigen::Matrix<double, 3, 2>;

Fading fading_fit(const std::vector<Force>& forces, double rate, double frequency, double change) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Fading right = Fading::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Eigen::Vector3d row = fading_at(static_cast<double>(i) / rate, frequency, change);
    normal += row * row.transpose();
    right += row * Eigen::RowVector2d(forces[i].x, forces[i].y);
  }
  return normal.ldlt().solve(right);
}

/// The two numbers of the recurrence that samples of such a swing obey beside a constant, from their changes.
std::optional<std::complex<double>> root_of(const std::vector<Force>& forces, std::size_t apart) {
  // c' = p c + q c'' of changes c, whose constant is gone.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 3 * apart; i < forces.size(); i += (apart + 1) / 2)
    for (const int axis : {0, 1}) {
      const auto change = [&](std::size_t back) {
        return double{forces[i - back * apart][axis]} - forces[i - (back + 1) * apart][axis];
      };
      const Eigen::Vector2d row(change(1), change(2));
      normal += row * row.transpose(), right += row * change(0);
    }
  if (!(std::abs(normal.determinant()) > 0)) return std::nullopt;
  const Eigen::Vector2d numbers = normal.fullPivLu().solve(right);
  const double below = numbers[0] * numbers[0] + 4 * numbers[1];
  if (!(below < 0)) return std::nullopt;
  return std::complex(0.5 * numbers[0], 0.5 * std::sqrt(-below));
}

}  // namespace

std::optional<Swing> fading_swing(const std::vector<Force>& forces, double rate) {
  if (forces.size() < 8) return std::nullopt;
  const double seconds = static_cast<double>(forces.size()) / rate;
  std::optional<Swing> best;
  double least_left = not_explained * not_explained;
  for (std::size_t apart = 1; apart <= most_apart && 8 * apart < forces.size(); apart *= 2) {
    const auto root = root_of(forces, apart);
    if (!root) continue;
    const double step = static_cast<double>(apart) / rate;
    const double change = std::log(std::abs(*root)) / step, frequency = std::arg(*root) / (2 * std::numbers::pi * step);
    if (!std::isfinite(change) || frequency < slowest_fading || frequency < fewest_swings_lasting * std::abs(change)) continue;
    // One that hardly changes is a steady one.
    if (std::exp(-std::abs(change) * seconds) > falls_to_half || std::abs(change) * step > 20) continue;
    const Fading fit = fading_fit(forces, rate, frequency, change);
    double left = 0, squares = 0;
    std::vector<double> sizes;
    double xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const Eigen::RowVector2d told =
          fading_at(static_cast<double>(i) / rate, frequency, change).transpose() * fit;
      left += (Eigen::RowVector2d(forces[i].x, forces[i].y) - told).squaredNorm();
      const Eigen::RowVector2d swing = told - fit.row(2);
      squares += swing.squaredNorm(), sizes.push_back(swing.norm());
      xx += swing[0] * swing[0], yy += swing[1] * swing[1], xy += swing[0] * swing[1];
    }
    if (!(left < least_left * squares)) continue;
    least_left = left / squares;
    Swing found;
    found.amplitude = percentile(sizes, percentile_of_amplitude), found.frequency = frequency;
    if (std::hypot(xx - yy, 2 * xy) >= plainly_one_axis * (xx + yy)) {
      const double angle = std::fmod(0.5 * std::atan2(2 * xy, xx - yy) + std::numbers::pi, std::numbers::pi);
      found.axis = std::numbers::pi - angle < nearly_turned_about ? 0 : angle;
    }
    const double half = std::log(2.0) / std::abs(change), tenth = std::log(10.0) / std::abs(change);
    const bool grows = change > 0, ends = tenth < seconds;
    found.course = SwingCourse{.grows = grows,
                               .greatest = std::ranges::max(sizes),
                               .half_after = grows ? seconds - half : half,
                               .tenth_after = !ends ? 0 : grows ? seconds - tenth : tenth};
    found.rate_of_change = change;
    best = found;
    if (least_left < told_exactly * told_exactly) break;
  }
  return best;
}

std::vector<std::vector<Force>> without_fading(const std::vector<std::vector<Force>>& felt, double rate,
                                               double frequency, double rate_of_change) {
  std::vector<std::vector<Force>> left = felt;
  for (std::vector<Force>& forces : left) {
    Fading fit = fading_fit(forces, rate, frequency, rate_of_change);
    fit.row(2).setZero();
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const Eigen::RowVector2d told =
          fading_at(static_cast<double>(i) / rate, frequency, rate_of_change).transpose() * fit;
      forces[i] -= Force(static_cast<float>(told[0]), static_cast<float>(told[1]));
    }
  }
  return left;
}

}  // namespace wale
