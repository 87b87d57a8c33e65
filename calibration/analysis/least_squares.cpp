#include "calibration/analysis/least_squares.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

namespace {

/// How far an interval reaches from a coefficient. As many columns as observations leave no residuals: nothing is known.
double reach(const Coefficient& coefficient, double confidence) {
  if (!(coefficient.freedom > 0) || !std::isfinite(coefficient.error)) return std::numeric_limits<double>::infinity();
  return t_quantile(0.5 + confidence / 2, coefficient.freedom) * coefficient.error;
}

}  // namespace

double Coefficient::p() const { return freedom > 0 && !std::isnan(t()) ? t_two_sided(t(), freedom) : 1; }
double Coefficient::low(double confidence) const { return value - reach(*this, confidence); }
double Coefficient::high(double confidence) const { return value + reach(*this, confidence); }

double Regression::deviation() const { return std::sqrt(residual_squares / freedom); }
double Regression::explained_share() const { return explained_squares / (explained_squares + residual_squares); }
double Regression::adjusted_share() const {
  return 1 - (residual_squares / freedom) /
                 ((explained_squares + residual_squares) / static_cast<double>(observations - 1));
}
double Regression::f() const {
  return explained_squares / static_cast<double>(coefficients.size() - 1) / (residual_squares / freedom);
}
double Regression::p() const { return f_above(f(), static_cast<double>(coefficients.size() - 1), freedom); }
const Coefficient& Regression::at(const std::string& name) const {
  return *std::ranges::find(coefficients, name, &Coefficient::name);
}

std::string dependent_column(const Design& design) {
  // Each column against those before it, all scaled to length 1.
  MatrixXd basis(design.columns.rows(), 0);
  for (Eigen::Index i = 0; i < design.columns.cols(); ++i) {
    VectorXd column = design.columns.col(i);
    const double length = column.norm();
    if (!(length > 0)) return design.names[static_cast<std::size_t>(i)];
    column /= length;
    for (int again = 0; again < 2; ++again) column -= basis * (basis.transpose() * column);
    if (column.norm() < 1e-9) return design.names[static_cast<std::size_t>(i)];
    basis.conservativeResize(Eigen::NoChange, i + 1);
    basis.col(i) = column.normalized();
  }
  return {};
}

Result<Regression> fit_least_squares(const Design& design, const VectorXd& y) {
  const Eigen::Index n = y.size(), p = design.columns.cols();
  if (!design.columns.allFinite() || !y.allFinite())
    return refusal("a value to fit is no number", "look for zeros whose logarithm was taken");
  if (p == 0 || (design.columns.col(0).array() != 1).any())
    return refusal("the fit has no constant",
                   "through the origin, a fit of logarithms depends on the units: add the constant");
  if (n < p)
    return refusal("there are " + std::to_string(n) + " values for " + std::to_string(p) + " coefficients",
                   "leave terms out");
  if (const std::string name = dependent_column(design); !name.empty())
    return refusal("`" + name + "` depends on the terms before it, so its coefficient cannot be told from theirs",
                   "leave it out, or vary it independently");
  const Eigen::HouseholderQR<MatrixXd> factors(design.columns);
  const VectorXd found = factors.solve(y);
  const VectorXd residuals = y - design.columns * found;
  Regression result;
  result.observations = static_cast<std::size_t>(n);
  result.freedom = static_cast<double>(n - p);
  result.residual_squares = residuals.squaredNorm();
  result.explained_squares = (y.array() - y.mean()).matrix().squaredNorm() - result.residual_squares;
  result.residuals.assign(residuals.data(), residuals.data() + n);
  const MatrixXd upper = factors.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  const MatrixXd inverse = upper.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(p, p));
  const double variance = n > p ? result.residual_squares / result.freedom : std::nan("");
  for (Eigen::Index i = 0; i < p; ++i)
    result.coefficients.push_back({design.names[static_cast<std::size_t>(i)], found(i),
                                   std::sqrt(variance) * inverse.row(i).norm(), result.freedom});
  return result;
}

}  // namespace wale::analysis
