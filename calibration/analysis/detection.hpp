#pragma once

#include <cstddef>
#include <string>

#include "calibration/analysis/psychometric.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// How answers arise from what is felt: d' depends on it.
enum class Decision {
  interval_choice,      ///< which of m intervals has it: the largest is chosen
  yes_no,               ///< one interval, "is it there", or "which of two is it": a criterion
  same_different_difference,   ///< two intervals differ if their difference exceeds a criterion
  same_different_independent,  ///< each interval is classified by the best criterion; unbiased
};

/// Counts of answers of one kind to two kinds of trials: "yes" to signal and noise, "different" to different and same
/// pairs, or, with `Decision::interval_choice`, right answers in `hits` and nothing in the others.
struct Answered {
  std::size_t hits = 0, signals = 0, false_alarms = 0, noises = 0;
};

struct Sensitivity {
  double d_prime = 0;
  double error = 0;       ///< standard error by the delta method
  double criterion = 0;   ///< c of yes-no tasks: positive is cautious; 0 otherwise
  std::string corrected;  ///< says that rates of 0 or 1 were moved by half an answer (Hautus 1995); empty otherwise
  double low() const { return d_prime - 1.959963984540054 * error; }
  double high() const { return d_prime + 1.959963984540054 * error; }
};

/// d' of a share of right answers in m-interval forced choice, p from 1/m to below 1.
double d_prime_of_choice(double p, int intervals);
/// The share of right answers for d' in m intervals: the chance that the largest of m is the one with the signal.
double choice_of_d_prime(double d_prime, int intervals);
/// The chance of "different" for a pair that differs by d', and for d' = 0, with criterion k on the difference.
double different_by_difference(double d_prime, double criterion);

/// d' of counts. `intervals` counts for `interval_choice` only.
///
/// Errors: W0801 for more hits than signals and the like; W0802 for no trials of a kind that is needed.
Result<Sensitivity> sensitivity_of(Decision decision, const Answered& answered, int intervals = 2);

/// A Weber fraction: the noticeable difference at d' = 1, over the size that it was measured at.
struct WeberFraction {
  double standard = 0, fraction = 0;
  Interval interval;
};

/// Weber fractions at several standards, weighted into one where they agree.
struct WeberRange {
  double fraction = 0, error = 0;  ///< weighted mean of the logarithms, back; error of its logarithm
  double low = 0, high = 0;        ///< the smallest and the largest standard that agree
  double chi_squared = 0, p = 1;   ///< of their equality
  std::string note;                ///< says which standards were left out, because a fraction rises near the threshold
};
/// Pools fractions, the standards rising. While they differ beyond chance (p < 0.05), the smallest standard is left out.
/// Error W0802: none, or an interval without bounds.
Result<WeberRange> pool_fractions(std::vector<WeberFraction> fractions);

}  // namespace wale::analysis
