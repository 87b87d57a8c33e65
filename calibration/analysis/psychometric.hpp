#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibration/analysis/mixed_model.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// The shape of a psychometric function between its asymptotes.
enum class Sigmoid {
  normal,    ///< cumulative normal distribution over the size
  logistic,
  weibull,   ///< over the size's logarithm; sizes above zero
};

/// The answers to one size: how many of `trials` were right (or "more", "different").
struct Level {
  double size = 0;
  std::size_t right = 0, trials = 0;
};

/// p(size) = guess + (1 - guess - lapse) F(size). F is 0.5 at `threshold` and goes from 0.05 to 0.95 within `width`, of
/// the size, or of its natural logarithm for `Sigmoid::weibull`.
struct PsychometricFunction {
  Sigmoid shape = Sigmoid::normal;
  double threshold = 0, width = 1, guess = 0.5, lapse = 0;

  double at(double size) const;
  /// The size at which the share p of answers is right, within the asymptotes; infinite beyond them.
  double size_at(double p) const;
};

struct PsychometricOptions {
  Sigmoid shape = Sigmoid::normal;
  double guess = 0.5;                ///< of two alternatives
  bool guess_is_free = false;        ///< yes-no tasks
  std::optional<double> lapse;       ///< held at this; otherwise fitted within 0 .. `most_lapse`
  double most_lapse = 0.1;
  bool prior = false;                ///< psignifit 4's prior of the lapse rate, Beta(1, 10): the posterior's mode
  bool intervals = true;             ///< profile likelihoods, which take longest
};

struct PsychometricFit {
  PsychometricFunction function;
  double log_likelihood = 0;           ///< of the counts, without the binomial coefficients
  double deviance = 0;                 ///< from the saturated model
  std::size_t levels = 0, trials = 0, parameters = 0;
  /// The chance of such a deviance or more if answers are independent, by parametric bootstrap; 1 before it is known.
  double p_of_deviance = 1;
  Interval threshold, width;           ///< 95 %, by profile likelihood
  std::vector<std::string> notes;      ///< what to know, such as a threshold outside the sizes
};

/// Fits one function by maximum likelihood.
///
/// Errors (W0802): fewer than two sizes, no trials, all answers right or all wrong, answers that do not depend on the
/// size. W0801: more right answers than trials, sizes at or below zero for `Sigmoid::weibull`, rates outside their ranges.
Result<PsychometricFit> fit_psychometric(const std::vector<Level>& levels, const PsychometricOptions& options);

/// Fits one function for each condition with one lapse rate for all. Errors: as above.
Result<std::vector<PsychometricFit>> fit_with_shared_lapse(const std::vector<std::vector<Level>>& conditions,
                                                           PsychometricOptions options);

/// Parametric bootstrap: the 95 % interval of the size at which a share `p` of answers is right, and the chance of the
/// deviance, from `samples` fits to answers that the fitted function gives; the same for the same seed.
struct Bootstrap {
  Interval size;
  double p_of_deviance = 1;
  std::size_t samples = 0;  ///< that could be fitted
};
Bootstrap bootstrap(const std::vector<Level>& levels, const PsychometricFit& fit, const PsychometricOptions& options,
                    double p, std::size_t samples, std::uint64_t seed);

}  // namespace wale::analysis
