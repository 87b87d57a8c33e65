#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "wale/result.hpp"

namespace wale::analysis {

/// A coefficient of a fit.
struct Coefficient {
  std::string name;       ///< "constant", "log10 amplitude"
  double value = 0;
  double error = 0;       ///< standard error
  double freedom = 0;     ///< degrees of freedom of its t; may be a fraction
  double t() const { return value / error; }
  double p() const;       ///< two-sided
  /// The ends of its interval at this confidence, in (0, 1); infinite without degrees of freedom.
  double low(double confidence = 0.95) const;
  double high(double confidence = 0.95) const;
};

/// A linear regression by least squares.
struct Regression {
  std::vector<Coefficient> coefficients;  ///< in the order of the columns
  std::size_t observations = 0;
  double explained_squares = 0, residual_squares = 0;  ///< about the mean
  double freedom = 0;                                  ///< of the residuals
  double deviation() const;                            ///< s, the standard deviation of the residuals
  double explained_share() const;                      ///< R²
  double adjusted_share() const;
  double f() const;
  double p() const;  ///< of that F
  std::vector<double> residuals;

  const Coefficient& at(const std::string& name) const;  ///< the coefficient with that name, which must be there
};

/// A design: named columns over the same observations. The first column is `constant`.
struct Design {
  std::vector<std::string> names;
  Eigen::MatrixXd columns;  ///< observations by names
};

/// Fits y, one value for each row of the design. A fit of logarithms through the origin depends on the units, so the
/// first column must be 1 everywhere.
///
/// Errors (W0802): a first column that is not 1, fewer observations than columns, columns that depend on each other
/// (which names them), values that are no numbers.
Result<Regression> fit_least_squares(const Design& design, const Eigen::VectorXd& y);

/// The name of a column that depends on those before it, or an empty text.
std::string dependent_column(const Design& design);

}  // namespace wale::analysis
