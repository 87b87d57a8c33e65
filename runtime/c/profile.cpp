#include "runtime/c/profile.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "runtime/c/sized.hpp"
#include "runtime/device/shipped_devices.hpp"
#include "runtime/machine/verify_figures.hpp"
#include "runtime/stage/device_figures.hpp"
#include "schema/closest_names.hpp"
#include "schema/sentence.hpp"
#include "schema/visible_text.hpp"

namespace wale::c {
namespace {

constexpr double most_delay = 1;  ///< s; nothing can be felt as one with more

/// Where a figure stands in both interfaces.
struct Figure {
  const char* name;
  double WaleProfile::*in_c;
  double DeviceProfile::*in_cpp;
  double most = HUGE_VAL;  ///< beyond any device, where the loop's own work or memory grows with the figure
};

constexpr Figure all_figures[] = {
    {"workspace_diameter", &WaleProfile::workspace_diameter, &DeviceProfile::workspace_diameter},
    {"position_counts", &WaleProfile::position_counts, &DeviceProfile::position_counts},
    {"force", &WaleProfile::force, &DeviceProfile::force_newton},
    {"force_counts", &WaleProfile::force_counts, &DeviceProfile::force_counts},
    {"rate", &WaleProfile::rate, &DeviceProfile::rate},
    {"speed_limit", &WaleProfile::speed_limit, &DeviceProfile::speed_limit},
    {"slew", &WaleProfile::slew, &DeviceProfile::slew},
    {"continuous_force", &WaleProfile::continuous_force, &DeviceProfile::continuous_newton},
    {"heating_seconds", &WaleProfile::heating_seconds, &DeviceProfile::heating_seconds},
    {"active_power", &WaleProfile::active_power, &DeviceProfile::active_watt},
    {"velocity_window", &WaleProfile::velocity_window, &DeviceProfile::velocity_window, most_velocity_window},
    {"velocity_noise_counts", &WaleProfile::velocity_noise_counts, &DeviceProfile::velocity_noise_counts},
    {"patch_width", &WaleProfile::patch_width, &DeviceProfile::patch_width},
    {"patch_height", &WaleProfile::patch_height, &DeviceProfile::patch_height},
    {"patch_rim", &WaleProfile::patch_rim, &DeviceProfile::patch_rim},
    {"mass", &WaleProfile::mass, &DeviceProfile::mass},
    {"damping", &WaleProfile::damping, &DeviceProfile::damping},
    {"friction", &WaleProfile::friction, &DeviceProfile::friction},
    {"delay_x", &WaleProfile::delay_x, &DeviceProfile::delay_x, most_delay},
    {"delay_y", &WaleProfile::delay_y, &DeviceProfile::delay_y, most_delay},
    {"bandwidth_x", &WaleProfile::bandwidth_x, &DeviceProfile::bandwidth_x},
    {"bandwidth_y", &WaleProfile::bandwidth_y, &DeviceProfile::bandwidth_y},
};
static_assert(sizeof(WaleProfile) ==
              sizeof(size_t) + sizeof(WaleText) + sizeof(double) * std::size(all_figures) + 2 * sizeof(int32_t));

/// What shakes the pads whose profiles were given out: it is in no struct. A process gives out the profiles of few pads.
class Shakers {
 public:
  void remember(const DeviceProfile& profile) {
    const std::lock_guard lock(mutex_);
    const auto known = std::ranges::find(pads_, profile);
    if (known == pads_.end())
      pads_.push_back(profile);
    else
      std::rotate(known, known + 1, pads_.end());
    if (pads_.size() > most) pads_.erase(pads_.begin());
  }
  /// Of the last pad that was given out with these figures, or else of the last one of that name.
  std::optional<Shaker> of(const DeviceProfile& figures) const {
    const std::lock_guard lock(mutex_);
    std::optional<Shaker> found;
    for (auto each = pads_.rbegin(); each != pads_.rend(); ++each) {
      if (each->name != figures.name) continue;
      if (!found) found = each->shaker;
      DeviceProfile same = *each;
      same.shaker = figures.shaker;
      if (same == figures) return each->shaker;
    }
    return found;
  }

 private:
  static constexpr std::size_t most = 1000;
  mutable std::mutex mutex_;
  std::vector<DeviceProfile> pads_;
};

Shakers& shakers() {
  static Shakers all;
  return all;
}

/// What shakes the shipped pad of that name, or the pad whose profile was given out.
Result<Shaker> shaker_of(const DeviceProfile& figures) {
  if (auto known = shakers().of(figures)) return *std::move(known);
  const auto& shipped = shipped_devices();
  if (shipped)
    for (const DeclaredDevice& each : *shipped)
      if (each.profile.name == figures.name && each.profile.shaker) return *each.profile.shaker;
  return about_argument("profile", "expected the profile of a pad, as a call gave it: what shakes it is not in it",
                        "ask wale_profile or wale_library_profile for it by its name");
}

}  // namespace

WaleProfile figures_of(const DeviceProfile& profile) {
  WaleProfile figures{
      .name = text_of(profile.name), .vibrates = profile.shaker.has_value(), .has_position = profile.has_position()};
  for (const Figure& each : all_figures) figures.*each.in_c = profile.*each.in_cpp;
  if (profile.shaker) shakers().remember(profile);
  return figures;
}

Result<DeviceProfile> read_profile(const WaleProfile* profile) {
  if (auto given = is_given("profile", profile); !given) return std::move(given).error();
  const auto given = read_sized("profile", profile);
  if (!given) return given.error();
  auto name = read_name("name", given->name, device_name_mend);
  if (!name) return std::move(name).error();
  DeviceProfile read{.name = *std::move(name)};
  for (const Figure& each : all_figures) {
    const double figure = (*given).*each.in_c;
    if (!(figure >= 0 && figure < HUGE_VAL))
      return about_argument(each.name, "expected a finite figure that is not negative",
                            "0 is one that is not declared");
    if (figure > each.most)
      return about_argument(each.name, sentence("expected at most ", each.most, ", found ", figure),
                            "give it in the unit that wale/device.h states");
    read.*each.in_cpp = figure;
  }
  if (!(read.rate >= DeviceProfile::least_rate && read.rate <= DeviceProfile::most_rate))
    return about_argument("rate", "expected 100 to 10000 ticks per second", "give it in Hz");
  const auto vibrates = read_flag("vibrates", given->vibrates);
  if (!vibrates) return vibrates.error();
  if (*vibrates) {
    auto shaker = shaker_of(read);
    if (!shaker) return std::move(shaker).error();
    read.shaker = *std::move(shaker);
  } else if (const auto placed = read_flag("has_position", given->has_position); !placed || !*placed) {
    if (!placed) return placed.error();
    return about_argument("has_position", "a device that pushes has a position", "give 1");
  }
  if (auto sound = check_declared_figures(read); !sound) {
    Error error = std::move(sound).error();
    error.code = Code::malformed_value;
    return error;
  }
  return read;
}

Result<> give_profile(const std::vector<DeclaredDevice>& declared, WaleText name, WaleProfile* to) {
  const auto wanted = read_name("name", name, device_name_mend);
  if (!wanted) return wanted.error();
  std::vector<std::string> names;
  for (const DeclaredDevice& each : declared) {
    if (each.profile.name == *wanted) {
      write_sized(to, figures_of(each.profile));
      return {};
    }
    names.push_back(each.profile.name);
  }
  Error unknown =
      about_argument("name", "no device is called `" + visible_text(*wanted) + "`", "there are", Code::unknown_device);
  unknown.place.text = *wanted;
  unknown.nearest = closest_names(*wanted, names);
  for (const std::string& each : names) unknown.mend += (&each == &names.front() ? " `" : ", `") + each + "`";
  return unknown;
}

}  // namespace wale::c
