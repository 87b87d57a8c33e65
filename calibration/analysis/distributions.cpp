#include "calibration/analysis/distributions.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/policies/policy.hpp>
#include <cmath>

namespace wale::analysis {
namespace {

// In double: by default Boost computes in long double, which differs between machines.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_float<false>,
                                               boost::math::policies::promote_double<false>,
                                               // With next to no degrees of freedom a quantile is infinite.
                                               boost::math::policies::overflow_error<boost::math::policies::ignore_error>>;
using Normal = boost::math::normal_distribution<double, InDouble>;
using StudentsT = boost::math::students_t_distribution<double, InDouble>;
using ChiSquared = boost::math::chi_squared_distribution<double, InDouble>;
using FisherF = boost::math::fisher_f_distribution<double, InDouble>;

}  // namespace

double normal_below(double z) { return boost::math::cdf(Normal(), z); }
double normal_quantile(double p) { return boost::math::quantile(Normal(), p); }

double t_two_sided(double t, double freedom) {
  if (!std::isfinite(t)) return 0;
  return 2 * boost::math::cdf(boost::math::complement(StudentsT(freedom), std::abs(t)));
}
double t_quantile(double p, double freedom) { return boost::math::quantile(StudentsT(freedom), p); }

double chi_squared_above(double chi_squared, double freedom) {
  if (!(chi_squared > 0)) return 1;
  return boost::math::cdf(boost::math::complement(ChiSquared(freedom), chi_squared));
}
double chi_squared_quantile(double p, double freedom) { return boost::math::quantile(ChiSquared(freedom), p); }

double f_above(double f, double freedom_above, double freedom_below) {
  if (!(f > 0)) return 1;
  if (!std::isfinite(f)) return 0;
  return boost::math::cdf(boost::math::complement(FisherF(freedom_above, freedom_below), f));
}
double f_quantile(double p, double freedom_above, double freedom_below) {
  return boost::math::quantile(FisherF(freedom_above, freedom_below), p);
}

}  // namespace wale::analysis
