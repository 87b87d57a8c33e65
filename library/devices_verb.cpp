#include "library/devices_verb.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

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

}  // namespace

int devices(bool json) {
  declared_everywhere();
  const std::vector<DescribedDevice> known = devices_here();
  const Connections connections = Connections::open();
  const std::vector<PluggedIn> plugged = plugged_in(connections);
  fmt::print("{}", json ? with_plugged(devices_json(known), plugged, known)
                        : devices_text(known) + plugged_text(connections, plugged, known));
  return 0;
}

int identify(const std::string& device, const std::string& max_force, const std::atomic<bool>& stop) {
  IdentifyOptions options{.asks = isatty(fileno(stdin)) != 0};
  if (!max_force.empty()) {
    QuantityReader reader;
    const auto most = reader.force("--max-force", max_force);
    if (!most) {
      print_diagnostics(stderr, reader.diagnostics(), reader.sources());
      return refused;
    }
    if (!(*most > 0)) return refuse("the largest force allowed is more than nothing");
    options.most_newton = *most;
  }
  const std::vector<DescribedDevice> known = devices_here();
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
  DescribedDevice described = *matched_profile(*chosen.plugged, known).device;
  if (described.profile.shaker) return refuse(fmt::format("`{}` only vibrates: it has no axes", chosen.profile));
  DeviceWiring wiring = chosen.wiring;
  chosen.wiring = DeviceWiring{};  // its own axes and motors, as they are
  auto opened = open_device(connections, chosen, described.profile);
  if (const auto* refusal = std::get_if<Refusal>(&opened)) return refuse(refusal->reason);
  fmt::print(stderr, "identifying {}, as {}; Ctrl-C ends it at once\n", in_words(*chosen.plugged), chosen.profile);
  const auto found = identify_device(
      *std::get<std::unique_ptr<HotPluggedDevice>>(opened), options,
      [](std::string_view request) { fmt::print(stderr, "{}\n", request); }, stop);
  if (const auto* refusal = std::get_if<Refusal>(&found)) return refuse(refusal->reason);
  const Identified& identified = std::get<Identified>(found);
  fmt::print(stderr, "{}", identified_text(identified));
  if (!identified.motors_settled) return refused;
  wiring.axes = *identified.axes_settled;
  wiring.motors = *identified.motors_settled;
  if (const auto numbers = read_usb_numbers(chosen.plugged->numbers)) wiring.usb = {*numbers};
  fmt::print("{}", device_declaration(described, own_name(chosen.profile), wiring,
                                      {in_words(*chosen.plugged) + ", as `wale devices --identify` found it; its other "
                                                                   "figures are",
                                       "those of " + chosen.profile + "."}));
  fmt::print(
      stderr,
      "in a file devices.wale in this folder, in that of your wale.project, or in one of WALE_LIBRARY, it is known "
      "to every material there\n");
  return 0;
}

}  // namespace wale::command
