#pragma once

namespace wale::analysis {

/// The standard normal distribution: the share below z, and the z below which the share p lies, p in (0, 1).
double normal_below(double z);
double normal_quantile(double p);
/// Student's t with `freedom` > 0 degrees of freedom (any real number): the chance of |t| or more, and the value that
/// the share p lies below, p in (0, 1).
double t_two_sided(double t, double freedom);
double t_quantile(double p, double freedom);
/// The chance of chi-squared or more; 1 for 0 or less. `freedom` > 0.
double chi_squared_above(double chi_squared, double freedom);
/// The value of chi-squared that the share p lies below, p in (0, 1).
double chi_squared_quantile(double p, double freedom);
/// The chance of F or more; 1 for 0 or less.
double f_above(double f, double freedom_above, double freedom_below);
/// The value of F that the share p lies below, p in (0, 1).
double f_quantile(double p, double freedom_above, double freedom_below);

}  // namespace wale::analysis
