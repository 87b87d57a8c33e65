#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/declarations/declarations.hpp"

namespace wale {

/// How easily people tell two sizes of one cue apart on one device, and the publication that says so.
///
/// Of several publications, one that people were measured for takes precedence over a simulated one; then one measured on
/// the device itself; then one that compared such sizes; then one with a better grade than recalled; then the one with
/// the smallest threshold, so that nothing is called equal too early.
class Discrimination {
 public:
  /// `exerts` is the force of a size of 1, in N over the cue's unit: small differences count by their force, relative
  /// to the smallest noticeable force. It is 0 for a cue that is not a force, such as a period.
  Discrimination(const Declarations& declarations, std::string_view cue, std::string device, double exerts);

  /// Whether there is a threshold for the cue.
  bool known() const { return !thresholds_.empty(); }
  /// Whether one of them rests on a figure that nobody has looked up.
  bool may_be_recalled() const { return std::ranges::any_of(thresholds_, &Threshold::recalled); }

  /// The publication that applies to two sizes, SI; null if there is none. A size of 0 is ignored when the sizes are
  /// compared with the range of a publication.
  const Threshold* threshold(double a, double b) const;

  /// The worst of its grades; `transferred` or worse on another device than its own.
  Evidence evidence(const Threshold& threshold) const;

  /// The smallest noticeable difference at d' = 1, SI: the larger of the threshold's floor and the cue's `least_`; 0 if
  /// unknown.
  double floor(const Threshold& threshold) const;

  /// The publication whose floor decides how far two sizes are apart, and not the fraction of `threshold(a, b)`; null if
  /// the fraction does.
  const Threshold* floor_between(double a, double b) const;

  /// The distance in just noticeable differences at d' = 1: ln(ratio) / ln(1 + w), or the difference divided by the
  /// floor if that is less, or if one size is 0 or their signs differ. Empty if there is no threshold.
  std::optional<double> distance(double a, double b) const;

  /// A range of sizes outside of which every size is more than `most` just noticeable differences from `size`, whichever
  /// publication applies. It may be wider than it need be: it is for leaving out what is far away without computing each
  /// distance. Unlimited on a side where that is not known.
  SizeRange within(double size, double most) const;

 private:
  std::string device_;
  std::vector<const Threshold*> thresholds_;  ///< the best first, apart from the range of sizes
  double least_ = 0;                          ///< size of the cue that exerts the smallest noticeable force
  const Threshold* of_least_ = nullptr;       ///< the publication of that force
};

/// How many sizes of a cue people recognise when each is felt alone, by the best publication: one measured on the
/// device itself, else the one with the best grade, else the one with the fewest sizes. Null if there is none.
const Threshold* recognition(const Declarations& declarations, std::string_view cue, const std::string& device);

}  // namespace wale
