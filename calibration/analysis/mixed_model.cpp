#include "calibration/analysis/mixed_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/mixed_likelihood.hpp"
#include "calibration/analysis/optimise.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A deviation of less than this, over the residual's and for a column of effective size 1, is zero.
constexpr double negligible = 1e-4;

bool varies(Variation variation, Index term) {
  switch (variation) {
    case Variation::correlated:
    case Variation::independent: return true;
    case Variation::constant_only: return term == 0;
    case Variation::slopes_only: return term > 0;
    case Variation::none: return false;
  }
  return false;
}

Index size_of(Variation variation, Index q) {
  if (variation == Variation::correlated) return q * (q + 1) / 2;
  Index count = 0;
  for (Index i = 0; i < q; ++i) count += varies(variation, i) ? 1 : 0;
  return count;
}

/// The lower triangular factor whose free entries are `theta`, row by row, each over the scale of its column.
MatrixXd factor_of(const VectorXd& theta, Variation variation, const MixedLikelihood& likelihood) {
  const Index q = likelihood.varying();
  MatrixXd factor = MatrixXd::Zero(q, q);
  Index at = 0;
  for (Index i = 0; i < q; ++i) {
    if (!varies(variation, i)) continue;
    const Index first = variation == Variation::correlated ? 0 : i;
    for (Index j = first; j <= i; ++j) factor(i, j) = theta(at++) / likelihood.scale(i);
  }
  return factor;
}

VectorXd start_of(Variation variation, Index q, double diagonal) {
  VectorXd theta = VectorXd::Zero(size_of(variation, q));
  Index at = 0;
  for (Index i = 0; i < q; ++i) {
    if (!varies(variation, i)) continue;
    at += variation == Variation::correlated ? i : 0;
    theta(at++) = diagonal;
  }
  return theta;
}

bool is_singular(const VectorXd& theta, Variation variation, Index q) {
  Index at = 0;
  for (Index i = 0; i < q; ++i) {
    if (!varies(variation, i)) continue;
    at += variation == Variation::correlated ? i : 0;
    if (std::abs(theta(at++)) < negligible) return true;
  }
  return false;
}

Minimum best_factor(const MixedLikelihood& likelihood, Criterion criterion, Variation variation) {
  const Objective deviance = [&](const VectorXd& theta) {
    return likelihood.profiled(factor_of(theta, variation, likelihood), criterion);
  };
  const Index q = likelihood.varying(), size = size_of(variation, q);
  Minimum best;
  for (const double diagonal : {1.0, 0.1}) {
    const Minimum found = polish(deviance, minimise(deviance, start_of(variation, q, diagonal),
                                                    VectorXd::Constant(size, 0.5 * diagonal), 1e-9, 4000));
    if (diagonal == 1.0 || found.value < best.value) best = found;
    // A boundary may be a side valley, so only then the second start is tried.
    if (size == 0 || !is_singular(best.at, variation, q)) break;
  }
  return best;
}

/// Satterthwaite's degrees of freedom of combinations of coefficients, one a row: the variance of their variance by the
/// curvature of the criterion in the parameters of the covariance. Where that is no maximum, and nothing is known of
/// the variance's own, the observers less one, as if each gave one number.
VectorXd satterthwaite(const MixedLikelihood& likelihood, Criterion criterion, Variation variation, const VectorXd& theta,
                       double residual, const MatrixXd& combinations, std::size_t observers) {
  const Index size = theta.size(), p = likelihood.fixed();
  VectorXd all(size + 1);
  all.head(size) = theta;
  all(size) = residual;
  // Steps of the residual are a share of it.
  const auto factor = [&](const VectorXd& at) { return factor_of(at.head(size), variation, likelihood); };
  VectorXd unit = all;
  unit(size) = 1;
  const auto residual_at = [&](const VectorXd& at) { return at(size) * residual; };
  const Objective deviance = [&](const VectorXd& at) { return likelihood.at(factor(at), residual_at(at), criterion); };
  const MatrixXd curvature = hessian(deviance, unit);
  const Eigen::LDLT<MatrixXd> solver(curvature);
  const bool is_maximum = solver.info() == Eigen::Success && solver.isPositive();
  VectorXd freedom(combinations.rows());
  for (Index i = 0; i < combinations.rows(); ++i) {
    const VectorXd combination = combinations.row(i).transpose();
    const Objective variance = [&](const VectorXd& at) {
      const MatrixXd products = likelihood.parts(factor(at)).products.topLeftCorner(p, p);
      const double s = residual_at(at);
      return s * s * combination.dot(products.llt().solve(combination));
    };
    const VectorXd slope = gradient(variance, unit);
    const double spread = 2 * slope.dot(solver.solve(slope)), value = variance(unit);
    const double found = 2 * value * value / spread;
    freedom(i) = is_maximum && spread > 0 && found > 0 && std::isfinite(found)
                     ? found
                     : std::max(0.0, static_cast<double>(observers) - 1);
  }
  return freedom;
}

}  // namespace

double MixedFit::deviation(std::size_t term) const {
  const auto i = static_cast<Index>(term);
  return std::sqrt(covariance(i, i));
}
double MixedFit::correlation(std::size_t a, std::size_t b) const {
  const auto i = static_cast<Index>(a), j = static_cast<Index>(b);
  const double product = std::sqrt(covariance(i, i) * covariance(j, j));
  return product > 0 ? covariance(i, j) / product : std::nan("");
}
const Coefficient& MixedFit::at(const std::string& name) const {
  return *std::ranges::find(coefficients, name, &Coefficient::name);
}

Result<MixedFit> fit_mixed(const MixedData& data, Criterion criterion, Variation variation) {
  const Index n = data.y.size(), p = data.fixed.columns.cols(), q = static_cast<Index>(data.varying.size());
  if (p == 0 || (data.fixed.columns.col(0).array() != 1).any())
    return refusal("the fit has no constant", "through the origin, a fit of logarithms depends on the units: add the constant");
  if (!data.fixed.columns.allFinite() || !data.y.allFinite())
    return refusal("a value to fit is no number", "look for zeros whose logarithm was taken");
  if (n <= p + size_of(variation, q))
    return refusal("there are " + std::to_string(n) + " answers for " +
                       std::to_string(p + size_of(variation, q) + 1) + " parameters",
                   "leave terms out, or collect more answers");
  if (const std::string name = dependent_column(data.fixed); !name.empty())
    return refusal("`" + name + "` depends on the terms before it, so its coefficient cannot be told from theirs",
                   "leave it out, or vary it independently");
  if (q > 6)
    return refusal(std::to_string(q) + " terms vary between observers, and 6 can", "let fewer slopes vary");
  if (variation != Variation::none && data.observers < 2)
    return refusal("there is one observer, whose difference from others cannot be estimated",
                   "let more people take part, or fit this one without variation between observers");
  const MixedLikelihood likelihood(data);
  const Minimum best = best_factor(likelihood, criterion, variation);
  const MatrixXd factor = factor_of(best.at, variation, likelihood);
  const MixedLikelihood::Parts parts = likelihood.parts(factor);
  MixedFit fit;
  fit.criterion = criterion, fit.variation = variation;
  fit.deviance = best.value;
  fit.residual = likelihood.residual(parts, criterion);
  const double scatter = std::sqrt((data.y.array() - data.y.mean()).square().mean());
  if (!(fit.residual > 1e-6 * scatter) || !std::isfinite(best.value))
    return refusal("the answers follow the model without any scatter, so nothing can be said of their errors",
                   "look whether they were computed and not given");
  fit.observations = static_cast<std::size_t>(n), fit.observers = data.observers;
  fit.parameters = static_cast<std::size_t>(p + best.at.size() + 1);
  fit.covariance = fit.residual * fit.residual * factor * factor.transpose();
  fit.covariance_of_coefficients = fit.residual * fit.residual *
                                   parts.products.topLeftCorner(p, p).llt().solve(MatrixXd::Identity(p, p));
  fit.singular = is_singular(best.at, variation, q);
  const bool combines = data.combination.size() == p;
  MatrixXd combinations = MatrixXd::Identity(p + (combines ? 1 : 0), p);
  if (combines) combinations.row(p) = data.combination.transpose();
  const VectorXd freedom =
      satterthwaite(likelihood, criterion, variation, best.at, fit.residual, combinations, data.observers);
  for (Index i = 0; i < p; ++i)
    fit.coefficients.push_back({data.fixed.names[static_cast<std::size_t>(i)],
                                parts.coefficients(i) + (i == 0 ? likelihood.shift() : 0),
                                std::sqrt(fit.covariance_of_coefficients(i, i)), freedom(i)});
  if (combines) {
    fit.combination.value = 0;
    for (Index i = 0; i < p; ++i)
      fit.combination.value += data.combination(i) * fit.coefficients[static_cast<std::size_t>(i)].value;
    fit.combination.error = std::sqrt(data.combination.dot(fit.covariance_of_coefficients * data.combination));
    fit.combination.freedom = freedom(p);
  }
  fit.observer_terms = MatrixXd::Zero(static_cast<Index>(data.observers), q);
  double squares = 0;
  for (std::size_t i = 0; i < data.observers; ++i) {
    const VectorXd terms = likelihood.observer_terms(i, factor, parts.coefficients);
    fit.observer_terms.row(static_cast<Index>(i)) = terms.transpose();
    squares += likelihood.squares_about(i, parts.coefficients, terms);
  }
  fit.conditional_share = squares / (fit.residual * fit.residual * static_cast<double>(n));
  return fit;
}

Result<MixedFit> fit_mixed_simplified(const MixedData& data, Criterion criterion) {
  const std::size_t q = data.varying.size();
  std::vector<std::string> reasons;
  Variation variation = q > 1 ? Variation::correlated : q == 1 ? Variation::constant_only : Variation::none;
  if (data.observers < 2 && variation != Variation::none) {
    reasons.push_back("there is one observer: nothing is known of how observers differ");
    variation = Variation::none;
  }
  for (;;) {
    auto fit = fit_mixed(data, criterion, variation);
    if (!fit) return fit;
    if (!fit->singular) {
      fit->simplified = reasons;
      return fit;
    }
    // Which terms do not vary, over the residual.
    const auto vanishes = [&](std::size_t term) {
      double squares = 0;
      for (Index i = 0; i < data.y.size(); ++i) {
        const double value = data.fixed.columns(i, static_cast<Index>(data.varying[term]));
        squares += value * value;
      }
      return fit->deviation(term) * std::sqrt(squares / static_cast<double>(data.y.size())) < 1.5 * negligible * fit->residual;
    };
    bool slope_vanishes = false;
    for (std::size_t i = 1; i < q; ++i) slope_vanishes |= vanishes(i);
    switch (variation) {
      case Variation::correlated:
        variation = Variation::independent;
        reasons.push_back("the fit with correlations is singular: the observers' constants and slopes are fitted as independent");
        break;
      case Variation::independent:
        if (vanishes(0) && !slope_vanishes) {
          variation = Variation::slopes_only;
          reasons.push_back("the observers' constants do not differ beyond the scatter of their answers, as after "
                            "equalisation: only slopes vary");
        } else {
          variation = Variation::constant_only;
          reasons.push_back("the observers' slopes do not differ beyond the scatter of their answers: only constants vary");
        }
        break;
      default:
        variation = Variation::none;
        reasons.push_back("observers do not differ beyond the scatter of their answers: least squares");
        break;
    }
  }
}

Comparison compare_by_likelihood(const MixedFit& simpler, const MixedFit& larger) {
  Comparison result;
  result.freedom = larger.parameters - simpler.parameters;
  result.chi_squared = std::max(0.0, simpler.deviance - larger.deviance);
  result.p = result.freedom > 0 ? chi_squared_above(result.chi_squared, static_cast<double>(result.freedom)) : 1;
  return result;
}

}  // namespace wale::analysis
