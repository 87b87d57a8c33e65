#pragma once

#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"

namespace wale {

/// Which map sets a percept's levels, or why none does.
struct MapChoice {
  const Map* map = nullptr;
  std::vector<const Map*> rivals;  ///< two or more would do, and nothing says which
  std::vector<const Map*> untied;  ///< there are maps, but none that is tied to the reference stimulus
};

/// The percept as a device carries it: on one that only vibrates, where it has a rule for the percept, the carrier is
/// how it shakes; else as it is declared.
Percept carried_on(const DeviceDeclaration& device, const Percept& percept, const Declarations& declarations);

/// Whether a map speaks of the device itself: it was measured on it, or is one of its whole class.
inline bool is_of(const Map& map, const DeviceDeclaration& device) {
  return map.device == device.profile.name || (!device.of_class.empty() && map.device == device.of_class);
}

/// The map that ties a percept, as `carried_on` the device, to its carrier there. `by` chooses it by name, and else the
/// device's rule for the percept may; without a name it is the only one measured on the device, else on one of its
/// class, else on the device of the reference stimulus, else anywhere.
MapChoice choose_map(const Percept& percept, const DeviceDeclaration& device, const Declarations& declarations,
                     const std::string& by = {});

}  // namespace wale
