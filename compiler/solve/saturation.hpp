#pragma once

#include <fmt/format.h>

#include <string>

namespace wale {

/// Why a percept is rendered at a lower level than asked: the device limits it alone, or `together` with others.
inline std::string saturation_reason(const std::string& device, bool together) {
  return fmt::format("`{}` gives no more{}", device, together ? " to all together" : "");
}

/// How a percept is realised: by the device's own rule for it, by a map that was measured on another device, or by
/// both. An empty name means that there is none; both are empty for a percept that is realised as declared.
inline std::string realisation_reason(const std::string& realisation, const std::string& map,
                                      const std::string& map_device) {
  std::string how = realisation.empty() ? "" : fmt::format("rendered as {}", realisation);
  if (!map.empty()) how += fmt::format("{}by {}, on {}", how.empty() ? "" : "; ", map, map_device);
  return how;
}

}  // namespace wale
