#pragma once

#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"

namespace wale {

/// The map that sets a percept's levels, or the reason why there is none.
struct MapChoice {
  const Map* map = nullptr;
  std::vector<const Map*> rivals;  ///< two or more maps fit equally well
  std::vector<const Map*> untied;  ///< maps that fit but are not tied to the reference stimulus
};

/// The percept as a device carries it. If the device only vibrates and has a rule for the percept, the carrier is the
/// acceleration of its shaking; otherwise the percept is returned as declared.
Percept carried_on(const DeviceDeclaration& device, const Percept& percept, const Declarations& declarations);

/// Whether a map is for the device itself: it was measured on the device or is declared for its class.
inline bool is_of(const Map& map, const DeviceDeclaration& device) {
  return map.device == device.profile.name || (!device.of_class.empty() && map.device == device.of_class);
}

/// The map from a percept, as `carried_on` the device, to its carrier there. `by` is the name of the map; if it is
/// empty, the device's rule for the percept may name one. Without a name it is the only map measured on the device,
/// else on one of its class, else on the device of the reference stimulus, else anywhere.
MapChoice choose_map(const Percept& percept, const DeviceDeclaration& device, const Declarations& declarations,
                     const std::string& by = {});

}  // namespace wale
