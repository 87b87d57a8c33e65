#include "compiler/describe/level_intervals.hpp"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "compiler/declarations/in_double.hpp"

namespace wale {
namespace {

using Normal = boost::math::normal_distribution<double, InDouble>;
using Student = boost::math::students_t_distribution<double, InDouble>;

constexpr double outside = 0.025;  // share of the levels on either side of a 95 % interval

/// A variance, estimated with so many degrees of freedom; infinity if it counts as exactly known.
struct Variance {
  double size = 0, freedom = HUGE_VAL;
};

/// Half the width of the interval of a sum of two independent errors, in their unit.
double half_width(const Variance& a, const Variance& b) {
  const double whole = a.size + b.size;
  if (!(whole > 0)) return 0;
  const double inverse = (a.size * a.size / a.freedom + b.size * b.size / b.freedom) / (whole * whole);
  constexpr double hardly_any = 1e-6;  // of 1 / freedom: the two distributions are the same to five digits
  const double quantile = inverse < hardly_any
                              ? boost::math::quantile(boost::math::complement(Normal(), outside))
                              : boost::math::quantile(boost::math::complement(Student(1 / inverse), outside));
  return quantile * std::sqrt(whole);
}

LevelBounds around(double level, double half) { return {level * std::pow(10, -half), level * std::pow(10, half)}; }

}  // namespace

LevelIntervals level_intervals(const LawUncertainty& law, double level, double size_over_one) {
  const auto square = [](double x) { return x * x; };
  const double x = size_over_one > 0 ? std::log10(size_over_one) : 0;
  const double fitted = law.stimuli > 2 ? law.stimuli - 2.0 : HUGE_VAL;
  const bool knows_people = law.spread > 0 && law.observers > 1;
  const double of_one = knows_people ? square(x * law.spread) : 0;  // the variance by one person's exponent
  const double of_group = knows_people ? of_one / law.observers : 0;
  const double among = knows_people ? law.observers - 1.0 : HUGE_VAL;
  const double error = square(x * law.slope_error);
  LevelIntervals found;
  found.means = around(level, half_width({2 * of_group, among}, {error + square(law.scatter), fitted}));
  found.means_differ_more = !knows_people;
  if (knows_people && law.noise > 0)
    found.people = around(level, half_width({of_one + of_group, among}, {error + square(law.noise), fitted}));
  return found;
}

}  // namespace wale
