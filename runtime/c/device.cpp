#include "runtime/c/device.hpp"

#include <cmath>
#include <optional>
#include <span>

#include "runtime/c/profile.hpp"
#include "runtime/c/program.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/device/shipped_devices.hpp"

struct WaleDevices {
  std::vector<wale::DeviceInfo> all;
  std::vector<std::unique_ptr<WaleError>> obstacles;  // null where there is none
  std::vector<std::string> holders;
};

namespace wale::c {
namespace {

Result<std::optional<Motion>> trace_of(const WaleDeviceOptions& given) {
  constexpr std::size_t most_points = std::size_t{1} << 28;
  if (given.points == nullptr || given.count == 0 || given.count > most_points)
    return about_argument("points", "expected a row of time, x and y at least", "give `count` rows of three numbers");
  Trace trace;
  trace.points.reserve(given.count);
  for (std::size_t i = 0; i < given.count; ++i) {
    const double* row = given.points + 3 * i;
    trace.points.push_back({.time = row[0], .position = {row[1], row[2]}});
  }
  // As in a file without velocities: the slope over both neighbours.
  for (std::size_t i = 0; i < given.count; ++i) {
    const TracePoint& before = trace.points[i > 0 ? i - 1 : 0];
    const TracePoint& after = trace.points[i + 1 < given.count ? i + 1 : i];
    if (after.time > before.time)
      trace.points[i].velocity = (after.position - before.position) / (after.time - before.time);
  }
  return std::optional<Motion>(std::move(trace));
}

/// Nothing where the options name no motion.
Result<std::optional<Motion>> motion_of(const WaleDeviceOptions& given) {
  const glm::dvec2 centre{given.centre_x, given.centre_y};
  const double length = std::hypot(given.direction_x, given.direction_y);
  const glm::dvec2 direction =
      length > 0 ? glm::dvec2{given.direction_x, given.direction_y} / length : glm::dvec2{1, 0};
  switch (given.motion) {
    case WALE_MOTION_rest:
      if (centre == glm::dvec2(0)) return std::optional<Motion>();  // as of options that are all 0
      return std::optional<Motion>(Rest{centre});
    case WALE_MOTION_hold: return std::optional<Motion>(Rest{centre});
    case WALE_MOTION_lateral:
      return std::optional<Motion>(Lateral{given.amplitude, given.frequency, centre, direction});
    case WALE_MOTION_circular: return std::optional<Motion>(Circular{given.amplitude, given.frequency, centre});
    case WALE_MOTION_press:
      return std::optional<Motion>(Press{given.amplitude, given.frequency, centre, direction});
    case WALE_MOTION_trace: return trace_of(given);
    default:
      return about_argument("motion", "expected one of WALE_MOTION_…, found " + std::to_string(given.motion),
                            "0 is a hand at rest");
  }
}

}  // namespace

Result<OpenOptions> read_options(const WaleDeviceOptions* options) {
  const auto given = read_sized("options", options);
  if (!given) return given.error();
  OpenOptions read;
  const auto built_for = read_text("built_for", given->built_for);
  if (!built_for) return built_for.error();
  const auto transport = read_text("transport", given->transport);
  if (!transport) return transport.error();
  const auto keeper = read_path("keeper", given->keeper);
  if (!keeper) return keeper.error();
  read.built_for = *built_for, read.transport = *transport, read.keeper = *keeper;
  if (!std::isfinite(given->max_force))
    return about_argument("max_force", "expected a finite number", "0 sets no limit");
  if (given->max_force != 0) read.max_force = given->max_force;
  if (given->priority != 0) read.priority = given->priority;
  const auto disregard = read_flag("disregard_owner", given->disregard_owner);
  if (!disregard) return disregard.error();
  if (*disregard) read.trusted = TrustedDevices{};
  // Also of a motion that does not use them.
  for (const auto& [name, value] :
       {std::pair{"amplitude", given->amplitude}, std::pair{"frequency", given->frequency},
        std::pair{"centre_x", given->centre_x}, std::pair{"centre_y", given->centre_y},
        std::pair{"direction_x", given->direction_x}, std::pair{"direction_y", given->direction_y}})
    if (!std::isfinite(value)) return about_argument(name, "expected a finite number", "0 is the default");
  read.hand = {given->hand_mass, given->hand_damping, given->hand_stiffness};
  auto motion = motion_of(*given);
  if (!motion) return std::move(motion).error();
  read.motion = *std::move(motion);
  return read;
}

void hand_out_devices(std::vector<DeviceInfo> devices, WaleDevices** to) {
  auto list = std::make_unique<WaleDevices>();
  list->all = std::move(devices);
  for (const DeviceInfo& each : list->all) {
    list->obstacles.push_back(each.obstacle ? handle_of(*each.obstacle) : nullptr);
    std::string& holders = list->holders.emplace_back();
    for (const std::string& holder : each.held_by) holders += (holders.empty() ? "" : ", ") + holder;
  }
  hand_out(std::move(list), to);
}

void hand_out_device(std::unique_ptr<Device> device, WaleDevice** to) {
  auto shared = std::make_shared<SharedDevice>();
  shared->device = std::move(device);
  hand_out(std::make_unique<WaleDevice>(WaleDevice{std::move(shared)}), to);
}

}  // namespace wale::c

using namespace wale::c;

WaleCode wale_devices(WaleDevices** devices, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("devices", devices); !clear) return clear;
    hand_out_devices(wale::devices(), devices);
    return {};
  });
}

void wale_devices_free(WaleDevices* devices) { free_handle(devices); }

size_t wale_devices_count(const WaleDevices* devices) { return devices == nullptr ? 0 : devices->all.size(); }

WaleCode wale_devices_info(const WaleDevices* devices, size_t index, WaleDeviceInfo* info, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("devices", devices); !given) return given;
    if (auto sized = is_sized("info", info); !sized) return sized;
    if (auto there = is_there(index, devices->all.size()); !there) return there;
    const wale::DeviceInfo& known = devices->all[index];
    write_sized(info, {.spelling = text_of(known.spelling),
                       .name = text_of(known.name),
                       .numbers = text_of(known.numbers),
                       .profile = known.profile ? text_of(known.profile->name) : text_of({}),
                       .can = text_of(known.can),
                       .held_by = text_of(devices->holders[index]),
                       .obstacle = devices->obstacles[index].get(),
                       .kind = static_cast<int32_t>(known.kind),
                       .is_generic = known.is_generic});
    return {};
  });
}

WaleCode wale_profile(WaleText name, WaleProfile* profile, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto sized = is_sized("profile", profile); !sized) return sized;
    const auto& shipped = wale::shipped_devices();
    return shipped ? give_profile(*shipped, name, profile) : shipped.error();
  });
}

WaleCode wale_device_open(WaleText spelling, const WaleDeviceOptions* options, WaleDevice** device, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("device", device); !clear) return clear;
    const auto wanted = read_text("spelling", spelling);
    if (!wanted) return wanted.error();
    const auto read = read_options(options);
    if (!read) return read.error();
    auto opened = wale::open_device(*wanted, *read);
    if (!opened) return std::move(opened).error();
    hand_out_device(*std::move(opened), device);
    return {};
  });
}

void wale_device_free(WaleDevice* device) { free_handle(device); }

WaleCode wale_device_profile(const WaleDevice* device, WaleProfile* profile, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("device", device); !given) return given;
    if (auto sized = is_sized("profile", profile); !sized) return sized;
    write_sized(profile, figures_of(device->shared->device->profile()));
    return {};
  });
}
