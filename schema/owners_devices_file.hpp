#pragma once

#include <string>

namespace wale {

/// The file in which the owner of this account declares devices, by the values of XDG_CONFIG_HOME and HOME, which may
/// be null: $XDG_CONFIG_HOME/wale/devices.wale, by default ~/.config/wale/devices.wale. Nobody else writes there, so
/// these declarations may scale a real device. Empty where neither variable names a folder by its whole path.
std::string owners_devices_file(const char* config_home, const char* home);

}  // namespace wale
