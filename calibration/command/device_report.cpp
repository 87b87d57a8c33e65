#include "calibration/command/device_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "runtime/device/match_device.hpp"
#include "schema/without_place.hpp"

namespace wale::command {
namespace {

const char* position_word(PositionSource source) {
  switch (source) {
    case PositionSource::none: return "none";
    case PositionSource::pointer: return "pointer";
    case PositionSource::touch: return "touch";
  }
  return "unknown";
}

nlohmann::ordered_json numbers_of(const DeviceWiring& wiring) {
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  for (const UsbNumbers& each : wiring.usb) numbers.push_back(in_words(each));
  return numbers;
}

nlohmann::ordered_json shaker_json(const DeclaredDevice& device) {
  const DeviceProfile& profile = device.profile;
  const Shaker& shaker = *profile.shaker;
  nlohmann::ordered_json json = {{"name", profile.name},
                                 {"feel", true},
                                 {"build", true},
                                 {"axes", 1},
                                 {"position", position_word(shaker.position)},
                                 {"peak_m_per_s2", shaker.peak()},
                                 {"lowest_hz", shaker.frequency_low},
                                 {"highest_hz", shaker.frequency_high},
                                 {"spin_up_s", shaker.spin_up},
                                 {"rate_hz", profile.rate}};
  if (shaker.position == PositionSource::none) {
    json["exploring_speed_m_per_s"] = shaker.exploring_speed;
  } else {
    json["workspace_m"] = profile.workspace_diameter;
    json["position_counts"] = profile.position_counts;
  }
  auto& response = json["response"] = nlohmann::ordered_json::array();
  for (const Shaker::Response& row : shaker.response)
    for (const auto& point : row.points)
      response.push_back({{"hz", row.frequency}, {"command", point.command}, {"m_per_s2", point.acceleration}});
  json["assumed"] = device.assumed;
  json["source"] = device.source;
  return json;
}

/// The width of the column of names, unless a name is longer.
constexpr std::size_t usual_column = 12;

bool is_unknown(const DeclaredDevice& device, const char* setting) {
  return std::ranges::find(device.unknown, setting) != device.unknown.end();
}

/// A figure of the handle: "0.6 kg", or "unknown".
std::string figure_text(const DeclaredDevice& device, const char* setting, double figure, const char* unit) {
  return is_unknown(device, setting) ? "unknown" : readable("{:.3g} {}", figure, unit);
}

/// The figures of a device's force or vibration, in two lines after a column that holds its name.
std::string figures_text(const DeclaredDevice& device, std::size_t column) {
  const DeviceProfile& profile = device.profile;
  const auto lines = [&](const std::string& first, const std::string& second) {
    return fmt::format("  {:<{}} {}\n  {:<{}} {}\n", profile.name, column, first, "", column, second);
  };
  if (!profile.shaker)
    return lines(
        readable("2 axes, {:.4g} N in {:.0f} steps, {:.4g} mm across in {:.0f} counts, {:.4g} Hz", profile.force_newton,
                 profile.force_counts, 1e3 * profile.workspace_diameter, profile.position_counts, profile.rate),
        fmt::format("moving mass {}, damping {}, friction {}", figure_text(device, "mass", profile.mass, "kg"),
                    figure_text(device, "damping", profile.damping, "N s/m"),
                    figure_text(device, "friction", profile.friction, "N")));
  const Shaker& shaker = *profile.shaker;
  const std::string vibrates =
      readable("vibrates: up to {:.4g} m/s^2 at {:.4g} .. {:.4g} Hz, spin-up {:.3g} ms, {:.4g} Hz", shaker.peak(),
               shaker.frequency_low, shaker.frequency_high, 1e3 * shaker.spin_up, profile.rate);
  if (shaker.position == PositionSource::none)
    return lines(vibrates, readable("no position: assumed to explore at {:.3g} m/s", shaker.exploring_speed));
  return lines(vibrates, readable("position by {}, {:.4g} mm across in {:.0f} counts", position_word(shaker.position),
                                  1e3 * profile.workspace_diameter, profile.position_counts));
}

std::string declared_text(const DeclaredDevice& device, std::size_t column) {
  std::string text = figures_text(device, column);
  const auto line = [&](const std::string& what) { text += fmt::format("  {:<{}} {}\n", "", column, what); };
  if (!device.wiring.usb.empty()) {
    std::string numbers;
    for (const UsbNumbers& each : device.wiring.usb) numbers += " " + in_words(each);
    line("on USB:" + numbers);
  }
  if (!device.unknown.empty()) line(fmt::format("unknown: {}", fmt::join(device.unknown, ", ")));
  if (!device.assumed.empty()) line(fmt::format("assumed, not measured: {}", fmt::join(device.assumed, ", ")));
  if (device.wiring.is_corrected()) line("its forces are corrected by what was measured on it");
  if (!device.source.empty()) line(device.source);
  return text;
}

/// Indents all lines but the first.
std::string indented(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
    text.insert(at + 1, "               ");
  return text;
}

/// Which declaration a plugged device is used by.
std::string match_text(const PluggedIn& device, const MatchedDevice& match) {
  const std::string& name = match.device->profile().name;
  if (match.is_generic)
    return fmt::format(
        "no declaration names it: used as {}, whose figures are all assumed;\n"
        "`wale devices --identify {}` prints a declaration to begin with",
        name, device.port);
  const std::string& file = match.device->file();
  return file.empty() ? "used as " + name : fmt::format("used as {}, which {} declares", name, file);
}

std::string plugged_text(const PluggedIn& device, std::span<const DeclaredDevice> known,
                         std::span<const TrustedDevice> trusted) {
  const MatchedDevice match = match_device(device, trusted);
  std::string text =
      fmt::format("  {:<{}} {}{}\n", device.port, usual_column, device.name.empty() ? "without a name" : device.name,
                  device.numbers.empty() ? "" : ", " + device.numbers);
  const auto line = [&](const std::string& what) {
    text += fmt::format("  {:<{}} {}\n", "", usual_column, indented(what));
  };
  if (!device.can.empty()) line(device.can);
  if (match.device != nullptr && !device.can.empty()) line(match_text(device, match));
  if (const DeclaredDevice* unused = untrusted_match(device, known, trusted); unused != nullptr && !device.can.empty())
    line(
        fmt::format("not used as {}: that declaration is none that you trust; save it as your own\n"
                    "(`wale devices --identify {}`), or name its file with --devices FILE",
                    unused->profile.name, device.port));
  if (!device.transport.empty()) line("driven by " + device.transport);
  if (!device.can.empty() && !device.driver->left_alone.empty())
    line(fmt::format("if Wale and its keeper are killed together, it {}", device.driver->left_alone));
  if (!device.held_by.empty()) line(fmt::format("in use by {}", fmt::join(device.held_by, ", ")));
  if (!device.can.empty() && device.processes_hidden > 0)
    line(fmt::format("perhaps in use by others: this user may not see the files of {} processes",
                     device.processes_hidden));
  if (device.obstacle) line("cannot be used: " + in_words_without_place(*device.obstacle));
  return text;
}

nlohmann::ordered_json plugged_json(const PluggedIn& device, std::span<const TrustedDevice> trusted) {
  const MatchedDevice match = match_device(device, trusted);
  return {{"name", device.name},
          {"plugged_in", true},
          {"feel", !device.obstacle && !device.can.empty() && match.device != nullptr},
          {"build", false},
          {"kind", device.driver->name},
          {"usb", device.numbers},
          {"port", device.port},
          {"profile", match.device != nullptr ? match.device->profile().name : ""},
          {"declared_in", match.device != nullptr ? match.device->file() : ""},
          {"generic", match.is_generic},
          {"can", device.can},
          {"transport", device.transport},
          {"left_alone", device.driver->left_alone},
          {"held_by", device.held_by},
          {"processes_hidden", device.processes_hidden},
          {"obstacle", device.obstacle ? in_words_without_place(*device.obstacle) : ""}};
}

/// A figure; null for zero, which means unknown.
nlohmann::ordered_json known_or_null(double figure) {
  return figure > 0 ? nlohmann::ordered_json(figure) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json joystick_json(const DeclaredDevice& device) {
  const DeviceProfile& profile = device.profile;
  const auto unless_unknown = [&](const char* setting, const nlohmann::ordered_json& figure) {
    return is_unknown(device, setting) ? nlohmann::ordered_json(nullptr) : figure;
  };
  return {{"name", profile.name},
          {"feel", true},
          {"build", true},
          {"axes", 2},
          {"force_newton", profile.force_newton},
          {"force_counts", profile.force_counts},
          {"workspace_m", profile.workspace_diameter},
          {"position_counts", profile.position_counts},
          {"rate_hz", profile.rate},
          {"mass_kg", unless_unknown("mass", profile.mass)},
          {"damping_newton_second_per_m", unless_unknown("damping", profile.damping)},
          {"friction_newton", unless_unknown("friction", profile.friction)},
          {"delay_s", unless_unknown("delay", {profile.delay_x, profile.delay_y})},
          {"bandwidth_hz", {known_or_null(profile.bandwidth_x), known_or_null(profile.bandwidth_y)}},
          {"usb", numbers_of(device.wiring)},
          {"axes_lie", {in_words(device.wiring.axes[0]), in_words(device.wiring.axes[1])}},
          {"motors_lie", {in_words(device.wiring.motors[0]), in_words(device.wiring.motors[1])}},
          {"gain", device.wiring.gain},
          {"corrected", device.wiring.is_corrected()},
          {"unknown", device.unknown},
          {"assumed", device.assumed},
          {"source", device.source}};
}

constexpr const char* spellings =
    "to feel on (wale feel --device NAME)\n"
    "  auto         the best one plugged in, else simulated; the default\n"
    "  simulated    a simulation of the joystick that the program was built for, in a simulated hand\n"
    "  simulated:NAME\n"
    "               a simulation of the device of that name, from the list below\n"
    "  NAME         the real device of that name; a simulation if it cannot be plugged in, as sandpaper\n"
    "  usb          the best device on USB\n"
    "  DRIVER       the best device of that driver: hid-pid, novint-falcon\n"
    "  1209:ffb0    the device with these numbers of vendor and product\n"
    "  1-2          the device at this port\n"
    "  A real device that is named but not plugged in is waited for; with --virtual-time or --hand, NAME means its\n"
    "  simulation, and what only a plugged device can mean is refused.\n"
    "\nto build for (wale build --device NAME)\n";

constexpr const char* nothing_plugged =
    "  no device to feel on\n"
    "               a joystick that is connected but not listed may need its own power, or a cable that carries\n"
    "               data; `lsusb` lists every device that the computer sees\n";

}  // namespace

std::string devices_text(std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                         const Connections& connections, std::span<const PluggedIn> plugged) {
  std::string text = spellings;
  std::size_t column = usual_column;
  for (const DeclaredDevice& device : known) column = std::max(column, device.profile.name.size());
  for (const DeclaredDevice& device : known) text += declared_text(device, column);
  text += "\nplugged in (wale feel --device PORT)\n";
  if (!connections.usb) text += fmt::format("  {}\n", in_words_without_place(connections.usb.error()));
  if (plugged.empty() && connections.usb) text += nothing_plugged;
  for (const PluggedIn& device : plugged) text += plugged_text(device, known, trusted);
  return text;
}

std::string devices_json(std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                         std::span<const PluggedIn> plugged) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  json.push_back({{"name", "simulated"}, {"feel", true}, {"build", false}});
  for (const DeclaredDevice& device : known)
    json.push_back(device.profile.shaker ? shaker_json(device) : joystick_json(device));
  for (const PluggedIn& device : plugged) json.push_back(plugged_json(device, trusted));
  return json_lines(json);
}

}  // namespace wale::command
