#pragma once

#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "schema/declared_device.hpp"

namespace wale {

/// The devices that a file may name: first its own and those that it imports, then those that every file knows, each by
/// name.
std::vector<DeclaredDevice> declared_devices(const Declarations& declarations);

}  // namespace wale
