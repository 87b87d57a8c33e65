#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/analysis/design.hpp"
#include "calibration/analysis/mixed_model.hpp"
#include "calibration/analysis/trials.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// The answers to one stimulus.
struct StimulusMean {
  std::vector<double> sizes;    ///< in the order of `Trials::sizes`
  std::size_t trial = 0;        ///< the first trial with it
  double mean = 0;              ///< of log10 magnitude, over observers' means
  double deviation = 0;         ///< of the observers' means; NaN with one observer
  std::size_t answers = 0, observers = 0;
};

/// One observer's own regression of log10 magnitude on log10 of the size.
struct ObserverLaw {
  std::string observer;
  double exponent = 0, error = 0;  ///< NaN if the answers are about one size; the error also with two answers
  double level = 0;  ///< mean log10 answer: the observer's use of numbers
  std::size_t answers = 0;
};

/// The thesis's way (Minsky 1995, section 5.3): log10 of the ratings, means over runs and observers for each stimulus,
/// least squares of these means on log10 of the size.
struct MeansRegression {
  bool equalised = false;      ///< each observer's mean was moved to the mean of all before
  Regression regression;       ///< `constant`, `log10 SIZE`
  std::vector<StimulusMean> means;
};

/// A model with more terms than the law, compared with it by maximum likelihood.
struct Alternative {
  std::string name;                 ///< "quadratic", "with period"
  std::vector<Coefficient> added;   ///< its coefficients beyond the law's
  Comparison comparison;
  double akaike_gain = 0;           ///< how much lower its AIC is
  std::string refused;              ///< why it could not be fitted; then nothing else is set
};

/// What a free or given modulus study says of one percept and one size.
struct MagnitudeAnalysis {
  std::string size, unit;
  std::vector<ObserverLaw> observers;
  MeansRegression thesis;                   ///< not equalised
  std::optional<MeansRegression> equalised;
  MixedFit model;                           ///< by restricted likelihood: `constant` (of a typical size), `log10 SIZE`
  Coefficient exponent;                     ///< of the law, as the model has it
  Coefficient constant;                     ///< of the law: log10 magnitude at size 1 in `unit`
  double typical_log = 0;                   ///< mean log10 size, about which the model is centred
  double spread = 0;                        ///< of the exponents of single observers; 0 if none was found
  std::optional<Interval> spread_interval;  ///< 95 %, profile likelihood
  double use_of_numbers = 0;                ///< spread of the observers' constants; with a free modulus no feeling
  double noise = 0;                         ///< of single answers about the observer's own law
  std::optional<Interval> noise_interval;
  double scatter = 0;                       ///< of the stimuli's means about the law
  double low = 0, high = 0;                 ///< smallest and largest size
  std::vector<Alternative> alternatives;
  std::optional<Comparison> lack_of_fit;    ///< of the law against any means of the stimuli; nothing with many stimuli
  /// With two sizes: the corners of the convex region of what was presented, in the order of the boundary.
  std::vector<std::array<double, 2>> region;
  std::vector<std::string> notes;           ///< what to know before the law is used, in whole sentences
};

struct MagnitudeOptions {
  std::string size;               ///< the size whose exponent is sought; empty for the first one
  bool intervals_of_spread = true;  ///< profile likelihoods, which take longest
  bool alternatives = true;
};

/// Averages in the thesis's way and fits by least squares. Errors: those of `fit_least_squares`, and W0801 for a size of
/// zero or below.
Result<MeansRegression> regress_means(const Trials& trials, const std::string& size, bool equalise);

/// Analyses magnitude estimates: commanded sizes, answers above zero.
///
/// Errors: W0801 for a size of zero or below; W0802 if the trials do not determine the law.
Result<MagnitudeAnalysis> analyse_magnitudes(const Trials& trials, const MagnitudeOptions& options = {});

}  // namespace wale::analysis
