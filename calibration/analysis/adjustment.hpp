#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/analysis/psychometric.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// What one observer set a stimulus to, until it was like the standard.
struct ObserverSettings {
  std::string observer;
  std::vector<double> settings;  ///< above 0
  double equal = 0;              ///< their geometric mean
};

/// The settings about one standard.
struct Settings {
  std::vector<ObserverSettings> observers;
  /// The point of subjective equality: the geometric mean of the observers' own, so that nobody counts more who set more
  /// often. 95 %, by Student's t on one degree of freedom less than there are observers; of a single observer on one less
  /// than there are settings; unbounded for a single setting.
  double equal = 0;
  Interval equal_interval;
  /// How settings of one observer scatter: the standard deviation of their natural logarithms, pooled over observers, with
  /// the 95 % interval by chi-squared. It is the fraction of the standard by which a setting is told from equality in 84 %
  /// of cases, if settings are normal (Gescheider 1997). Nothing if nobody set it twice.
  std::optional<double> scatter;
  Interval scatter_interval;
  double freedom = 0;  ///< of the scatter
};

/// Errors: W0801 for settings of zero or below; W0802 if there are none.
Result<Settings> analyse_settings(std::vector<ObserverSettings> observers);

/// The root mean square of several scatters, weighted by their degrees of freedom, with its interval. Nothing if none has
/// any.
std::optional<std::pair<double, Interval>> pool_scatters(const std::vector<Settings>& all);

}  // namespace wale::analysis
