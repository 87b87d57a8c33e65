#pragma once

#include <Eigen/Core>
#include <functional>

namespace wale::analysis {

using Objective = std::function<double(const Eigen::VectorXd&)>;

struct Minimum {
  Eigen::VectorXd at;
  double value = 0;
  int evaluations = 0;
  bool converged = false;  ///< otherwise the limit of evaluations was reached first
};

/// The lowest point that a simplex (Nelder and Mead 1965) finds from `start`, with first steps of `steps`, restarted
/// until it gains nothing. An objective that is not a number counts as infinitely high. An empty start gives its value.
Minimum minimise(const Objective& objective, const Eigen::VectorXd& start, const Eigen::VectorXd& steps,
                 double tolerance = 1e-10, int most_evaluations = 20000);

/// Newton's method with derivatives by differences, from a point near a minimum: some more digits. Returns `from` if it
/// gains nothing.
Minimum polish(const Objective& objective, const Minimum& from);

/// Second derivatives at a point by central differences with Richardson's extrapolation.
Eigen::MatrixXd hessian(const Objective& objective, const Eigen::VectorXd& at, double step = 1e-3);
/// First derivatives in the same way.
Eigen::VectorXd gradient(const Objective& objective, const Eigen::VectorXd& at, double step = 1e-3);

/// Where a function of one variable has its lowest value within [low, high], if it has one valley there.
double lowest_within(const std::function<double(double)>& function, double low, double high, double tolerance = 1e-9);

/// Where a continuous function changes its sign between two places at which its signs differ; the end with the value
/// nearest to zero if they do not.
double crossing(const std::function<double(double)>& function, double from, double to, double tolerance = 1e-10);

}  // namespace wale::analysis
