#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calibration/analysis/detection.hpp"
#include "calibration/analysis/psychometric.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// d' = (size / threshold) ^ exponent: in proportion to the size with exponent 1, steeper above it. It is 1 at the
/// threshold. Weibull's function of two intervals is nearly such a law (Pelli 1987; Strasburger 2001).
struct SensitivityLaw {
  Decision decision = Decision::interval_choice;  ///< not `same_different_independent`
  double threshold = 1, exponent = 1;
  double lapse = 0;      ///< how far answers stay from 0 and 1 for reasons that are not felt
  double criterion = 0;  ///< of tasks with one: of "yes", or of "different", in units of d'

  double d_prime(double size) const;
  /// The share of right answers of two intervals, else of "yes" or "different"; of size 0 without a signal.
  double at(double size) const;
};

/// The answers of one observer: `right` of a level counts "yes" and "different" in tasks with a criterion.
struct ObserverAnswers {
  std::vector<Level> levels;
  std::size_t false_alarms = 0, noises = 0;
};

struct SensitivityOptions {
  Decision decision = Decision::interval_choice;
  std::optional<double> exponent, lapse;  ///< held at these; otherwise estimated, the lapse within 0 .. `most_lapse`
  double most_lapse = 0.1;
  bool intervals = true;
};

/// What one observer's answers give.
struct ObserverSensitivity {
  SensitivityLaw law;
  Interval interval;              ///< 95 % of the threshold, by profile likelihood
  double log_likelihood = 0;
  std::optional<Error> refused;   ///< why the observer has no threshold of their own
};

/// Observers with one exponent and one lapse rate, and thresholds and criteria of their own.
struct SensitivityFit {
  double exponent = 1, lapse = 0;
  bool exponent_is_held = false;  ///< at 1, since no observer felt two sizes
  double log_likelihood = 0;
  std::vector<ObserverSensitivity> observers;
  /// With two thresholds or more: the geometric mean of the population that they come from, whose logarithms are taken
  /// as normal. Its 95 % interval is the profile's, over exponent, lapse rate and spread: an adaptive track tells them
  /// only together with the threshold, so that an error about the best place would be too small. The ends are as much
  /// less likely as those of Student's interval of a normal sample of as many observers.
  struct Mean {
    double threshold = 0;
    Interval interval;
    std::size_t observers = 0;
  };
  std::optional<Mean> mean;
};

/// Fits the law by maximum likelihood to all observers together. The interval of a single observer's threshold is the
/// profile's over exponent and lapse rate, which all observers' answers tell: with those held, it would be too narrow.
///
/// An observer has no threshold of their own if nothing says that they felt anything (likelihood ratio against d' = 0
/// below 3.84), or if their answers do not bound it. Errors: W0801 for more answers than trials and sizes of zero or
/// below; W0802 if no observer has a threshold.
Result<SensitivityFit> fit_sensitivity(const std::vector<ObserverAnswers>& observers, const SensitivityOptions& options);

/// All observers' answers as those of one, with the interval by the jackknife over observers: wide, since it includes
/// how observers differ. Unbounded where the answers without one of them give no threshold.
Result<ObserverSensitivity> fit_sensitivity_together(const std::vector<ObserverAnswers>& observers,
                                                     const SensitivityOptions& options);

}  // namespace wale::analysis
