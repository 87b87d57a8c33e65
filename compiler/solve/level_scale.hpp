#pragma once

#include <optional>
#include <string>

#include "compiler/declarations/discrimination.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/solve/law.hpp"

namespace wale {

/// A percept's levels as one device gives them: the size of the carrier for each, and how plainly people tell two of
/// them apart. Percept, map and declarations outlive it.
class LevelScale {
 public:
  LevelScale(const Percept& percept, const Map& map, const Declarations& declarations, const DeviceDeclaration& device);

  const Percept& percept() const { return percept_; }
  const Map& map() const { return map_; }
  const Discrimination& people() const { return people_; }

  /// The carrier's size, SI, and no more than the device has the force for; 0 for level 0.
  double size_of(double level) const;
  double level_of(double size) const { return law_.level_of(size); }
  /// Above this size the device saturates, SI; infinite where a size exerts no force.
  double most_size() const { return most_size_; }

  /// The size nearest to `size` on the way `towards` another that is so many just noticeable differences `apart` from
  /// it, SI. Nothing where the other is nearer, or nobody knows.
  std::optional<double> step(double size, double towards, double apart) const;

 private:
  const Percept& percept_;
  const Map& map_;
  Law law_;
  Discrimination people_;
  double most_size_;
};

/// Warns of the levels that a file declares where two neighbours would hardly be told apart on the device, or where
/// that is judged by a figure that nobody has looked up. Two names for one level are meant, and levels of which too
/// little is known are not judged.
void check_levels(const Declarations& declarations, SourceId source, const std::string& device,
                  Diagnostics& diagnostics);

}  // namespace wale
