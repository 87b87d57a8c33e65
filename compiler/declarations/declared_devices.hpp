#pragma once

#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "wale/declared_device.hpp"

namespace wale {

/// The devices that a file may name: first its own and imported ones, then those that every file knows; each group
/// sorted by name.
std::vector<DeclaredDevice> declared_devices(const Declarations& declarations);

}  // namespace wale
