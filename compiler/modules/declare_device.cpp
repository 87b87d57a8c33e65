#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/modules/declare_records.hpp"
#include "compiler/text/readable.hpp"
#include "runtime/machine/verify_figures.hpp"

namespace wale {

namespace {

void read_workspace(RecordReader& reader, DeviceProfile& profile) {
  const auto* workspace = reader.required("workspace", "disc(228.6 mm)");
  if (!workspace || workspace->items.empty()) return;
  const auto* call =
      workspace->items[0].value ? std::get_if<Call>(&reader.tree.expr(*workspace->items[0].value)) : nullptr;
  if (call && call->callee.text == "disc" && call->arguments.count == 1)
    profile.workspace_diameter =
        reader.value(reader.tree.arguments(*call)[0].value, reader.declarations.dimension("length")).value_or(0);
  if (!(profile.workspace_diameter > 0))
    reader.report(Code::wrong_type, workspace->span, "a workspace must be a disc with a diameter",
                  "write, for example, `workspace disc(228.6 mm)`");
}

/// `position touch, 1024 counts`, `position none`.
void read_source_of_position(RecordReader& reader, DeviceProfile& profile) {
  const auto* position = reader.required("position", "touch, 1024 counts");
  if (!position || position->items.empty()) return;
  const std::string source = words_of(position->items[0]);
  if (source == "none") return;
  if (source == "pointer" || source == "touch")
    profile.shaker->position = source == "touch" ? PositionSource::touch : PositionSource::pointer;
  else
    reader.report(Code::wrong_type, position->span,
                  "the position of a device that vibrates must be `pointer`, `touch` or `none`",
                  "write `position pointer, 1024 counts`, `position touch, 1024 counts` or `position none`");
  profile.position_counts = reader.quantity(*position, 1, "number").value_or(0);
}

/// `acceleration 60 Hz, 50 % = 2 m/s^2, 100 % = 5 m/s^2`: one frequency of a pad's response.
std::optional<Shaker::Response> response_of(RecordReader& reader, const Setting& setting) {
  const Declarations& declarations = reader.declarations;
  Shaker::Response response;
  response.frequency = reader.quantity(setting, 0, "frequency").value_or(0);
  for (std::size_t i = 1; i < setting.items.size(); ++i) {
    const SettingItem& item = setting.items[i];
    const auto command = item.value ? reader.value(*item.value, Dimension{}) : std::nullopt;
    const auto acceleration =
        item.equals ? reader.value(*item.equals, declarations.dimension("acceleration")) : std::nullopt;
    if (!command || !acceleration) return std::nullopt;
    response.points.push_back({*command, *acceleration});
  }
  const auto rises = [](const auto& a, const auto& b) {
    return a.command < b.command && a.acceleration < b.acceleration;
  };
  Shaker::Response::Point before;
  for (const auto& point : response.points) {
    if (!rises(before, point) || point.command > 1) return std::nullopt;
    before = point;
  }
  if (response.points.empty() || !(response.frequency > 0)) return std::nullopt;
  return response;
}

Shaker read_vibration(RecordReader& reader) {
  const Declarations& declarations = reader.declarations;
  Shaker vibration;
  for (const Setting* setting : reader.settings("acceleration")) {
    const std::size_t errors_before = reader.diagnostics.error_count();
    const auto response = response_of(reader, *setting);
    const bool rises =
        vibration.response.empty() || !response || response->frequency > vibration.response.back().frequency;
    if (response && rises)
      vibration.response.push_back(*response);
    else if (reader.diagnostics.error_count() == errors_before)
      reader.report(Code::value_out_of_range, setting->span,
                    "a response needs a frequency, then commands up to 100 % with their accelerations, all rising",
                    "write, for example, `acceleration 60 Hz, 50 % = 2 m/s^2, 100 % = 5 m/s^2`");
  }
  if (const auto* frequency = reader.required("frequency", "40 Hz .. 250 Hz"); frequency && !frequency->items.empty()) {
    const SettingItem& item = frequency->items.front();
    const Dimension hertz = declarations.dimension("frequency");
    if (item.value && item.range_end) {
      vibration.frequency_low = reader.value(*item.value, hertz).value_or(0);
      vibration.frequency_high = reader.value(*item.range_end, hertz).value_or(0);
    }
    if (!(vibration.frequency_low > 0 && vibration.frequency_high >= vibration.frequency_low))
      reader.report(Code::value_out_of_range, frequency->span, "this range of frequencies is empty",
                    "write, for example, `frequency 40 Hz .. 250 Hz`");
  }
  const auto optional = [&](const char* key, const char* dimension, double& figure) {
    const auto* found = reader.setting(key);
    if (!found) return;
    figure = reader.quantity(*found, 0, dimension).value_or(0);
    if (figure < 0)
      reader.report(Code::value_out_of_range, found->span, fmt::format("`{}` must not be negative", key),
                    "leave out the `-`");
  };
  optional("command", "number", vibration.command_steps);
  optional("spin_up", "time", vibration.spin_up);
  return vibration;
}

/// Reads the moving mass, its damping and its friction. Missing figures and those marked `unknown` are unknown.
void read_handle(RecordReader& reader, DeviceProfile& profile, std::vector<std::string>& unknown,
                 std::vector<FigureInterval>& intervals) {
  const auto known = [&](const char* key) {
    const auto* found = reader.setting(key);
    if (found != nullptr && !is_unknown(*found)) return found;
    unknown.emplace_back(key);
    return static_cast<const Setting*>(nullptr);
  };
  const auto optional = [&](const char* key, const char* dimension, double& figure) {
    const auto* found = known(key);
    if (found == nullptr) return;
    figure = reader.quantity(*found, 0, dimension).value_or(0);
    if (found->items.size() > 1 && has_word(found->items[1], "within"))
      if (const auto interval = read_within(reader, found->items[1], dimension))
        intervals.push_back({key, interval->first, interval->second});
  };
  optional("mass", "mass", profile.mass);
  optional("damping", "viscosity", profile.damping);
  optional("friction", "force", profile.friction);
  // One value for both axes, or one for each.
  const auto per_axis = [&](const char* key, const char* dimension, double& x, double& y) {
    const auto* found = known(key);
    if (found == nullptr) return;
    x = reader.quantity(*found, 0, dimension).value_or(0);
    y = x;
    const char* axis = "x";
    for (std::size_t i = 1; i < found->items.size(); ++i) {
      if (!has_word(found->items[i], "within")) {
        y = reader.quantity(*found, i, dimension).value_or(0);
        axis = "y";
      } else if (const auto interval = read_within(reader, found->items[i], dimension)) {
        intervals.push_back({fmt::format("{} {}", key, axis), interval->first, interval->second});
      }
    }
    if (x < 0 || y < 0)
      reader.report(Code::value_out_of_range, found->span, fmt::format("`{}` must not be negative", key),
                    fmt::format("leave out the `-`, or write `{} unknown`", key));
  };
  per_axis("delay", "time", profile.delay_x, profile.delay_y);
  per_axis("bandwidth", "frequency", profile.bandwidth_x, profile.bandwidth_y);
}

/// Reads `rate 900 Hz`: ticks per second, within the rates that the loop supports.
void read_rate(RecordReader& reader, DeviceProfile& profile) {
  profile.rate = reader.positive("rate", 0, "frequency", "900 Hz");
  if (profile.rate > 0 && !(profile.rate >= DeviceProfile::least_rate && profile.rate <= DeviceProfile::most_rate))
    reader.report(Code::value_out_of_range, reader.setting("rate")->items.front().span,
                  fmt::format("a device's rate must be {} Hz .. {} kHz", DeviceProfile::least_rate,
                              DeviceProfile::most_rate / 1000),
                  "write, for example, `rate 900 Hz`");
}

/// Reads the motors' sustained force and the active power of programs: `sustained 5 N, 20 s` and `active 2 W`. Each is
/// `unknown` if nobody knows it.
void read_motors(RecordReader& reader, DeviceProfile& profile) {
  const auto known = [&](const char* key) -> const Setting* {
    const auto* found = reader.setting(key);
    return found && !found->items.empty() && (found->items[0].value || words_of(found->items[0]) != "unknown")
               ? found
               : nullptr;
  };
  if (const auto* continuous = known("sustained")) {
    const std::size_t errors_before = reader.diagnostics.error_count();
    profile.continuous_newton = reader.quantity(*continuous, 0, "force").value_or(0);
    profile.heating_seconds = reader.quantity(*continuous, 1, "time").value_or(0);
    const bool lawful = profile.continuous_newton > 0 && profile.continuous_newton <= profile.force_newton;
    if (reader.diagnostics.error_count() == errors_before && profile.force_newton > 0 &&
        !(lawful && profile.heating_seconds >= DeviceProfile::least_heating_seconds))
      reader.report(
          Code::value_out_of_range, continuous->span,
          readable("the sustained force of an axis must be greater than zero and at most its largest force, {:.6g} "
                   "N; its heating time must be at least {:.6g} ms",
                   profile.force_newton, 1e3 * DeviceProfile::least_heating_seconds),
          "write, for example, `sustained 5 N, 20 s`, or `sustained unknown` if it is not known");
  }
  if (const auto* active = known("active")) {
    const auto power = reader.quantity(*active, 0, "power");
    profile.active_watt = power.value_or(0);
    if (power && !(*power > 0 && *power <= most_active_watt))
      reader.report(
          Code::value_out_of_range, active->span,
          fmt::format("the active power of a program must be greater than zero and at most {} W", most_active_watt),
          "write, for example, `active 2 W`, or `active unknown` if it is not known");
  }
}

/// Rate, limits, filter and patch of a device, and the figures of its handle and motors.
void read_figures(RecordReader& reader, const Declarations& declarations, DeviceDeclaration& device, bool vibrates) {
  DeviceProfile& profile = device.profile;
  const bool has_position = profile.has_position();
  if (has_position) read_workspace(reader, profile);
  if (!vibrates) {
    profile.position_counts = reader.positive("position", 0, "number", "4096 counts");
    profile.force_newton = reader.positive("force", 0, "force", "10 N, 2048 counts");
    if (const auto* force = reader.setting("force"))
      profile.force_counts = reader.quantity(*force, 1, "number").value_or(0);
  }
  read_rate(reader, profile);
  if (has_position)
    profile.speed_limit = reader.positive("speed", 0, "velocity", "1 m/s");
  else
    profile.shaker->exploring_speed = reader.positive("explores", 0, "velocity", "0.1 m/s");
  if (!vibrates)
    profile.slew = reader.positive("slew", 0, "slew", "200 N/s");
  else if (const auto* slew = reader.setting("slew"); slew && !slew->items.empty() && slew->items[0].value)
    profile.slew =
        reader.value(*slew->items[0].value, declarations.dimension("acceleration") / declarations.dimension("time"))
            .value_or(0);
  if (const auto* filter = has_position ? reader.required("velocity_filter", "15, 1 counts") : nullptr) {
    profile.velocity_window = reader.quantity(*filter, 0, "number").value_or(0);
    profile.velocity_noise_counts = reader.quantity(*filter, 1, "number").value_or(0);
  }
  if (const auto* patch = reader.required("patch", "160 mm, 160 mm, 5 mm")) {
    profile.patch_width = reader.quantity(*patch, 0, "length").value_or(0);
    profile.patch_height = reader.quantity(*patch, 1, "length").value_or(0);
    profile.patch_rim = reader.quantity(*patch, 2, "length").value_or(0);
  }
  if (!vibrates) {
    read_handle(reader, profile, device.unknown, device.intervals);
    read_motors(reader, profile);
  }
}

/// Records which figures nobody measured, and whether damping and friction are known.
void read_assumptions(RecordReader& reader, DeviceDeclaration& device, bool vibrates) {
  for (const auto& setting : reader.record.settings)
    for (const auto& item : setting.items)
      if (has_word(item, "assumed") && (device.assumed.empty() || device.assumed.back() != setting.key.text))
        device.assumed.emplace_back(setting.key.text);
  const auto known = [&](const char* key) {
    return reader.setting(key) && std::ranges::find(device.assumed, key) == device.assumed.end() &&
           std::ranges::find(device.unknown, key) == device.unknown.end();
  };
  device.profile.damping_known = !vibrates && known("damping");
  device.profile.friction_known = !vibrates && known("friction");
}

/// Reads the realisations of percepts: the device's own, then those of its class for the other percepts.
void read_all_realisations(RecordReader& reader, const Declarations& declarations, DeviceDeclaration& device,
                           bool vibrates) {
  const DeviceProfile& profile = device.profile;
  read_realisations(reader, declarations, profile.name, device.realise);
  if (const auto* of_class = reader.setting("class"); of_class && !of_class->items.empty()) {
    device.of_class = words_of(of_class->items.front());
    if (const auto* found = declarations.classes.find(device.of_class))
      device.realise.insert(found->realise.begin(), found->realise.end());
    else
      reader.report(Code::unknown_name, of_class->span,
                    fmt::format("nothing declares a class of devices `{}`", device.of_class),
                    did_you_mean(of_class->items.front().span, device.of_class, declarations.classes.spellings(),
                                 "declare it, as in calibration/devices/classes.wale"));
  }
  for (const auto& [percept, rule] : device.realise)
    if (rule.rate.has_value() != vibrates)
      reader.report(
          Code::wrong_type, reader.record.name.span,
          fmt::format("`{}` {}, but its realisation of {} ({}) is {}", profile.name, vibrates ? "vibrates" : "pushes",
                      percept, rule.owner, vibrates ? "a force" : "a vibration"),
          vibrates ? "give its shaking and a `rate`, or use another class of devices"
                   : "give a force without a `rate`, or use another class of devices");
}

/// The setting of a figure that the machine refuses. Most have one name in both.
std::string setting_of(std::string_view figure) {
  constexpr std::pair<std::string_view, std::string_view> others[] = {{"position counts", "position"},
                                                                      {"speed limit", "speed"},
                                                                      {"force counts", "force"},
                                                                      {"continuous_force", "sustained"},
                                                                      {"heating_seconds", "sustained"},
                                                                      {"active_power", "active"},
                                                                      {"velocity_window", "velocity_filter"},
                                                                      {"velocity_noise_counts", "velocity_filter"},
                                                                      {"patch_width", "patch"},
                                                                      {"patch_height", "patch"},
                                                                      {"delay_x", "delay"},
                                                                      {"delay_y", "delay"},
                                                                      {"bandwidth_x", "bandwidth"},
                                                                      {"bandwidth_y", "bandwidth"}};
  for (const auto& [of, setting] : others)
    if (of == figure) return std::string(setting);
  return std::string(figure.empty() ? "acceleration" : figure);  // the figures of a vibration have no names
}

/// No program is built for a device with a figure that the machine refuses: it is told here, and not of each material.
void require_possible_figures(RecordReader& reader, const DeviceProfile& profile) {
  if (const auto* patch = reader.setting("patch")) {
    const double shorter = std::min(profile.patch_width, profile.patch_height);
    if (!(shorter > 0 && profile.patch_rim >= 0 && profile.patch_rim < shorter / 2))
      return reader.report(Code::value_out_of_range, patch->span,
                           "a patch has a width and a height above 0 and a rim of less than half of these",
                           "write, for example, `patch 160 mm, 160 mm, 5 mm`");
  }
  RefusedFigure refused;
  try {
    verify_device(profile, &refused);
  } catch (const Error& error) {
    const auto* setting = reader.setting(setting_of(refused.name));
    reader.report(Code::value_out_of_range, setting ? setting->span : reader.record.name.span,
                  fmt::format("no program runs on `{}`: {}", profile.name, error.sentence),
                  "give a figure in this range");
  }
}

/// `grade simulated`: what was measured on a simulation is about no plugged device.
void read_grade(RecordReader& reader, const DeviceWiring& wiring) {
  const auto* grade = reader.setting("grade");
  if (!grade) return;
  const std::string word = grade->items.size() == 1 && !grade->items[0].value ? words_of(grade->items[0]) : "";
  if (word != "measured" && word != "simulated")
    reader.report(Code::wrong_type, grade->span, "the grade of a device's figures is measured or simulated",
                  "write `grade simulated` if a simulation gave them");
  else if (word == "simulated" && (!wiring.usb.empty() || wiring.is_generic))
    reader.report(Code::value_out_of_range, grade->span,
                  "figures that were measured on a simulation cannot scale a plugged device",
                  "remove `usb`, or measure the device itself: `wale calibrate device`");
}

}  // namespace

void declare_device(RecordReader& reader, Declarations& declarations) {
  const RecordDecl& record = reader.record;
  DeviceDeclaration device;
  device.documentation = record.documentation;
  device.span = record.name.span;
  DeviceProfile& profile = device.profile;
  profile.name = record.name.text;
  if (const auto* other = declarations.devices.entry(profile.name))
    return reader.reject(Code::declared_twice, record.name.span,
                         fmt::format("a device `{}` is declared already", profile.name), another_name(other->declared));

  const std::size_t errors_before = reader.diagnostics.error_count();
  const bool vibrates = !reader.settings("acceleration").empty();
  if (vibrates) {
    profile.shaker = read_vibration(reader);
    read_source_of_position(reader, profile);
  }
  read_figures(reader, declarations, device, vibrates);
  read_wiring(reader, profile, device.wiring, device.intervals);
  if (const auto gains = vibrates ? std::vector<const Setting*>{} : reader.settings("gain");
      !gains.empty() && is_unknown(*gains.front()))
    device.unknown.emplace_back("gain");
  if (!vibrates) read_grade(reader, device.wiring);
  read_assumptions(reader, device, vibrates);
  read_all_realisations(reader, declarations, device, vibrates);
  device.source = reader.text("source");
  if (!reader.lacks_some() && reader.diagnostics.error_count() == errors_before)
    require_possible_figures(reader, profile);
  const std::string name = profile.name;
  declarations.devices.add(name,
                           {.what = std::move(device), .declared = record.name.span, .exported = record.exported});
}

}  // namespace wale
