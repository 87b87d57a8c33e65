#pragma once

#include <optional>
#include <string>

#include "compiler/declarations/discrimination.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/solve/law.hpp"

namespace wale {

/// A percept's levels on one device: the carrier's size for each, and how easily people tell two of them apart.
/// Percept, map and declarations must outlive it.
class LevelScale {
 public:
  LevelScale(const Percept& percept, const Map& map, const Declarations& declarations, const DeviceDeclaration& device);

  const Percept& percept() const { return percept_; }
  const Map& map() const { return map_; }
  const Discrimination& people() const { return people_; }

  /// The carrier's size for a level, SI, limited by the device's force; 0 for level 0.
  double size_of(double level) const;
  double level_of(double size) const { return law_.level_of(size); }
  /// The size above which the device saturates, SI; infinite if the carrier exerts no force.
  double most_size() const { return most_size_; }

  /// The first size on the way from `size` `towards` another one that is `apart` just noticeable differences from
  /// `size`, SI. Empty if the other one is nearer than that, or if there is no threshold.
  std::optional<double> step(double size, double towards, double apart) const;

 private:
  const Percept& percept_;
  const Map& map_;
  Law law_;
  Discrimination people_;
  double most_size_;
};

/// Checks the levels that a file declares. Warns of neighbours that are hard to tell apart on the device, and of
/// judgements that rest on a recalled figure. Two names for one level are allowed, and levels without a map or
/// threshold are not judged.
void check_levels(const Declarations& declarations, SourceId source, const std::string& device,
                  Diagnostics& diagnostics);

}  // namespace wale
