#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/analysis/least_squares.hpp"
#include "calibration/analysis/trials.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// Ratings from 0 to 100 of one stimulus.
struct RatedStimulus {
  std::string name;            ///< by its factors, or by its sizes: "amplitude 0.8 N, period 2.5 mm"
  std::size_t trial = 0;       ///< the first trial with it
  double mean = 0, deviation = 0;  ///< over all ratings; the deviation of one rating is NaN
  std::size_t ratings = 0;
};

/// How often the ratings of one observer, or of all, lie in each tenth: 0 to below 10, …, 90 to 100.
using Histogram = std::array<std::size_t, 10>;

/// The two ratings of each stimulus by each observer, in two runs.
struct RunCorrelation {
  double r = 0;
  double low = 0, high = 0;  ///< 95 %, by Fisher's transformation
  std::size_t pairs = 0;
};

/// How an observer uses the scale, after the thesis's words.
enum class UseOfScale {
  clipped,       ///< most ratings lie in the lowest and the highest tenth
  sceptical,     ///< the mean is below 40
  intermediate,
};

struct RatedObserver {
  std::string observer;
  double mean = 0, deviation = 0;
  Histogram histogram{};
  UseOfScale use = UseOfScale::intermediate;
};

/// An analysis of ratings as the thesis's section 4.5 makes it.
struct ConfidenceAnalysis {
  std::vector<RatedStimulus> stimuli;  ///< in order of their means, the lowest first
  std::vector<RatedObserver> observers;
  Histogram histogram{};
  double mean = 0, deviation = 0;      ///< of all ratings
  double at_least_80 = 0, full = 0;    ///< shares of ratings of 80 and more, and of 100
  double above_80 = 0;                 ///< share of stimuli whose mean is above 80
  std::optional<RunCorrelation> between_runs;  ///< nothing with fewer than two runs, or if all ratings are the same
  /// Of ratings on the sizes of the stimuli: means of the observers' own coefficients, t on one degree of freedom less;
  /// of the stimuli's means where not each has their own, as a note then says.
  std::optional<Regression> regression;
  std::string regression_refused;              ///< why there is none, if sizes were given
  std::vector<std::string> notes;
};

/// Analyses ratings. The regression has the sizes of the trials (hill, valley, feature size, largest gradient) as they
/// are, with a constant. Errors: W0801 for ratings outside 0 to 100.
Result<ConfidenceAnalysis> analyse_confidence(const Trials& trials);

/// The largest gradient of a height profile over one period: the largest difference of neighbouring samples, `step`
/// apart; the first sample follows the last.
double largest_gradient(const std::vector<double>& heights, double step);

/// Product-moment correlation of two lists of equal length; nothing for fewer than two values or if one list is constant.
std::optional<double> correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace wale::analysis
