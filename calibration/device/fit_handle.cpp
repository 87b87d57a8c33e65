#include "calibration/device/fit_handle.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "calibration/analysis/optimise.hpp"

namespace wale {
namespace {

using analysis::Coefficient;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double half_window_seconds = 0.04;
constexpr double most_delay = 0.03;  // s
constexpr double still_seconds = 0.008;
constexpr std::size_t fewest_windows = 20;

/// (1 - x^2)^4 and its derivatives: a window that ends smoothly.
double window(double x) { return std::abs(x) < 1 ? std::pow(1 - x * x, 4) : 0; }
double slope(double x) { return std::abs(x) < 1 ? -8 * x * std::pow(1 - x * x, 3) : 0; }
double curvature(double x) {
  return std::abs(x) < 1 ? -8 * std::pow(1 - x * x, 3) + 48 * x * x * std::pow(1 - x * x, 2) : 0;
}

/// The integrals of one run over all of its windows.
class Windows {
 public:
  Windows(std::span<const HandleTick> ticks, double tick_seconds)
      : ticks_(ticks),
        seconds_(tick_seconds),
        half_(static_cast<Index>(std::lround(half_window_seconds / tick_seconds))) {
    const auto room = half_ + static_cast<Index>(std::ceil(most_delay / tick_seconds)) + 2;
    const auto count = static_cast<Index>(ticks.size());
    for (Index middle = room; middle + room < count; middle += 2 * half_)
      if (moves_in(middle)) middles_.push_back(middle);
  }

  std::size_t count() const { return middles_.size(); }

  /// What mass, damping and friction each give: one row for each window.
  MatrixXd columns() const {
    MatrixXd columns(static_cast<Index>(count()), 3);
    const double width = static_cast<double>(half_) * seconds_;
    for (std::size_t row = 0; row < count(); ++row) {
      double mass = 0, damping = 0, friction = 0;
      for (Index k = -half_; k <= half_; ++k) {
        const double x = static_cast<double>(k) / static_cast<double>(half_);
        const double position = at(middles_[row] + k) - at(middles_[row]);
        mass += curvature(x) / (width * width) * position;
        damping -= slope(x) / width * position;
        friction += window(x) * direction(middles_[row] + k);
      }
      columns.row(static_cast<Index>(row)) << mass * seconds_, damping * seconds_, friction * seconds_;
    }
    return columns;
  }

  /// The weighted force, if each command arrives `delay` seconds late and is held for a tick.
  VectorXd forces(double delay) const {
    VectorXd forces(static_cast<Index>(count()));
    const auto around = half_ + static_cast<Index>(std::ceil(delay / seconds_)) + 1;
    for (std::size_t row = 0; row < count(); ++row) {
      double sum = 0;
      for (Index k = -around; k <= half_; ++k) {
        const double middle_of_hold = static_cast<double>(k) + 0.5 + delay / seconds_;
        sum += window(middle_of_hold / static_cast<double>(half_)) *
               ticks_[static_cast<std::size_t>(middles_[row] + k)].force;
      }
      forces[static_cast<Index>(row)] = sum * seconds_;
    }
    return forces;
  }

 private:
  double at(Index tick) const { return ticks_[static_cast<std::size_t>(tick)].position; }

  /// The sign of the velocity, from positions some ticks apart.
  double direction(Index tick) const {
    constexpr Index apart = 2;
    const double moved = at(tick + apart) - at(tick - apart);
    return moved > 0 ? 1 : moved < 0 ? -1 : 0;
  }

  bool moves_in(Index middle) const {
    const auto longest = std::max<Index>(4, static_cast<Index>(std::lround(still_seconds / seconds_)));
    Index still = 0;
    for (Index k = middle - half_; k <= middle + half_; ++k) {
      still = at(k) == at(k - 1) ? still + 1 : 0;
      if (still > longest) return false;
    }
    return true;
  }

  std::span<const HandleTick> ticks_;
  double seconds_;
  Index half_;
  std::vector<Index> middles_;
};

Error unfit_handle(std::string sentence, std::string mend) {
  return Error{.code = Code::not_measured, .sentence = std::move(sentence), .mend = std::move(mend)};
}

}  // namespace

Result<HandleFit> fit_handle(std::span<const HandleTick> ticks, double tick_seconds) {
  const Windows windows(ticks, tick_seconds);
  if (windows.count() < fewest_windows)
    return unfit_handle("the handle moved in only " + std::to_string(windows.count()) + " stretches of the run",
                        "take your hand off the handle, and let more force be used (`--max-force`)");
  const MatrixXd columns = windows.columns();
  const Eigen::ColPivHouseholderQR<MatrixXd> factors(columns);
  if (factors.rank() < 3)
    return unfit_handle("the handle's motion does not tell mass, damping and friction apart",
                        "take your hand off the handle, and let more force be used (`--max-force`)");
  const auto misfit = [&](double delay) {
    const VectorXd forces = windows.forces(delay);
    return (forces - columns * factors.solve(forces)).squaredNorm();
  };
  const double delay = analysis::lowest_within(misfit, 0, most_delay, 1e-7);
  if (delay > 0.99 * most_delay)
    return unfit_handle("the handle does not move as a mass with damping and friction does",
                        "take your hand off it, and look whether it strikes its stop");
  const VectorXd forces = windows.forces(delay), found = factors.solve(forces);
  const double squares = (forces - columns * found).squaredNorm();
  const double freedom = static_cast<double>(windows.count()) - 4;

  // The delay's own column, by a difference.
  MatrixXd slopes(columns.rows(), 4);
  const double step = tick_seconds / 4;
  slopes << columns, -(windows.forces(delay + step) - windows.forces(std::max(0.0, delay - step))) /
                         (delay + step - std::max(0.0, delay - step));
  const MatrixXd inverse = (slopes.transpose() * slopes).ldlt().solve(MatrixXd::Identity(4, 4));
  const auto figure = [&](const char* name, double value, Index place) {
    return Coefficient{name, value, std::sqrt(squares / freedom * inverse(place, place)), freedom};
  };
  HandleFit fit{.mass = figure("mass", found[0], 0),
                .damping = figure("damping", found[1], 1),
                .friction = figure("friction", found[2], 2),
                .delay = figure("delay", delay, 3),
                .deviation = std::sqrt(squares / freedom) / (half_window_seconds * 256 / 315),
                .windows = windows.count()};
  if (!(fit.mass.value > 0))
    return unfit_handle("the handle moves as if it had no mass",
                        "look whether something holds it, and whether its motors push the right way");
  return fit;
}

}  // namespace wale
