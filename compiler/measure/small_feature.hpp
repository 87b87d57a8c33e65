#pragma once

#include <optional>

#include "wale/program.hpp"

namespace wale {

/// How much of the patch, less its rim, a height slopes on, and how a force in proportion to its slope is scaled there
/// (a `peak`, as in `lateral`): by the 99th percentile of the slope, above which it is held.
struct SlopedShare {
  double covered = 0;  ///< share of the places with a slope above a twentieth of the percentile; of 0: with any
  double held = 0;     ///< share of those places on which the slope is at or above the percentile
  double steeper = 0;  ///< the greatest slope over the percentile; infinite if that is 0, and 0 without any slope

  /// Whether most of the shape of a small feature is cut off. A feature that has one slope all over, as a cone, loses
  /// nothing, and one that covers more of the patch, as each texture does, little.
  bool is_mostly_held() const;
};

/// Of the heights of a program the one that is mostly held, or else the one whose greatest slope is furthest above its
/// percentile; nothing if no force is scaled by a slope. Evaluates each height once; deterministic.
std::optional<SlopedShare> sloped_share(const Bank& bank);

/// The largest patch below the bank's, of sides in the same ratio and in whole millimetres, on which each height of the
/// program slopes on 5 % or more; nothing if there is none, as for a feature away from the middle. Takes some ten times
/// as long as `sloped_share`.
std::optional<PatchSize> patch_for_feature(const Bank& bank);

}  // namespace wale
