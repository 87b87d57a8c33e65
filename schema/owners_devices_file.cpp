#include "schema/owners_devices_file.hpp"

namespace wale {

std::string owners_devices_file(const char* config_home, const char* home) {
  // The XDG Base Directory Specification: a path that is not absolute is ignored.
  const auto is_whole = [](const char* path) { return path != nullptr && path[0] == '/'; };
  if (is_whole(config_home)) return std::string(config_home) + "/wale/devices.wale";
  if (is_whole(home)) return std::string(home) + "/.config/wale/devices.wale";
  return {};
}

}  // namespace wale
