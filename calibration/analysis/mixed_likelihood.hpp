#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/analysis/mixed_model.hpp"

namespace wale::analysis {

/// The sums of products of each observer's rows of [X y]: all that the likelihood needs, whatever the number of trials.
class MixedLikelihood {
 public:
  explicit MixedLikelihood(const MixedData& data);

  /// The parts of the likelihood for a factor L of the observers' covariance relative to the residual variance, L L'.
  struct Parts {
    double log_determinant = 0;  ///< of the covariance of y over the residual variance
    Eigen::MatrixXd products;    ///< [X y]' V^-1 [X y]
    Eigen::VectorXd coefficients;
    double squares = 0;                       ///< the least sum of weighted squares
    double log_determinant_of_products = 0;   ///< of X' V^-1 X
  };
  Parts parts(const Eigen::MatrixXd& relative_factor) const;

  /// -2 log likelihood (or the restricted criterion) with the best residual variance.
  double profiled(const Eigen::MatrixXd& relative_factor, Criterion criterion) const;
  /// The same for a given residual standard deviation.
  double at(const Eigen::MatrixXd& relative_factor, double residual, Criterion criterion) const;
  /// Minus twice the log likelihood if one coefficient is held at a value.
  double with_coefficient(const Eigen::MatrixXd& relative_factor, std::size_t coefficient, double value) const;

  double residual(const Parts& parts, Criterion criterion) const;
  /// The predicted terms of one observer.
  Eigen::VectorXd observer_terms(std::size_t observer, const Eigen::MatrixXd& relative_factor,
                                 const Eigen::VectorXd& coefficients) const;
  /// The sum of squares of one observer's rows about coefficients and own terms.
  double squares_about(std::size_t observer, const Eigen::VectorXd& coefficients, const Eigen::VectorXd& terms) const;

  double trials() const { return trials_; }
  std::size_t observers() const { return products_.size(); }
  Eigen::Index fixed() const { return fixed_; }
  Eigen::Index varying() const { return static_cast<Eigen::Index>(varying_.size()); }
  /// The effective size of a varying column: the root of its mean square.
  double scale(Eigen::Index term) const { return scales_(term); }
  /// What was subtracted from y before its products were summed; it belongs to the constant.
  double shift() const { return shift_; }

 private:
  /// Observers with the same sums of products of the varying terms, as in a balanced design. The likelihood weights their
  /// rows alike, so that sums over them are enough.
  struct Alike {
    Eigen::MatrixXd inner;                 ///< of the varying terms
    double count = 0;
    std::vector<Eigen::MatrixXd> crosses;  ///< of each, varying terms by columns, if they are few
    std::vector<Eigen::MatrixXd> moments;  ///< otherwise, for terms a and b: sums of the products of their rows of these
  };
  void group_alike();

  std::vector<Eigen::MatrixXd> products_;
  Eigen::MatrixXd total_;  // of all observers
  std::vector<Alike> alike_;
  std::vector<Eigen::Index> varying_;
  Eigen::VectorXd scales_;
  Eigen::Index fixed_ = 0;
  double trials_ = 0, shift_ = 0;
};

}  // namespace wale::analysis
