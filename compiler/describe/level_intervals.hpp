#pragma once

#include <optional>

#include "wale/patch_program.hpp"

namespace wale {

/// The ends of an interval of levels.
struct LevelBounds {
  double low = 0, high = 0;

  friend bool operator==(const LevelBounds&, const LevelBounds&) = default;
};

/// Where 95 % of the levels lie that people give to one size of a carrier, if each judges it against the reference
/// stimulus, which is level 1 for everyone.
struct LevelIntervals {
  /// The mean of another group of as many people as the law was measured with.
  LevelBounds means;
  /// How much people's exponents differ is not known, or with how many people the law was measured: the means differ
  /// more than `means` says, the more so the further the level is from 1.
  bool means_differ_more = false;
  /// A judgement of a single person. Nothing if the spread of exponents or the noise of single judgements is not known.
  std::optional<LevelBounds> people;
};

/// The intervals of `level`, which the law gives to a size of `size_over_one` times that of the reference stimulus (0:
/// not known; then the level counts as 1).
///
/// A person's log10 level of that size is b x + e + w: x is log10 of `size_over_one`; b, the person's exponent, has the
/// standard deviation `spread` among people; e is the deviation of that size from the law; w is the noise of the
/// judgement. The law's exponent was fitted to the means of `observers` people, so it has its own error. With n people,
/// the variances that the intervals use are
///
///     means    x^2 (spread^2 / n + slope_error^2)  +  x^2 spread^2 / n  +  scatter^2
///     people   x^2 (spread^2 / n + slope_error^2)  +  x^2 spread^2      +  noise^2
///
/// first the error of the law, then what differs in the new people. A level is the ratio of two magnitudes by one law,
/// so the law's constant, its error and its covariance with the exponent cancel; at level 1 only the last terms are
/// left. The quantiles are those of Student's t, with the degrees of freedom of such a sum (Satterthwaite, Biometrics
/// Bulletin 2, 1946): n - 1 for the spread, `stimuli` - 2 for the rest, those of a normal distribution where `stimuli`
/// is not known.
LevelIntervals level_intervals(const LawUncertainty& law, double level, double size_over_one);

}  // namespace wale
