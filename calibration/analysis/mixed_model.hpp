#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibration/analysis/least_squares.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// What a mixed model is fitted by: restricted maximum likelihood for estimates, maximum likelihood to compare models
/// with different fixed terms.
enum class Criterion { restricted, likelihood };

/// Which of the observers' own terms vary, and whether together. In the order in which they are simplified.
enum class Variation {
  correlated,     ///< each of the terms, and their correlations
  independent,    ///< each of the terms, without correlations
  constant_only,  ///< the first term: the constant
  slopes_only,    ///< all but the first
  none,           ///< observers do not differ: ordinary least squares
};

/// A linear mixed model with one kind of group, the observers:
/// y = X b + Z_i u_i + e,  u_i ~ N(0, covariance),  e ~ N(0, residual²).
struct MixedData {
  Design fixed;                           ///< X; its first column is 1
  std::vector<std::size_t> varying;       ///< the columns of X that are Z; the first is 0, the constant
  std::vector<std::uint32_t> observer;    ///< for each row, from 0
  std::size_t observers = 0;
  Eigen::VectorXd y;
  Eigen::VectorXd combination = {};  ///< of the coefficients, which is sought beside them; empty for none
};

/// An interval of profile likelihood.
struct Interval {
  double low = 0, high = 0;
  bool holds(double value) const { return value >= low && value <= high; }
};

struct MixedFit {
  Criterion criterion = Criterion::restricted;
  Variation variation = Variation::correlated;
  double deviance = 0;  ///< -2 log likelihood, or the restricted criterion
  std::vector<Coefficient> coefficients;  ///< with Satterthwaite's degrees of freedom
  Coefficient combination;                ///< that of the data; without a name
  Eigen::MatrixXd covariance_of_coefficients;
  Eigen::MatrixXd covariance;     ///< of the varying terms between observers; zero rows for those that do not vary
  double residual = 0;            ///< standard deviation within observers
  std::size_t observations = 0, observers = 0, parameters = 0;  ///< parameters: fixed and of variances
  Eigen::MatrixXd observer_terms;  ///< predicted u_i: observers by varying terms
  bool singular = false;           ///< a variance is zero, or a correlation -1 or 1
  std::vector<std::string> simplified;  ///< what was left out and why, in order
  /// The sum of squared residuals about the observers' own predictions, over the residual variance and n: near 1.
  double conditional_share = 0;

  double deviation(std::size_t term) const;               ///< of a varying term between observers
  double correlation(std::size_t a, std::size_t b) const;  ///< NaN if one of them does not vary
  double akaike() const { return deviance + 2 * static_cast<double>(parameters); }
  const Coefficient& at(const std::string& name) const;   ///< the coefficient with that name, which must be there
};

/// Fits one structure of variation.
///
/// Errors (W0802): those of `fit_least_squares`; fewer than two observers unless `variation` is none; no more answers
/// than coefficients.
Result<MixedFit> fit_mixed(const MixedData& data, Criterion criterion, Variation variation = Variation::correlated);

/// The same, and if the fit is singular, the simpler structure whose variances are not, with the reasons in
/// `simplified`: correlations go first, then the terms whose deviation is zero.
Result<MixedFit> fit_mixed_simplified(const MixedData& data, Criterion criterion);

/// The interval of profile likelihood of the standard deviation of a varying term between observers; `confidence` in
/// (0, 1). 0, 0 for a term that does not vary. By the restricted criterion it covers also with few observers.
Interval profile_deviation(const MixedData& data, Variation variation, std::size_t term,
                           Criterion criterion = Criterion::restricted, double confidence = 0.95);
/// The same of the standard deviation within observers.
Interval profile_residual(const MixedData& data, Variation variation, Criterion criterion = Criterion::restricted,
                          double confidence = 0.95);
/// The same of a coefficient, by maximum likelihood.
Interval profile_coefficient(const MixedData& data, Variation variation, std::size_t coefficient,
                             double confidence = 0.95);

/// A comparison of nested models that were fitted by maximum likelihood.
struct Comparison {
  double chi_squared = 0;
  std::size_t freedom = 0;
  double p = 1;
};
Comparison compare_by_likelihood(const MixedFit& simpler, const MixedFit& larger);

}  // namespace wale::analysis
