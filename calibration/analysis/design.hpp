#pragma once

#include <string>
#include <vector>

#include "calibration/analysis/least_squares.hpp"
#include "calibration/analysis/trials.hpp"
#include "wale/result.hpp"

namespace wale::analysis {

/// A term of a model of log10 answers. Sizes enter by their log10 about its mean over the trials, so that no term
/// depends on the units, and `constant` is the answer to a typical stimulus.
struct Term {
  enum class Kind {
    constant,
    size,         ///< of `size`
    squared,      ///< its square
    bent,         ///< what it exceeds `knot` by
    product,      ///< of `size` and `other`
    factor,       ///< a column for each level of `factor` but the first
    size_by_factor,  ///< of `size`, a column for each level but the first
    size_before,  ///< of the trial before, by the same observer in the same run; 0 for the first one
    stimulus,     ///< a column for each stimulus but the first: whatever the law is
  };
  Kind kind = Kind::constant;
  std::string size = {}, other = {}, factor = {};
  double knot = 0;  ///< in the size's unit
};

/// The columns of a model, one row for each trial.
///
/// Errors (W0802): terms without a constant, a square, a product or a bend without the sizes that it is made of: such a
/// fit depends on the units. W0801: a size that is not above zero in some row; an unknown size or factor.
Result<Design> design_of(const Trials& trials, const std::vector<Term>& terms);

/// The mean over the trials of log10 of a size that is above zero in all of them.
double mean_log(const SizeValues& size);

}  // namespace wale::analysis
