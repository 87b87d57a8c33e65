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
  /// If all settings lie on steps, as those of a handle with stops or of a design with few sizes do: their natural
  /// logarithm. What lies between is not seen, so both intervals are wider by the error of what was rounded to a step,
  /// half of it over the root of three, which more settings do not make smaller. Nothing if settings are no steps, or all
  /// alike: then the point of equality is not bounded, since nothing says how far the next setting was.
  std::optional<double> step;
};

/// Errors: W0801 for settings of zero or below; W0802 if there are none.
Result<Settings> analyse_settings(std::vector<ObserverSettings> observers);

/// The root mean square of several scatters, weighted by their degrees of freedom, with its interval. Nothing if none has
/// any.
std::optional<std::pair<double, Interval>> pool_scatters(const std::vector<Settings>& all);

}  // namespace wale::analysis
