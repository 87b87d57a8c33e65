#include "wale/devices.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/vec2.hpp>
#include <set>
#include <utility>
#include <variant>

#include "runtime/device/device_at_home.hpp"
#include "runtime/device/limited_device.hpp"
#include "runtime/device/match_device.hpp"
#include "runtime/device/open_device.hpp"
#include "schema/closest_names.hpp"
#include "schema/name_text.hpp"
#include "schema/owners_devices_file.hpp"
#include "schema/visible_text.hpp"
#include "wale/simulated_pad.hpp"

namespace wale {
namespace {

constexpr const char* spelling_mend = "spell a device, as in \"auto\", \"simulated\" or \"1-2\"";
constexpr const char* transport_mend = "name one, as in \"hidraw\"";
constexpr std::string_view pointer_driver_name = "pointer";

Result<std::vector<TrustedDevice>> all_of(const TrustedDevices& trusted) {
  if (trusted.all() != nullptr) return *trusted.all();
  return trusted_devices();
}

bool has_owners_file() {
  const std::string file = owners_devices_file(std::getenv("XDG_CONFIG_HOME"), std::getenv("HOME"));
  std::error_code ignored;
  return !file.empty() && std::filesystem::exists(file, ignored);
}

DeviceInfo info_of(const PluggedIn& plugged, std::span<const TrustedDevice> trusted) {
  DeviceInfo info{.spelling = plugged.port,
                  .kind = plugged.driver->is_felt ? DeviceKind::real : DeviceKind::pointer,
                  .name = plugged.name,
                  .numbers = plugged.numbers,
                  .can = plugged.can,
                  .obstacle = plugged.obstacle,
                  .held_by = plugged.held_by};
  const MatchedDevice match = match_device(plugged, trusted);
  if (match.device != nullptr) info.profile = match.device->profile(), info.is_generic = match.is_generic;
  return info;
}

bool is_finite(glm::dvec2 vector) { return std::isfinite(vector.x) && std::isfinite(vector.y); }

const char* wrong_in(const Rest& rest) { return is_finite(rest.position) ? nullptr : "expected a finite position"; }
const char* wrong_in(const Circular& circle) {
  if (std::isfinite(circle.radius) && std::isfinite(circle.frequency) && is_finite(circle.centre)) return nullptr;
  return "expected a finite radius, frequency and centre";
}
const char* wrong_in_stroke(double length, double frequency, glm::dvec2 centre, glm::dvec2 direction) {
  if (!std::isfinite(length) || !std::isfinite(frequency) || !is_finite(centre))
    return "expected a finite amplitude, frequency and centre";
  constexpr double nearly = 1e-6;
  const double off = std::abs(std::hypot(direction.x, direction.y) - 1);
  return off < nearly ? nullptr : "expected a direction of length 1";
}
const char* wrong_in(const Lateral& stroke) {
  return wrong_in_stroke(stroke.amplitude, stroke.frequency, stroke.centre, stroke.direction);
}
const char* wrong_in(const Press& push) {
  return wrong_in_stroke(push.depth, push.frequency, push.centre, push.direction);
}
const char* wrong_in(const Trace& trace) {
  if (trace.points.empty()) return "expected a trace of a point at least";
  const TracePoint* before = nullptr;
  for (const TracePoint& point : trace.points) {
    if (!std::isfinite(point.time) || !is_finite(point.position) || !is_finite(point.velocity))
      return "expected a trace of finite numbers";
    if (before != nullptr && !(point.time > before->time)) return "expected a trace whose times rise";
    before = &point;
  }
  return nullptr;
}
/// The sentence of the error of a motion; null if it has none.
const char* wrong_in(const Motion& motion) {
  return std::visit([](const auto& each) { return wrong_in(each); }, motion);
}

Result<> is_sound(const OpenOptions& options) {
  if (!(options.max_force > 0))
    return Error{Code::malformed_value, "expected a positive force", "give newtons, as in 2", {.name = "max_force"}};
  if (options.priority && (*options.priority < 1 || *options.priority > 99))
    return Error{Code::malformed_value,
                 "expected a priority from 1 to 99",
                 "leave it out for an ordinary one",
                 {.name = "priority"}};
  for (const double each : {options.hand.mass, options.hand.damping, options.hand.stiffness})
    if (!(each >= 0 && std::isfinite(each)))
      return Error{Code::malformed_value,
                   "expected finite numbers that are not negative",
                   "give kg, N s/m and N/m; all 0 is no hand",
                   {.name = "hand"}};
  const char* const wrong = options.motion ? wrong_in(*options.motion) : nullptr;
  if (wrong != nullptr)
    return Error{Code::malformed_value, wrong, "give m, Hz and s; a direction has length 1, and times rise", {.name = "motion"}};
  return {};
}

Result<std::unique_ptr<Device>> simulation(const DeviceProfile& profile, const OpenOptions& options) {
  const Motion motion = options.motion.value_or(Rest());
  std::unique_ptr<Device> device;
  if (profile.shaker) {
    device = std::make_unique<SimulatedPad>(profile, motion);
    return device;
  }
  if (!(profile.mass + options.hand.mass > 0))
    return Error{Code::malformed_value,
                 "`" + profile.name + "` has no mass of its own, so it cannot move without a hand",
                 "give the hand a mass",
                 {.name = "hand"}};
  const HandModel& hand = options.hand;
  if (options.motion && hand.mass == 0 && hand.damping == 0 && hand.stiffness == 0)
    return Error{Code::malformed_value,
                 "there is a motion, and no hand that makes it",
                 "give a hand, as 0.55 kg, 6.5 N s/m and 135 N/m, or open it by the library, which brings one",
                 {.name = "hand"}};
  device = std::make_unique<SimulatedJoystick>(profile, options.hand, motion);
  return device;
}

/// The profile to simulate where the choice does not say one.
Result<DeviceProfile> profile_named(const std::string& name, std::span<const DeclaredDevice> declared,
                                    std::span<const TrustedDevice> trusted) {
  for (const DeclaredDevice& each : declared)
    if (each.profile.name == name) return each.profile;
  for (const TrustedDevice& each : trusted)
    if (each.profile().name == name) return each.profile();
  std::vector<std::string> names;
  for (const DeclaredDevice& each : declared) names.push_back(each.profile.name);
  for (const TrustedDevice& each : trusted) names.push_back(each.profile().name);
  Error unknown{Code::unknown_device,
                "there is no device `" + visible_text(name) + "`",
                "there are",
                {.name = "built_for", .text = name}};
  unknown.nearest = closest_names(name, names);
  for (const std::string& each : names) unknown.mend += (&each == &names.front() ? " `" : ", `") + each + "`";
  return unknown;
}

}  // namespace

std::vector<DeviceInfo> devices(const TrustedDevices& trusted, std::span<const DeclaredDevice> declared) {
  std::vector<DeviceInfo> all;
  const auto known = all_of(trusted);
  if (!known) return all;
  const Connections connections = Connections::open();
  for (const PluggedIn& each : plugged_in(connections, pointer_driver_name)) all.push_back(info_of(each, *known));
  std::set<std::string> named;  // of two declarations of one name the first counts
  const auto add = [&](const DeviceProfile& profile) {
    if (named.insert(profile.name).second)
      all.push_back({.spelling = "simulated:" + profile.name,
                     .kind = DeviceKind::simulated,
                     .name = profile.name,
                     .profile = profile});
  };
  for (const DeclaredDevice& each : declared) add(each.profile);
  for (const TrustedDevice& each : *known) add(each.profile());
  return all;
}

Result<std::unique_ptr<Device>> open_device(std::string_view spelling, const OpenOptions& options) {
  if (auto name = is_name_text("spelling", spelling, spelling_mend); !name) return std::move(name.error());
  if (!options.built_for.empty())
    if (auto name = is_name_text("built_for", options.built_for, device_name_mend); !name)
      return std::move(name.error());
  if (!options.transport.empty())
    if (auto name = is_name_text("transport", options.transport, transport_mend); !name)
      return std::move(name.error());
  if (auto sound = is_sound(options); !sound) return std::move(sound.error());
  const auto trusted = all_of(options.trusted.value_or(TrustedDevices()));
  if (!trusted) return trusted.error();
  const DeviceRequest request{.spelling = std::string(spelling),
                              .built_for = options.built_for,
                              .transport = options.transport,
                              .by_call = true};
  const bool is_simulated = spelling.starts_with("simulated");
  std::optional<Connections> connections;
  std::vector<PluggedIn> plugged;
  if (!is_simulated) {
    connections = Connections::open();
    plugged = plugged_in(*connections, spelling);
  }
  auto choice = choose_device(request, options.declared, *trusted, plugged);
  if (!choice) {
    Error error = std::move(choice.error());
    if (error.code == Code::absent_device && !connections->usb)
      error.sentence += ", and " + connections->usb.error().sentence;
    return error;
  }
  if (!choice->plugged) {
    if (!options.transport.empty())
      return Error{Code::malformed_value,
                   "a simulated device is not driven by `" + options.transport + "`",
                   "leave it out, or choose a real device",
                   {.name = "transport", .text = options.transport}};
    const std::string name = options.built_for.empty() ? default_device : options.built_for;
    const Result<DeviceProfile> profile =
        choice->declared ? Result<DeviceProfile>(choice->declared->profile)
                         : profile_named(name, options.declared, *trusted);
    if (!profile) return profile.error();
    auto simulated = simulation(*profile, options);
    if (!simulated) return simulated;
    std::unique_ptr<Device> device = *std::move(simulated);
    if (options.max_force < HUGE_VAL) device = std::make_unique<LimitedDevice>(std::move(device), options.max_force);
    return std::make_unique<DeviceAtHome>(std::move(device), options.max_force);
  }
  if (choice->plugged->driver->is_felt && !options.trusted && has_owners_file())
    return Error{Code::untrusted_device,
                 "the owner of this account declares devices, which the runtime alone cannot read",
                 "open it by `Library::open_device`, or hand over `TrustedDevices{}` to disregard them",
                 {.name = "trusted"}};
  auto opened = open_device(*connections, *choice,
                            DeviceOptions{.priority = options.priority.value_or(0),
                                          .ask = options.ask,
                                          .transport = options.transport,
                                          .most_newton = options.max_force,
                                          .keeper = {.program = options.keeper}});
  if (!opened) {
    Error error = std::move(opened.error());
    if (error.place.name == "--transport") error.place.name = "transport";
    return error;
  }
  return std::make_unique<DeviceAtHome>(*std::move(opened), options.max_force);
}

}  // namespace wale
