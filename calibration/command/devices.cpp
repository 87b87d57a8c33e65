#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
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
#include "calibration/command/trusted_here.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/standard_output.hpp"
#include "runtime/device/identify_device.hpp"
#include "runtime/device/match_device.hpp"
#include "runtime/device/open_device.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct DevicesOptions {
  bool json = false, save = false;
  std::vector<std::string> trusted;  ///< files whose declarations may scale a real device
  std::string device;                ///< to identify; empty: the best one
  std::string transport;             ///< to identify it by; empty: its driver chooses
  std::optional<double> max_force;   ///< N
};

/// The name of a person's own declaration: the shipped one's with `my_` before it, unless it already has that.
std::string own_name(const std::string& profile) { return profile.starts_with("my_") ? profile : "my_" + profile; }

// Pushing does not show how strong a motor is: the force at which the handle begins to move depends on friction, and
// its acceleration depends on mass. Neither gives the force while mass and friction are assumed.
constexpr std::array how_gain_is_measured{
    "gain is the force at the handle for each commanded newton. Pushing does not show it while mass and",
    "friction are assumed: `wale calibrate device` measures it with a force gauge, or a luggage scale."};

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
  const auto trusted = trusted_here(options.trusted);
  if (!trusted) return refuse(trusted.error());
  warn_of_unused(*trusted);
  const std::vector<DeclaredDevice> known = devices_here({}, trusted->files);
  const Connections connections = Connections::open();
  const std::vector<PluggedIn> plugged = plugged_in(connections);
  print_out(options.json ? devices_json(known, trusted->devices, plugged)
                         : devices_text(known, trusted->devices, connections, plugged));
  return done;
}

/// A real device with axes to identify.
Result<ChosenDevice> device_to_identify(const DevicesOptions& options, const Connections& connections) {
  const std::string& asked = options.device;
  const auto trusted = trusted_here(options.trusted);
  if (!trusted) return trusted.error();
  if (trusted->owners_problem) return *trusted->owners_problem;
  warn_of_unused(*trusted);
  if (auto hidden = private_device(asked, trusted->checked, "--identify")) return *std::move(hidden);
  auto chosen = choose_device({.spelling = asked.empty() ? "auto" : asked, .transport = options.transport}, {},
                              trusted->devices, plugged_in(connections, asked));
  if (!chosen) {
    if (chosen.error().place.name == "--device") chosen.error().place.name = "--identify";
    if (chosen.error().code == Code::absent_device) chosen.error().mend = "`wale devices` lists what is plugged in";
    return chosen;
  }
  const bool is_named = !asked.empty() && asked != "auto";
  if (!chosen->plugged && is_named)
    return Error{Code::malformed_value,
                 fmt::format("expected a real device, found `{}`, which is only simulated", asked),
                 "`wale devices` lists what is plugged in",
                 {.name = "--identify", .text = asked}};
  if (!chosen->plugged)
    return Error{Code::absent_device, chosen->is_worth_saying ? chosen->said : "no force-feedback device is plugged in",
                 "`wale devices` lists what is plugged in"};
  if (chosen->declared->profile.shaker)
    return Error{Code::unusable_device,
                 fmt::format("`{}` only vibrates: it has no axes to identify", chosen->declared->profile.name),
                 "a pad needs no identification: `wale feel FILE --device` runs a material on it as it is"};
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

/// The declaration of a person's own device, by that of its kind and what was found.
DeclaredDevice own_declaration(DeclaredDevice declared, const Identified& found, const PluggedIn& plugged) {
  declared.wiring = rewired(std::move(declared.wiring), found);
  declared.wiring.is_generic = false;
  if (const auto numbers = read_usb_numbers(plugged.numbers)) declared.wiring.usb = {*numbers};
  const bool is_gain_known = declared.wiring.gain != std::array<double, 2>{1, 1};
  if (!is_gain_known && std::ranges::find(declared.unknown, "gain") == declared.unknown.end())
    declared.unknown.emplace_back("gain");
  declared.profile.name = own_name(declared.profile.name);
  return declared;
}

/// Whether the person at this terminal wants a file to be written; nobody is asked where there is none.
bool agrees_to_write(const std::string& file) {
  if (isatty(fileno(stdin)) == 0) return false;
  print_error("write it to {}? [y/N] ", visible_text(file));
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "yes";
}

/// Adds a declaration to the owner's file, which is made where it is not there yet. Errors: W0202 where the file
/// declares a device of that name, W0505.
Result<> add_to_owners_file(const DeclaredDevice& declared, const std::string& declaration) {
  namespace fs = std::filesystem;
  const std::string file = owners_file();
  if (file.empty())
    return Error{Code::unwritable_file, "there is no folder for it", "set HOME, or XDG_CONFIG_HOME to a whole path"};
  std::error_code problem;
  std::string text = declaration;
  if (fs::exists(file, problem)) {
    const auto known = trusted_declarations({}, file);
    if (!known) return known.error();
    if (known->owners_problem) return *known->owners_problem;
    for (const TrustedDevice& each : known->devices)
      if (each.file() == file && each.profile().name == declared.profile.name)
        return Error{Code::declared_twice,
                     fmt::format("it declares `{}` already", declared.profile.name),
                     "remove that declaration, or add the printed one under another name",
                     {.name = file}};
    constexpr std::string_view header = "wale 1\n";  // the file has one
    text = known->files.front().bytes + text.substr(header.size());
  } else {
    fs::create_directories(fs::path(file).parent_path(), problem);
  }
  if (auto written = write_file(file, text, {}); !written) return written;
  print_error("written to {}: your device is driven by it from now on\n", visible_text(file));
  return {};
}

/// Prints a declaration, and writes it to the owner's file where the person wants that.
int offer_declaration(const DevicesOptions& options, const DeclaredDevice& declared, const std::string& declaration) {
  print_out(declaration);
  finish_standard_output();  // before the question; a failure is told at the end
  const std::string file = owners_file();
  if (options.save || (!file.empty() && agrees_to_write(file))) {
    const auto added = add_to_owners_file(declared, declaration);
    return added ? done : refuse(added.error());
  }
  if (!file.empty())
    print_error("saved in {} (`--save` does that), your device is driven by it, whatever is felt\n",
                visible_text(file));
  return done;
}

int identify(const DevicesOptions& options) {
  const std::atomic<bool>& stop = stop_on_signals();
  const Connections connections = Connections::open();
  auto choice = device_to_identify(options, connections);
  if (!choice) return refuse(choice.error());
  DeclaredDevice declared = *choice->declared;
  ChosenDevice chosen = *std::move(choice);
  chosen.trusted = chosen.trusted->as_built();
  const auto say = [](std::string_view what) { print_error("{}\n", what); };
  const auto opened = open_device(connections, chosen,
                                  {.priority = usual_priority - 1,
                                   .ask = say,
                                   .stop = &stop,
                                   .transport = options.transport,
                                   .most_newton = options.max_force.value_or(HUGE_VAL)});
  if (!opened) return refuse(opened.error());
  print_error("identifying {}, as {}; Ctrl-C ends it at once\n", in_words(*chosen.plugged), declared.profile.name);
  HotPluggedDevice& joystick = **opened;
  IdentifyOptions how{.asks = isatty(fileno(stdin)) != 0};
  if (options.max_force) how.most_newton = *options.max_force;
  const auto found = identify_device(joystick, how, say, stop);
  if (!found) return refuse(with_reason(found.error(), joystick));
  print_error(identified_text(*found));
  if (!found->motors_settled) return refused;
  const DeclaredDevice own = own_declaration(std::move(declared), *found, *chosen.plugged);
  return offer_declaration(options, own, device_declaration(own, comments_on(chosen, own.wiring)));
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
  verb.add_flag("--save", options->save,
                "adds what --identify prints to ~/.config/wale/devices.wale, by which your device is then driven")
      ->needs(identifies);
  offer_trusted_files(verb, options->trusted);
  offer_name(verb, "--transport", options->transport, transport_names(),
             "how --identify drives it, where its driver knows several ways")
      ->needs(identifies);
  verb.footer("for example: wale devices --json; wale devices --identify --save");
  return [options, identifies] {
    return identifies->count() > 0 ? status_after_signals(identify(*options)) : list_devices(*options);
  };
}

}  // namespace

extern const Verb devices_verb{"devices", "lists the joysticks that materials can be felt on and built for",
                               declare_devices};

}  // namespace wale::command
