#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "calibration/command/device_declaration.hpp"
#include "calibration/command/device_report.hpp"
#include "calibration/command/devices_here.hpp"
#include "calibration/command/interrupt.hpp"
#include "compiler/command/options.hpp"
#include "runtime/device/identify_device.hpp"
#include "runtime/device/match_device.hpp"
#include "runtime/device/open_device.hpp"

namespace wale::command {
namespace {

struct DevicesOptions {
  bool json = false, identify = false;
  std::string device;               ///< to identify; empty: the best one
  std::string transport;            ///< to identify it by; empty: its driver chooses
  std::optional<double> max_force;  ///< N
};

/// The name of a person's own declaration: the shipped one's with `my_` before it, unless it already has that.
std::string own_name(const std::string& profile) { return profile.starts_with("my_") ? profile : "my_" + profile; }

// Pushing does not show how strong a motor is: the force at which the handle begins to move depends on friction, and
// its acceleration depends on mass. Neither gives the force while mass and friction are assumed.
constexpr std::array how_gain_is_measured{
    "gain is the force at the handle for each commanded newton. Pushing does not show it while mass and",
    "friction are assumed: hold a force gauge, or a luggage scale, against the handle while `wale feel` runs a",
    "material with `force = vector(2 N, 0 N)`, and divide its reading by 2; then the same for y."};

/// Adds the reason of a loss, which is known only a moment after the loss.
Error with_reason(Error error, const HotPluggedDevice& joystick) {
  constexpr auto a_moment = std::chrono::milliseconds(50);
  constexpr int most_looks = 20;
  HotPlugReport report = joystick.report();
  for (int look = 0; look < most_looks && report.losses > 0 && report.reason.empty(); ++look) {
    std::this_thread::sleep_for(a_moment);
    report = joystick.report();
  }
  if (!report.reason.empty()) error.sentence += ": " + report.reason;
  return error;
}

int list_devices(const DevicesOptions& options) {
  declared_everywhere();
  const std::vector<DeclaredDevice> known = devices_here();
  const Connections connections = Connections::open();
  const std::vector<PluggedIn> plugged = plugged_in(connections);
  fmt::print("{}", options.json ? devices_json(known, plugged) : devices_text(known, connections, plugged));
  return done;
}

/// A real device with axes to identify.
Result<ChosenDevice> device_to_identify(const std::string& asked, const Connections& connections) {
  const std::vector<DeclaredDevice> known = devices_here();
  auto chosen = choose_device({.spelling = asked.empty() ? "auto" : asked}, known, plugged_in(connections, asked));
  if (!chosen) {
    if (chosen.error().place.name == "--device") chosen.error().place.name = "--identify";
    if (chosen.error().code == Code::absent_device) chosen.error().mend = "`wale devices` lists what is plugged in";
    return chosen;
  }
  if (!chosen->plugged)
    return Error{Code::absent_device,
                 chosen->is_worth_saying            ? chosen->said
                 : asked.empty() || asked == "auto" ? "no force-feedback device is plugged in"
                                                    : fmt::format("`{}` is not a real device", asked),
                 "`wale devices` lists what is plugged in"};
  if (chosen->declared->profile.shaker)
    return Error{Code::unusable_device,
                 fmt::format("`{}` only vibrates: it has no axes", chosen->declared->profile.name)};
  return chosen;
}

/// The comment at the top of an identified device's declaration.
std::vector<std::string> comments_on(const ChosenDevice& chosen, const DeviceWiring& wiring) {
  std::vector<std::string> comments{
      in_words(*chosen.plugged) + ", as `wale devices --identify` found it; its other figures are",
      "those of " + chosen.declared->profile.name + "."};
  if (wiring.gain == std::array<double, 2>{1, 1}) std::ranges::copy(how_gain_is_measured, std::back_inserter(comments));
  return comments;
}

int identify(const DevicesOptions& options) {
  const std::atomic<bool>& stop = stop_on_signals();
  const Connections connections = Connections::open();
  auto choice = device_to_identify(options.device, connections);
  if (!choice) return refuse(choice.error());
  DeclaredDevice declared = *choice->declared;
  ChosenDevice chosen = *std::move(choice);
  chosen.declared->wiring = DeviceWiring{};  // its own axes and motors, as they are
  const auto say = [](std::string_view what) { fmt::print(stderr, "{}\n", what); };
  const auto opened = open_device(
      connections, chosen, {.priority = loop_priority - 1, .ask = say, .stop = &stop, .transport = options.transport});
  if (!opened) return refuse(opened.error());
  fmt::print(stderr, "identifying {}, as {}; Ctrl-C ends it at once\n", in_words(*chosen.plugged),
             declared.profile.name);
  HotPluggedDevice& joystick = **opened;
  IdentifyOptions how{.asks = isatty(fileno(stdin)) != 0};
  if (options.max_force) how.most_newton = *options.max_force;
  const auto found = identify_device(joystick, how, say, stop);
  if (!found) return refuse(with_reason(found.error(), joystick));
  fmt::print(stderr, "{}", identified_text(*found));
  if (!found->motors_settled) return refused;

  const std::vector<std::string> comments = comments_on(chosen, declared.wiring);
  declared.wiring = rewired(std::move(declared.wiring), *found);
  declared.wiring.is_generic = false;
  if (const auto numbers = read_usb_numbers(chosen.plugged->numbers)) declared.wiring.usb = {*numbers};
  const bool is_gain_known = declared.wiring.gain != std::array<double, 2>{1, 1};
  if (!is_gain_known && std::ranges::find(declared.unknown, "gain") == declared.unknown.end())
    declared.unknown.emplace_back("gain");
  declared.profile.name = own_name(declared.profile.name);
  fmt::print("{}", device_declaration(declared, comments));
  fmt::print(
      stderr,
      "saved as devices.wale in this folder, in the folder of your wale.project or in one of WALE_LIBRARY, it is "
      "known to every material there\n");
  return done;
}

Run declare_devices(CLI::App& verb) {
  const auto options = std::make_shared<DevicesOptions>();
  offer_json(verb, options->json, "a JSON array");
  auto* identifies = verb.add_option("--identify", options->device,
                                     "pushes a device gently, to find the directions of its axes and motors, and "
                                     "prints a declaration of it (default: the best one plugged in)")
                         ->expected(0, 1)
                         ->default_str("auto")  // tells an option that stands alone from an empty name
                         ->type_name("[DEVICE]")
                         ->excludes("--json");
  offer_force(verb, "--max-force", options->max_force,
              "the largest force of --identify, as in \"1 N\" (default, and at most: a fifth of the device's)")
      ->needs(identifies);
  offer_name(verb, "--transport", options->transport, transport_names(),
             "how --identify drives it, where its driver knows several ways")
      ->needs(identifies);
  verb.footer("for example: wale devices --json; wale devices --identify > devices.wale");
  return [options, identifies] { return identifies->count() > 0 ? identify(*options) : list_devices(*options); };
}

}  // namespace

extern const Verb devices_verb{"devices", "lists the joysticks that materials can be felt on and built for",
                               declare_devices};

}  // namespace wale::command
