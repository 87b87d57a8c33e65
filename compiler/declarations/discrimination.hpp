#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/declarations/declarations.hpp"

namespace wale {

/// How plainly people tell two sizes of one cue apart on one device, and which publication says so.
///
/// Of several publications that one counts which was found on the device itself; then one that compared such sizes
/// before one that did not; then the better known before what is only recalled; and then the one that tells the most
/// apart, so that nothing is called alike too early.
class Discrimination {
 public:
  /// `exerts` is the force of a size of 1, N over the cue's unit: differences of force below the least that is noticed
  /// count as little as they push. 0 for what is no force, as a period.
  Discrimination(const Declarations& declarations, std::string_view cue, std::string device, double exerts);

  /// Whether any publication tells of the cue.
  bool known() const { return !thresholds_.empty(); }
  /// Whether one of them is of a figure that nobody has looked up.
  bool may_be_recalled() const { return std::ranges::any_of(thresholds_, &Threshold::recalled); }

  /// The publication that counts for two sizes, SI; null where there is none. 0 is no size: having none of something is
  /// nothing that a publication could have compared or not.
  const Threshold* threshold(double a, double b) const;

  /// The worst of its grades, `transferred` off its own device.
  Evidence evidence(const Threshold& threshold) const;

  /// The least difference at d' = 1, SI: its own floor, and no less than the least force over `exerts`; 0: not known.
  double floor(const Threshold& threshold) const;

  /// In just noticeable differences at d' = 1: ln(ratio) / ln(1 + w), but the difference over the floor where that is
  /// less, or where one size is 0 or they are of different signs. Nothing where no publication tells.
  std::optional<double> distance(double a, double b) const;

 private:
  std::string device_;
  std::vector<const Threshold*> thresholds_;  ///< the best first, but for the sizes compared
  double least_ = 0;                          ///< of the cue: what exerts the least force that is noticed
};

}  // namespace wale
