#include "library/device_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace wale {

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

}  // namespace

std::string devices_text(const std::vector<DeclaredDevice>& devices) {
  std::string text =
      "to feel on (wale feel --device NAME)\n"
      "  auto         the best that is plugged in, else simulated: what is taken unless you say otherwise\n"
      "  simulated    the joystick that the program was built for, simulated, in a simulated hand\n"
      "  a device to build for, by its name: the real one; one that cannot be plugged in is simulated\n"
      "  simulated:NAME: that one, and never the real one\n"
      "  usb, vendor and product (1209:ffb0), a port (1-2): what is plugged in there\n"
      "  a real one that is not there is waited for until it is plugged in\n"
      "\nto build for (wale build --device NAME)\n";
  for (const DeclaredDevice& device : devices) {
    const DeviceProfile& profile = device.profile;
    if (profile.shaker) {
      const Shaker& shaker = *profile.shaker;
      text += fmt::format(
          "  {:<12} vibrates: up to {:.4g} m/s^2 at {:.4g} .. {:.4g} Hz, spin-up {:.3g} ms, {:.4g} Hz\n", profile.name,
          shaker.peak(), shaker.frequency_low, shaker.frequency_high, 1e3 * shaker.spin_up, profile.rate);
      text +=
          shaker.position == PositionSource::none
              ? fmt::format("  {:<12} no position: taken to explore at {:.3g} m/s\n", "", shaker.exploring_speed)
              : fmt::format("  {:<12} position by {}, {:.4g} mm across in {:.4g} counts\n", "",
                            position_word(shaker.position), 1e3 * profile.workspace_diameter, profile.position_counts);
    } else {
      text += fmt::format("  {:<12} 2 axes, {:.4g} N in {:.4g} steps, {:.4g} mm across in {:.4g} counts, {:.4g} Hz\n",
                          profile.name, profile.force_newton, profile.force_counts, 1e3 * profile.workspace_diameter,
                          profile.position_counts, profile.rate);
      text += fmt::format("  {:<12} moving mass {:.3g} kg, damping {:.3g} N s/m, friction {:.3g} N\n", "", profile.mass,
                          profile.damping, profile.friction);
    }
    if (!device.wiring.usb.empty()) {
      std::string numbers;
      for (const UsbNumbers& each : device.wiring.usb) numbers += " " + in_words(each);
      text += fmt::format("  {:<12} on USB:{}\n", "", numbers);
    }
    if (!device.unknown.empty()) text += fmt::format("  {:<12} unknown: {}\n", "", fmt::join(device.unknown, ", "));
    if (!device.assumed.empty())
      text += fmt::format("  {:<12} assumed, not measured: {}\n", "", fmt::join(device.assumed, ", "));
    if (!device.source.empty()) text += fmt::format("  {:<12} {}\n", "", device.source);
  }
  return text;
}

std::string devices_json(const std::vector<DeclaredDevice>& devices) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  json.push_back({{"name", "simulated"}, {"feel", true}, {"build", false}});
  for (const DeclaredDevice& device : devices) {
    if (device.profile.shaker) {
      json.push_back(shaker_json(device));
      continue;
    }
    const DeviceProfile& profile = device.profile;
    json.push_back({{"name", profile.name},
                    {"feel", true},
                    {"build", true},
                    {"axes", 2},
                    {"force_newton", profile.force_newton},
                    {"force_counts", profile.force_counts},
                    {"workspace_m", profile.workspace_diameter},
                    {"position_counts", profile.position_counts},
                    {"rate_hz", profile.rate},
                    {"mass_kg", profile.mass},
                    {"damping_newton_second_per_m", profile.damping},
                    {"friction_newton", profile.friction},
                    {"delay_s", {profile.delay_x, profile.delay_y}},
                    {"bandwidth_hz", {profile.bandwidth_x, profile.bandwidth_y}},
                    {"usb", numbers_of(device.wiring)},
                    {"axes_lie", {in_words(device.wiring.axes[0]), in_words(device.wiring.axes[1])}},
                    {"motors_lie", {in_words(device.wiring.motors[0]), in_words(device.wiring.motors[1])}},
                    {"gain", device.wiring.gain},
                    {"unknown", device.unknown},
                    {"assumed", device.assumed},
                    {"source", device.source}});
  }
  return json.dump(2) + "\n";
}

}  // namespace wale
