#include "library/devices_verb.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "compiler/command/command.hpp"
#include "compiler/quantity.hpp"
#include "library/device_report.hpp"
#include "library/devices_known.hpp"
#include "library/identify_device.hpp"
#include "library/open_device.hpp"
#include "library/plugged_report.hpp"

namespace wale::command {
namespace {

/// Of a declaration of one's own: that of ours with `my_` before it, which it keeps when it is made anew.
std::string own_name(const std::string& profile) { return profile.starts_with("my_") ? profile : "my_" + profile; }

/// Why a push does not tell how strong a motor is. What starts to move shows its friction, and how fast it does its
/// force beside its mass: neither shows the force by itself where mass and friction are assumed.
constexpr std::array how_gain_is_measured{
    "gain is how much is at the handle of each newton that is told. Pushing shows it only beside mass and friction,",
    "which nobody has measured: hold a force gauge, or a luggage scale, against the handle while `wale feel` runs a",
    "material with `force = vector(2 N, 0 N)`, and divide what it shows by 2; then the same for y."};

/// ": it was unplugged", of one that was lost: it is found out a moment after the loss. Empty where none was.
std::string why_lost(const HotPluggedDevice& joystick) {
  constexpr auto a_moment = std::chrono::milliseconds(50);
  constexpr int most_looks = 20;
  HotPlugReport report = joystick.report();
  for (int look = 0; look < most_looks && report.losses > 0 && report.reason.empty(); ++look) {
    std::this_thread::sleep_for(a_moment);
    report = joystick.report();
  }
  return report.reason.empty() ? "" : ": " + report.reason;
}

}  // namespace

int devices(bool json) {
  declared_everywhere();
  const std::vector<DeclaredDevice> known = devices_here();
  const Connections connections = Connections::open();
  const std::vector<PluggedIn> plugged = plugged_in(connections);
  fmt::print("{}", json ? with_plugged(devices_json(known), plugged, known)
                        : devices_text(known) + plugged_text(connections, plugged, known));
  return 0;
}

int identify(const std::string& device, const std::string& max_force, const std::atomic<bool>& stop) {
  IdentifyOptions options{.asks = isatty(fileno(stdin)) != 0};
  if (!max_force.empty()) {
    const auto most = read_force(declared_everywhere()->declarations, "--max-force", max_force);
    if (!most) return refuse(most.error());
    options.most_newton = *most;
  }
  const std::vector<DeclaredDevice> known = devices_here();
  const Connections connections = Connections::open();
  const std::vector<PluggedIn> plugged = plugged_in(connections);
  const auto choice = choose_device({.spelling = device.empty() ? "auto" : device}, known, plugged);
  if (const auto* refusal = std::get_if<Refusal>(&choice)) return refuse(refusal->reason);
  if (const auto* absent = std::get_if<Absent>(&choice)) return refuse(absent->what + "; `wale devices` lists what is");
  ChosenDevice chosen = std::get<ChosenDevice>(choice);
  if (!chosen.plugged)
    return refuse(chosen.is_worth_saying ? chosen.said
                  : device.empty() || device == "auto"
                      ? "no force-feedback device is plugged in; see `wale devices`"
                      : fmt::format("`{}` is no real device, and lies nowhere; see `wale devices`", device));
  DeclaredDevice described = *matched_profile(*chosen.plugged, known).device;
  if (described.profile.shaker) return refuse(fmt::format("`{}` only vibrates: it has no axes", chosen.profile));
  DeviceWiring wiring = chosen.wiring;
  chosen.wiring = DeviceWiring{};  // its own axes and motors, as they are
  const auto say = [](std::string_view what) { fmt::print(stderr, "{}\n", what); };
  auto opened = open_device(connections, chosen, described.profile, say, &stop);
  if (const auto* refusal = std::get_if<Refusal>(&opened)) return refuse(refusal->reason);
  fmt::print(stderr, "identifying {}, as {}; Ctrl-C ends it at once\n", in_words(*chosen.plugged), chosen.profile);
  HotPluggedDevice& joystick = *std::get<std::unique_ptr<HotPluggedDevice>>(opened);
  const auto found = identify_device(joystick, options, say, stop);
  if (const auto* refusal = std::get_if<Refusal>(&found)) return refuse(refusal->reason + why_lost(joystick));
  const Identified& identified = std::get<Identified>(found);
  fmt::print(stderr, "{}", identified_text(identified));
  if (!identified.motors_settled) return refused;
  wiring = rewired(std::move(wiring), identified);
  if (const auto numbers = read_usb_numbers(chosen.plugged->numbers)) wiring.usb = {*numbers};
  std::vector<std::string> comments{
      in_words(*chosen.plugged) + ", as `wale devices --identify` found it; its other figures are",
      "those of " + chosen.profile + "."};
  if (wiring.gain == std::array<double, 2>{1, 1}) {  // as if it were not written
    if (std::ranges::find(described.unknown, "gain") == described.unknown.end()) described.unknown.emplace_back("gain");
    std::ranges::copy(how_gain_is_measured, std::back_inserter(comments));
  }
  fmt::print("{}", device_declaration(described, own_name(chosen.profile), wiring, comments));
  fmt::print(
      stderr,
      "in a file devices.wale in this folder, in that of your wale.project, or in one of WALE_LIBRARY, it is known "
      "to every material there\n");
  return 0;
}

}  // namespace wale::command
