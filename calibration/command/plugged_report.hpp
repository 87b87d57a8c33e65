#pragma once

#include <string>
#include <vector>

#include "library/device_kinds.hpp"
#include "wale/library.hpp"

namespace wale {

/// The last part of what `wale devices` prints: each device, what it is taken for, what it can do, and what is in the
/// way.
std::string plugged_text(const Connections& connections, const std::vector<PluggedIn>& plugged,
                         const std::vector<DeclaredDevice>& known);
/// The array of `devices_json` with one element more for each device that is plugged in.
std::string with_plugged(const std::string& devices_json, const std::vector<PluggedIn>& plugged,
                         const std::vector<DeclaredDevice>& known);

}  // namespace wale
