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

/// The map that ties a percept to its carrier on a device. `by` chooses it by name, and else the device's rule for the
/// percept may; without a name it is the only one measured on the device, else on one of its class, else on the device
/// of the reference stimulus, else anywhere.
MapChoice choose_map(const Percept& percept, const DeviceDeclaration& device, const Declarations& declarations,
                     const std::string& by = {});

}  // namespace wale
