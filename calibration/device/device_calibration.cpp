#include "calibration/device/device_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/text/readable.hpp"

namespace wale {
namespace {

using analysis::Coefficient;

constexpr double questionable_gain = 1.5;  // times the declared one
constexpr double kilogram_force = 9.80665;

std::string interval_name(const char* key, Way way, const char* part = "") {
  return fmt::format("{} {}{}{}", key, in_words(way), *part != '\0' ? " " : "", part);
}

/// Removes the interval of a figure, and adds the new one.
void set_interval(DeclaredDevice& device, const std::string& figure, double low, double high) {
  std::erase_if(device.intervals, [&](const FigureInterval& each) { return each.figure == figure; });
  if (std::isfinite(low) && std::isfinite(high)) device.intervals.push_back({figure, low, high});
}

void forget(std::vector<std::string>& settings, const std::string& key) { std::erase(settings, key); }

void enter_ways(DeclaredDevice& device, const DeviceCalibration& calibration) {
  DeviceWiring& wiring = device.wiring;
  std::array<double, 4> gains{};
  for (const Way way : all_ways) {
    const auto i = static_cast<std::size_t>(way);
    ForceResponse& response = wiring.response[i];
    const auto& fit = calibration.ways[i];
    gains[i] = fit ? fit->gain.value : wiring.gain[i / 2] * response.gain;
    if (!fit) continue;
    const double gain = response.gain;
    response = fit->response();
    response.gain = gain;
    const auto enter = [&](const std::string& figure, const Coefficient& of, double least = -HUGE_VAL) {
      set_interval(device, figure, std::max(least, of.low()), of.high());
    };
    enter(interval_name("gain", way), fit->gain);
    enter(interval_name("dead_band", way), fit->dead_band, 0);
    std::erase_if(device.intervals, [&](const FigureInterval& each) {
      return each.figure.starts_with(interval_name("nonlinearity", way)) ||
             each.figure == interval_name("saturation", way);
    });
    if (fit->bends > 0) enter(interval_name("nonlinearity", way, "quadratic"), fit->quadratic);
    if (fit->bends > 1) enter(interval_name("nonlinearity", way, "cubic"), fit->cubic);
    if (fit->most) enter(interval_name("saturation", way), *fit->most);
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto& forward = calibration.ways[2 * axis];
    const auto& backward = calibration.ways[2 * axis + 1];
    if (!forward && !backward) continue;
    const double a = gains[2 * axis], b = gains[2 * axis + 1];
    wiring.gain[axis] = a == b ? a : (a + b) / 2;
    wiring.response[2 * axis].gain = a == b ? 1 : a / wiring.gain[axis];
    wiring.response[2 * axis + 1].gain = a == b ? 1 : b / wiring.gain[axis];
    if (!forward || !backward) continue;
    const Coefficient offset = axis_offset(*forward, *backward);
    const double most = AxisResponse::most_offset * device.profile.force_newton;
    // An offset that may well be none is none: nothing is commanded against the noise of a gauge.
    const bool is_plain = offset.low() > 0 || offset.high() < 0;
    wiring.offset[axis] = is_plain ? std::clamp(offset.value, -most, most) : 0;
    set_interval(device, interval_name("offset", all_ways[2 * axis]), offset.low(), offset.high());
  }
  forget(device.unknown, "gain");
  forget(device.assumed, "gain");
}

/// One figure of the handle for both axes: their mean, within an interval that holds both of theirs.
struct OfBothAxes {
  double value = 0, low = 0, high = 0;
};

std::optional<OfBothAxes> of_both_axes(const DeviceCalibration& calibration, Coefficient HandleFit::*figure) {
  std::optional<OfBothAxes> both;
  int count = 0;
  for (const auto& fit : calibration.handle) {
    if (!fit) continue;
    const Coefficient& of = *fit.*figure;
    if (!both) both = OfBothAxes{0, of.low(), of.high()};
    both->value += of.value;
    both->low = std::min(both->low, of.low());
    both->high = std::max(both->high, of.high());
    ++count;
  }
  if (both) {
    both->value = std::max(0.0, both->value / count);
    both->low = std::max(0.0, both->low);
    both->high = std::max(both->value, both->high);
  }
  return both;
}

void enter_handle(DeclaredDevice& device, const DeviceCalibration& calibration) {
  DeviceProfile& profile = device.profile;
  const auto enter = [&](const char* key, Coefficient HandleFit::*figure, double& into, bool* known) {
    const auto both = of_both_axes(calibration, figure);
    if (!both) return;
    into = both->value;
    set_interval(device, key, both->low, both->high);
    forget(device.unknown, key);
    forget(device.assumed, key);
    if (known != nullptr) *known = true;
  };
  enter("mass", &HandleFit::mass, profile.mass, nullptr);
  enter("damping", &HandleFit::damping, profile.damping, &profile.damping_known);
  enter("friction", &HandleFit::friction, profile.friction, &profile.friction_known);
  double* const delays[] = {&profile.delay_x, &profile.delay_y};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!calibration.handle[axis]) continue;
    const Coefficient& delay = calibration.handle[axis]->delay;
    *delays[axis] = std::max(0.0, delay.value);
    set_interval(device, axis == 0 ? "delay x" : "delay y", std::max(0.0, delay.low()), std::max(0.0, delay.high()));
    forget(device.unknown, "delay");
    forget(device.assumed, "delay");
  }
}

/// "0.921, 0.915 to 0.927"
std::string with_interval(const Coefficient& of, const char* unit, double scale = 1, double least = -HUGE_VAL) {
  return readable("{:.4g}{}, {:.4g} to {:.4g}", scale * of.value, unit, scale * std::max(least, of.low()),
                  scale * of.high());
}

std::string way_text(const WayFit& fit, double peak) {
  std::string text = readable("{}: {} readings at {} commands\n", in_words(fit.way), fit.readings, fit.commands);
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<14} {}\n", name, value);
  };
  line("gain", with_interval(fit.gain, ""));
  line("dead band", with_interval(fit.dead_band, " N", 1, 0));
  if (fit.bends > 0) line("quadratic", with_interval(fit.quadratic, ""));
  if (fit.bends > 1) line("cubic", with_interval(fit.cubic, ""));
  if (fit.bends < 2)
    line("non-linearity", fit.bends == 0 ? "not measured: too few commands" : "no cubic: too few commands");
  line("saturation",
       fit.most ? with_interval(*fit.most, " N") : readable("none up to a command of {:.4g} N", fit.greatest_command));
  line("zero", with_interval(fit.offset, " N"));
  line("residuals", readable("{:.3g} N, at most {:.3g} N ({:.2g} % of the device's force)", fit.deviation,
                             fit.greatest_residual, 100 * fit.greatest_residual / peak));
  if (fit.lack_of_fit && *fit.lack_of_fit < 0.01)
    line("", readable("more than repeated readings explain (p = {:.2g}): the true curve has another shape",
                      *fit.lack_of_fit));
  if (fit.drift) line("heating", with_interval(*fit.drift, " %", 100) + " from the first round to the last");
  return text;
}

}  // namespace

Result<DeviceCalibration> fit_readings(const std::vector<GaugeReading>& readings, double peak) {
  DeviceCalibration calibration;
  if (readings.empty())
    return Error{.code = Code::not_measured,
                 .sentence = "there are no readings",
                 .mend = "measure at least one way, at commands from 0 N to the device's force"};
  for (const Way way : all_ways) {
    std::vector<GaugeReading> of_way;
    std::ranges::copy_if(readings, std::back_inserter(of_way),
                         [&](const GaugeReading& each) { return each.way == way; });
    if (of_way.empty()) continue;
    auto fit = fit_way(of_way, peak);
    if (!fit) return std::move(fit.error());
    calibration.ways[static_cast<std::size_t>(way)] = *std::move(fit);
  }
  return calibration;
}

std::string GainQuestion::text() const {
  return readable(
      "{}: the declared gain is {:.4g}, and the readings say {:.4g}, {:.3g} times as much; gram-force typed as "
      "newton would be {:.0f} times",
      in_words(way), declared, measured, measured / declared, 1000 / kilogram_force);
}

std::vector<GainQuestion> gain_questions(const DeclaredDevice& declared, const DeviceCalibration& calibration) {
  std::vector<GainQuestion> questions;
  for (const Way way : all_ways) {
    const auto i = static_cast<std::size_t>(way);
    if (!calibration.ways[i]) continue;
    const double before = declared.wiring.gain[i / 2] * declared.wiring.response[i].gain;
    const double now = calibration.ways[i]->gain.value, ratio = now / before;
    if (ratio > questionable_gain || ratio < 1 / questionable_gain) questions.push_back({way, before, now});
  }
  return questions;
}

DeclaredDevice calibrated(DeclaredDevice declared, const DeviceCalibration& calibration) {
  if (std::ranges::any_of(calibration.ways, [](const auto& fit) { return fit.has_value(); }))
    enter_ways(declared, calibration);
  enter_handle(declared, calibration);
  return declared;
}

std::string calibration_text(const DeviceCalibration& calibration, const DeviceProfile& profile) {
  std::string text = "each figure, and its 95 % interval\n";
  for (const auto& fit : calibration.ways)
    if (fit) text += way_text(*fit, profile.force_newton);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const char* name = axis == 0 ? "x" : "y";
    if (const auto& fit = calibration.handle[axis])
      text += fmt::format(
          "the handle along {}, by {} stretches of its motion\n"
          "  mass           {}\n  damping        {}\n  friction       {}\n  delay          {}\n",
          name, fit->windows, with_interval(fit->mass, " kg"), with_interval(fit->damping, " N s/m"),
          with_interval(fit->friction, " N"), with_interval(fit->delay, " ms", 1e3, 0));
    else if (!calibration.handle_problem[axis].empty())
      text += fmt::format("the handle along {}: {}\n", name, calibration.handle_problem[axis]);
  }
  if (calibration.noise)
    text += readable("positions at rest scatter by {:.2g} and {:.2g} counts (x, y)\n", calibration.noise->deviation[0],
                     calibration.noise->deviation[1]);
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (calibration.smallest_steps[axis] > 0)
      text += readable("positions along {} change by {} count{} at least, {:.3g} mm\n", axis == 0 ? "x" : "y",
                       calibration.smallest_steps[axis], calibration.smallest_steps[axis] == 1 ? "" : "s",
                       1e3 * profile.position_step() * calibration.smallest_steps[axis]);
  return text;
}

}  // namespace wale
