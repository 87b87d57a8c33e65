// Intervals of profile likelihood: where the best likelihood with one parameter held is as much lower as chi-squared of
// one degree of freedom allows.
#include <algorithm>
#include <cmath>
#include <functional>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/mixed_likelihood.hpp"
#include "calibration/analysis/mixed_model.hpp"
#include "calibration/analysis/optimise.hpp"

namespace wale::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of -2 log likelihood, over its size: much less than moves the third digit of an interval.
constexpr double inner_tolerance = 1e-9;

/// The covariance of the observers' terms by an unconstrained vector. One deviation may be held: its row of the factor
/// then has that length, and its last entry follows from the others.
class HeldFactor {
 public:
  HeldFactor(const MixedFit& fit, Index held) : variation_(fit.variation), held_(held), q_(fit.covariance.rows()) {
    MatrixXd factor = MatrixXd::Zero(q_, q_);
    // A Cholesky factor row by row, also of a covariance with zero rows.
    for (Index i = 0; i < q_; ++i)
      for (Index j = 0; j <= i; ++j) {
        double sum = fit.covariance(i, j);
        for (Index k = 0; k < j; ++k) sum -= factor(i, k) * factor(j, k);
        factor(i, j) = i == j ? std::sqrt(std::max(sum, 0.0)) : factor(j, j) > 0 ? sum / factor(j, j) : 0;
      }
    std::vector<double> start;
    for (Index i = 0; i < q_; ++i)
      for (Index j = 0; j <= i; ++j) {
        if (!is_free(i, j)) continue;
        const double length = factor.row(i).norm();
        start.push_back(i == held_ ? (length > 0 ? factor(i, j) / length : 0) : factor(i, j));
      }
    start_ = Eigen::Map<VectorXd>(start.data(), static_cast<Index>(start.size()));
  }

  const VectorXd& start() const { return start_; }

  /// The factor, or an empty one outside its limits.
  MatrixXd factor(const VectorXd& free, double held_value) const {
    MatrixXd result = MatrixXd::Zero(q_, q_);
    Index at = 0;
    for (Index i = 0; i < q_; ++i)
      for (Index j = 0; j <= i; ++j)
        if (is_free(i, j)) result(i, j) = free(at++);
    if (held_ < 0) return result;
    const double others = result.row(held_).squaredNorm();
    if (others > 1) return {};
    result(held_, held_) = std::sqrt(1 - others);
    result.row(held_) *= held_value;
    return result;
  }

 private:
  bool is_free(Index i, Index j) const {
    const bool both = variation_ == Variation::correlated || variation_ == Variation::independent;
    const bool row = both || (variation_ == Variation::constant_only && i == 0) ||
                     (variation_ == Variation::slopes_only && i > 0);
    if (!row || (i != j && variation_ != Variation::correlated)) return false;
    return !(i == held_ && j == held_);
  }

  Variation variation_;
  Index held_, q_;
  VectorXd start_;
};

/// The ends at which `excess` is zero on both sides of `best`, where it is below zero. `least` is the lowest value.
Interval ends(const std::function<double(double)>& excess, double best, double width, double least) {
  const auto end = [&](double direction) {
    double near = best, step = width;
    for (int i = 0; i < 60; ++i) {
      double far = near + direction * step;
      if (far <= least) {
        far = least;
        if (excess(far) < 0) return least;
        return crossing(excess, near, far, 1e-5);
      }
      if (excess(far) > 0) return crossing(excess, near, far, 1e-5);
      near = far, step *= 1.6;
    }
    return direction * HUGE_VAL;
  };
  return {end(-1), end(1)};
}

}  // namespace

Interval profile_deviation(const MixedData& data, Variation variation, std::size_t term, Criterion criterion,
                           double confidence) {
  const auto fit = fit_mixed(data, criterion, variation);
  if (!fit || !(fit->deviation(term) > 0)) return {0, 0};
  const MixedLikelihood likelihood(data);
  const double allowed = fit->deviance + chi_squared_quantile(confidence, 1), best = fit->deviation(term);
  const HeldFactor held(*fit, static_cast<Index>(term));
  const Index free = held.start().size();
  VectorXd warm(free + 1);
  warm.head(free) = held.start();
  warm(free) = std::log(fit->residual);
  VectorXd steps = (0.2 * warm.cwiseAbs()).array() + 0.02;
  steps(free) = 0.1;
  const auto excess = [&](double value) {
    const auto found = minimise(
        [&](const VectorXd& at) {
          const MatrixXd factor = held.factor(at.head(free), value);
          if (factor.size() == 0) return HUGE_VAL;
          const double residual = std::exp(at(free));
          return likelihood.at(factor / residual, residual, criterion);
        },
        warm, steps, inner_tolerance, 3000);
    warm = found.at;
    return found.value - allowed;
  };
  return ends(excess, best, 0.3 * best, 0);
}

Interval profile_residual(const MixedData& data, Variation variation, Criterion criterion, double confidence) {
  const auto fit = fit_mixed(data, criterion, variation);
  if (!fit) return {0, HUGE_VAL};
  const MixedLikelihood likelihood(data);
  const double allowed = fit->deviance + chi_squared_quantile(confidence, 1);
  const HeldFactor all(*fit, -1);
  VectorXd warm = all.start() / fit->residual;
  const VectorXd steps = (0.2 * warm.cwiseAbs()).array() + 0.02;
  const auto excess = [&](double residual) {
    if (!(residual > 0)) return HUGE_VAL;
    const auto found = minimise([&](const VectorXd& at) { return likelihood.at(all.factor(at, 0), residual, criterion); },
                                warm, steps, inner_tolerance, 3000);
    warm = found.at;
    return found.value - allowed;
  };
  return ends(excess, fit->residual, 0.1 * fit->residual, 1e-6 * fit->residual);
}

Interval profile_coefficient(const MixedData& data, Variation variation, std::size_t coefficient, double confidence) {
  const auto fit = fit_mixed(data, Criterion::likelihood, variation);
  if (!fit) return {-HUGE_VAL, HUGE_VAL};
  const MixedLikelihood likelihood(data);
  const double allowed = fit->deviance + chi_squared_quantile(confidence, 1);
  const HeldFactor all(*fit, -1);
  VectorXd warm = all.start() / fit->residual;
  const VectorXd steps = (0.2 * warm.cwiseAbs()).array() + 0.02;
  const auto excess = [&](double value) {
    const auto found = minimise(
        [&](const VectorXd& at) { return likelihood.with_coefficient(all.factor(at, 0), coefficient, value); }, warm, steps, inner_tolerance, 3000);
    warm = found.at;
    return found.value - allowed;
  };
  const Coefficient& best = fit->coefficients[coefficient];
  return ends(excess, best.value, best.error, -HUGE_VAL);
}

}  // namespace wale::analysis
