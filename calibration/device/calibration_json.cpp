#include "calibration/device/calibration_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace wale {
namespace {

using Json = nlohmann::ordered_json;
using analysis::Coefficient;

/// Null for what is no number, which JSON does not have.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json figure_json(const Coefficient& of, double least = -HUGE_VAL) {
  return {{"value", number(of.value)}, {"low", number(std::max(least, of.low()))}, {"high", number(of.high())}};
}

Json way_json(const WayFit& fit, double peak) {
  Json json = {{"way", in_words(fit.way)},
               {"readings", fit.readings},
               {"commands", fit.commands},
               {"gain", figure_json(fit.gain)},
               {"dead_band_newton", figure_json(fit.dead_band, 0)},
               {"quadratic", fit.bends > 0 ? figure_json(fit.quadratic) : Json(nullptr)},
               {"cubic", fit.bends > 1 ? figure_json(fit.cubic) : Json(nullptr)},
               {"saturation_newton", fit.most ? figure_json(*fit.most) : Json(nullptr)},
               {"greatest_command_newton", fit.greatest_command},
               {"zero_newton", figure_json(fit.offset)},
               {"residual_newton", fit.deviation},
               {"greatest_residual_newton", fit.greatest_residual},
               {"greatest_residual_share", fit.greatest_residual / peak},
               {"lack_of_fit_p", fit.lack_of_fit ? number(*fit.lack_of_fit) : Json(nullptr)},
               {"heating_share", fit.drift ? figure_json(*fit.drift) : Json(nullptr)},
               {"residuals_newton", Json::array()}};
  for (const double each : fit.residuals) json["residuals_newton"].push_back(number(each));
  return json;
}

Json handle_json(const DeviceCalibration& calibration, std::size_t axis) {
  Json json = {{"axis", axis == 0 ? "x" : "y"}};
  if (const auto& fit = calibration.handle[axis]) {
    json["stretches"] = fit->windows;
    json["mass_kg"] = figure_json(fit->mass), json["damping_newton_second_per_m"] = figure_json(fit->damping);
    json["friction_newton"] = figure_json(fit->friction), json["delay_s"] = figure_json(fit->delay, 0);
    json["residual_newton"] = number(fit->deviation);
  } else {
    json["problem"] = calibration.handle_problem[axis];
  }
  return json;
}

}  // namespace

Json calibration_json(const DeviceCalibration& calibration, const DeviceProfile& profile) {
  Json json = {{"ways", Json::array()}, {"handle", Json::array()}, {"rest", Json::array()}};
  for (const auto& fit : calibration.ways)
    if (fit) json["ways"].push_back(way_json(*fit, profile.force_newton));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (calibration.handle[axis] || !calibration.handle_problem[axis].empty())
      json["handle"].push_back(handle_json(calibration, axis));
    const int steps = calibration.smallest_steps[axis];
    if (!calibration.noise && steps <= 0) continue;
    json["rest"].push_back(
        {{"axis", axis == 0 ? "x" : "y"},
         {"noise_counts", calibration.noise ? number(calibration.noise->deviation[axis]) : Json(nullptr)},
         {"smallest_step_counts", steps > 0 ? Json(steps) : Json(nullptr)},
         {"smallest_step_m", steps > 0 ? Json(profile.position_step() * steps) : Json(nullptr)}});
  }
  return json;
}

}  // namespace wale
