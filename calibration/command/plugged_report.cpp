#include "library/plugged_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "library/open_device.hpp"

namespace wale {
namespace {

constexpr const char* nothing =
    "  nothing that could be felt on\n"
    "               a stick that is connected and does not stand here may lack its own power, or have a cable that\n"
    "               only charges; `lsusb` lists whatever the computer sees\n";

/// Lines behind the first one begin below it.
std::string indented(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
    text.insert(at + 1, "               ");
  return text;
}

bool is_felt_on(const PluggedIn& plugged, const MatchedProfile& match) {
  return plugged.obstacle.empty() && !plugged.can.empty() && match.device != nullptr;
}

}  // namespace

std::string plugged_text(const Connections& connections, const std::vector<PluggedIn>& plugged,
                         const std::vector<DeclaredDevice>& known) {
  std::string text = "\nplugged in (wale feel --device PORT)\n";
  if (!connections.usb) text += fmt::format("  USB cannot be looked at: {}\n", connections.without_usb);
  if (plugged.empty()) return connections.usb ? text + nothing : text;
  for (const PluggedIn& device : plugged) {
    const MatchedProfile match = matched_profile(device, known);
    text += fmt::format("  {:<12} {}{}\n", device.port, device.name.empty() ? "without a name" : device.name,
                        device.numbers.empty() ? "" : ", " + device.numbers);
    if (!device.can.empty()) text += fmt::format("  {:<12} {}\n", "", device.can);
    if (match.device != nullptr && !device.can.empty())
      text += match.is_generic
                  ? fmt::format(
                        "  {:<12} no declaration is about it: taken for {}, all of whose figures are assumed;\n"
                        "  {:<12} `wale devices --identify {}` prints one to begin with\n",
                        "", match.device->profile.name, "", device.port)
                  : fmt::format("  {:<12} taken for {}\n", "", match.device->profile.name);
    if (!device.obstacle.empty()) text += fmt::format("  {:<12} cannot be used: {}\n", "", indented(device.obstacle));
  }
  return text;
}

std::string with_plugged(const std::string& devices_json, const std::vector<PluggedIn>& plugged,
                         const std::vector<DeclaredDevice>& known) {
  auto json = nlohmann::ordered_json::parse(devices_json);
  for (const PluggedIn& device : plugged) {
    const MatchedProfile match = matched_profile(device, known);
    json.push_back({{"name", device.name},
                    {"plugged_in", true},
                    {"feel", is_felt_on(device, match)},
                    {"build", false},
                    {"kind", device.kind},
                    {"usb", device.numbers},
                    {"port", device.port},
                    {"profile", match.device != nullptr ? match.device->profile.name : ""},
                    {"generic", match.is_generic},
                    {"can", device.can},
                    {"obstacle", device.obstacle}});
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace wale
