#pragma once

#include <fmt/format.h>

#include <string>

namespace wale {

/// Why a percept is rendered less than it was asked for: the device's limit cuts it alone, or what it shares with
/// others.
inline std::string saturation_reason(const std::string& device, bool together) {
  return fmt::format("`{}` gives no more{}", device, together ? " to all together" : "");
}

/// What a fate's reason says besides that: how it is realised.
inline std::string without_saturation(const std::string& reason, const std::string& device) {
  for (const bool together : {true, false}) {
    const std::string why = saturation_reason(device, together);
    if (reason == why) return {};
    if (reason.starts_with(why + "; ")) return reason.substr(why.size() + 2);
  }
  return reason;
}

}  // namespace wale
