#include "runtime/stage/device_figures.hpp"

#include <array>
#include <utility>

#include "runtime/machine/verify_figures.hpp"
#include "schema/sentence.hpp"

namespace wale {
namespace {

/// A figure that is checked only if it is declared, and a value in its range.
struct Undeclared {
  double DeviceProfile::*figure;
  double value;
};
constexpr std::array<Undeclared, 3> of_a_position{{{&DeviceProfile::workspace_diameter, 0.1},
                                                   {&DeviceProfile::position_counts, 1000},
                                                   {&DeviceProfile::speed_limit, 1}}};
constexpr std::array<Undeclared, 2> of_a_force{{{&DeviceProfile::force_newton, 1000}, {&DeviceProfile::force_counts, 1000}}};

Error unusable(const DeviceProfile& profile, std::string name, std::string what, std::string mend) {
  return {.code = Code::unusable_device,
          .sentence = "the device" + (profile.name.empty() ? ", whose profile has no name," : " " + profile.name) + what,
          .mend = std::move(mend),
          .place = {.name = std::move(name)}};
}

}  // namespace

Result<> check_declared_figures(const DeviceProfile& profile) {
  DeviceProfile whole = profile;
  const auto fill = [&whole](const auto& figures) {
    for (const auto& [figure, value] : figures)
      if (whole.*figure == 0) whole.*figure = value;
  };
  if (whole.has_position()) fill(of_a_position);
  if (!whole.shaker) fill(of_a_force);
  if (whole.rate == 0) whole.rate = DeviceProfile::least_rate;
  RefusedFigure refused;
  try {
    verify_device(whole, &refused);
  } catch (const Error& error) {
    Error unfit = unusable(profile, refused.name.empty() ? "vibration" : std::string(refused.name),
                           " cannot be used: " + error.sentence, "give its profile a figure in this range");
    if (refused.name.empty()) return unfit;
    unfit.expected = sentence(refused.low, " .. ", refused.high);
    unfit.found = unfit.place.text = sentence(refused.value);
    return unfit;
  }
  return {};
}

namespace {

/// `of_loops`: with the figures that only a new run needs.
Result<> check_needed(const DeviceProfile& profile, bool of_loops) {
  struct Figure {
    const char* name;
    double value;
    bool needed;
  };
  const bool place = profile.has_position(), push = !profile.shaker;
  const Figure figures[] = {{"rate", profile.rate, true},
                            {"workspace", profile.workspace_diameter, place},
                            {"position counts", profile.position_counts, place},
                            {"force", profile.force_newton, push},
                            {"force counts", profile.force_counts, push},
                            {"acceleration", profile.most(), !push},
                            {"speed limit", profile.speed_limit, place && of_loops},
                            {"slew", profile.slew, push && of_loops}};
  for (const Figure& each : figures) {
    if (!each.needed || each.value != 0) continue;
    const std::string what = std::string("positive ") + each.name;
    Error error = unusable(profile, each.name, " declares no " + what, "give its profile this figure, in SI units");
    error.expected = "a " + what;
    error.found = error.place.text = "0";
    return error;
  }
  return check_declared_figures(profile);
}

}  // namespace

Result<> check_figures(const DeviceProfile& profile) { return check_needed(profile, true); }

Result<> check_recorded_figures(const DeviceProfile& profile) { return check_needed(profile, false); }

}  // namespace wale
