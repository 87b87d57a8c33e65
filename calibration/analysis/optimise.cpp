#include "calibration/analysis/optimise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace wale::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double number_or_infinity(double value) {
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

/// One descent of a simplex.
Minimum descend(const Objective& objective, const VectorXd& start, const VectorXd& steps, double tolerance, int most) {
  const Eigen::Index n = start.size();
  Minimum result;
  const auto value_at = [&](const VectorXd& at) {
    ++result.evaluations;
    return number_or_infinity(objective(at));
  };
  std::vector<VectorXd> corners(static_cast<std::size_t>(n) + 1, start);
  for (Eigen::Index i = 0; i < n; ++i) corners[static_cast<std::size_t>(i) + 1](i) += steps(i);
  std::vector<double> values;
  for (const VectorXd& corner : corners) values.push_back(value_at(corner));
  std::vector<std::size_t> order(corners.size());
  while (result.evaluations < most) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    const std::size_t best = order.front(), worst = order.back(), second = order[order.size() - 2];
    double size = 0;
    for (const VectorXd& corner : corners) size = std::max(size, (corner - corners[best]).cwiseAbs().maxCoeff());
    const double scale = 1 + corners[best].cwiseAbs().maxCoeff();
    if (values[worst] - values[best] <= tolerance * (1 + std::abs(values[best])) && size <= std::sqrt(tolerance) * scale) {
      result.converged = true;
      break;
    }
    VectorXd centre = VectorXd::Zero(n);
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (i != worst) centre += corners[i];
    centre /= static_cast<double>(n);
    const VectorXd away = centre - corners[worst];
    const auto take = [&](const VectorXd& at, double value) { corners[worst] = at, values[worst] = value; };
    const VectorXd reflected = centre + away;
    const double reflected_value = value_at(reflected);
    if (reflected_value < values[best]) {
      const VectorXd expanded = centre + 2 * away;
      const double expanded_value = value_at(expanded);
      expanded_value < reflected_value ? take(expanded, expanded_value) : take(reflected, reflected_value);
    } else if (reflected_value < values[second]) {
      take(reflected, reflected_value);
    } else {
      const VectorXd contracted =
          reflected_value < values[worst] ? VectorXd(centre + 0.5 * away) : VectorXd(centre - 0.5 * away);
      const double contracted_value = value_at(contracted);
      if (contracted_value < std::min(reflected_value, values[worst])) {
        take(contracted, contracted_value);
      } else {
        for (std::size_t i = 0; i < corners.size(); ++i) {
          if (i == best) continue;
          corners[i] = corners[best] + 0.5 * (corners[i] - corners[best]);
          values[i] = value_at(corners[i]);
        }
      }
    }
  }
  const auto best = static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
  result.at = corners[best], result.value = values[best];
  return result;
}

}  // namespace

Minimum minimise(const Objective& objective, const VectorXd& start, const VectorXd& steps, double tolerance,
                 int most_evaluations) {
  if (start.size() == 0) return {start, number_or_infinity(objective(start)), 1, true};
  Minimum best = descend(objective, start, steps, tolerance, most_evaluations);
  VectorXd again = steps;
  while (best.evaluations < most_evaluations) {
    again *= -0.3;  // from the other side, so that a simplex that has become flat opens again
    Minimum next = descend(objective, best.at, again, tolerance, most_evaluations - best.evaluations);
    next.evaluations += best.evaluations;
    const double gain = best.value - next.value;
    if (next.value <= best.value) best = next;
    best.evaluations = next.evaluations;
    if (!(gain > 1e-9 * (1 + std::abs(best.value)))) break;
  }
  return best;
}

VectorXd gradient(const Objective& objective, const VectorXd& at, double step) {
  VectorXd result(at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const double h = step * std::max(1.0, std::abs(at(i)));
    const auto slope = [&](double width) {
      VectorXd more = at, less = at;
      more(i) += width, less(i) -= width;
      return (objective(more) - objective(less)) / (2 * width);
    };
    result(i) = (4 * slope(h / 2) - slope(h)) / 3;
  }
  return result;
}

MatrixXd hessian(const Objective& objective, const VectorXd& at, double step) {
  const Eigen::Index n = at.size();
  VectorXd h(n);
  for (Eigen::Index i = 0; i < n; ++i) h(i) = step * std::max(1.0, std::abs(at(i)));
  const double here = objective(at);
  const auto with_width = [&](double share) {
    MatrixXd result(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        const double a = share * h(i), b = share * h(j);
        const auto moved = [&](double along_i, double along_j) {
          VectorXd place = at;
          place(i) += along_i, place(j) += along_j;
          return objective(place);
        };
        result(i, j) = i == j ? (moved(a, 0) - 2 * here + moved(-a, 0)) / (a * a)
                              : (moved(a, b) - moved(a, -b) - moved(-a, b) + moved(-a, -b)) / (4 * a * b);
        result(j, i) = result(i, j);
      }
    return result;
  };
  return (4 * with_width(0.5) - with_width(1)) / 3;
}

Minimum polish(const Objective& objective, const Minimum& from) {
  Minimum best = from;
  for (int round = 0; round < 8 && best.at.size() > 0; ++round) {
    const MatrixXd curvature = hessian(objective, best.at);
    const Eigen::LDLT<MatrixXd> factors(curvature);
    if (factors.info() != Eigen::Success || !factors.isPositive()) break;
    const VectorXd move = factors.solve(-gradient(objective, best.at));
    if (!move.allFinite()) break;
    const VectorXd at = best.at + move;
    const double value = number_or_infinity(objective(at));
    if (!(value <= best.value)) break;
    const bool still = best.value - value < 1e-13 * (1 + std::abs(value)) && move.cwiseAbs().maxCoeff() < 1e-9;
    best.at = at, best.value = value;
    if (still) break;
  }
  return best;
}

double lowest_within(const std::function<double(double)>& function, double low, double high, double tolerance) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = number_or_infinity(function(a)), at_b = number_or_infinity(function(b));
  while (high - low > tolerance * (1 + std::abs(low) + std::abs(high))) {
    if (at_a <= at_b) {
      high = b, b = a, at_b = at_a;
      a = high - golden * (high - low), at_a = number_or_infinity(function(a));
    } else {
      low = a, a = b, at_a = at_b;
      b = low + golden * (high - low), at_b = number_or_infinity(function(b));
    }
  }
  return (low + high) / 2;
}

double crossing(const std::function<double(double)>& function, double from, double to, double tolerance) {
  double at_from = function(from), at_to = function(to);
  if (!((at_from < 0) != (at_to < 0))) return std::abs(at_from) <= std::abs(at_to) ? from : to;
  for (int i = 0; i < 200 && std::abs(to - from) > tolerance * (1 + std::abs(from) + std::abs(to)); ++i) {
    // False position, and bisection whenever that would stay near one end.
    double middle = from - at_from * (to - from) / (at_to - at_from);
    const double nearest = std::min(std::abs(middle - from), std::abs(middle - to));
    if (!std::isfinite(middle) || i % 2 == 1 || nearest < 0.01 * std::abs(to - from)) middle = (from + to) / 2;
    const double value = function(middle);
    if ((value < 0) == (at_from < 0))
      from = middle, at_from = value;
    else
      to = middle, at_to = value;
  }
  return (from + to) / 2;
}

}  // namespace wale::analysis
