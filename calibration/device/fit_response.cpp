#include "calibration/device/fit_response.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "calibration/analysis/distributions.hpp"
#include "compiler/text/readable.hpp"
#include "wale/device_wiring.hpp"

namespace wale {
namespace {

using analysis::Coefficient;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t fewest_readings = 8, fewest_commands = 5;
constexpr double chance_of_saturation = 1e-3;

/// The places of the parameters: those of the bends and of the saturation may be missing.
enum Parameter { gain_at, band_at, offset_at, quadratic_at, cubic_at, most_at, parameters };

/// Which parameters a model has, and from which command on it saturates.
struct Model {
  int bends = 2;
  double saturates_from = HUGE_VAL;  ///< N of command

  bool saturates() const { return saturates_from < HUGE_VAL; }
  /// The parameters that it fits, by their places.
  std::vector<int> free() const {
    std::vector<int> all{gain_at, band_at, offset_at};
    if (bends > 0) all.push_back(quadratic_at);
    if (bends > 1) all.push_back(cubic_at);
    if (saturates()) all.push_back(most_at);
    return all;
  }
};

struct Fitted {
  Model model;
  VectorXd at = VectorXd::Zero(parameters);
  double squares = HUGE_VAL;
};

/// The readings as columns.
struct Columns {
  VectorXd command, newton;
  double peak = 1;
};

double predicted(const Model& model, const VectorXd& at, double command, double peak) {
  if (command >= model.saturates_from) return at[offset_at] + at[most_at];
  const double u = std::max(0.0, command - at[band_at]), s = u / peak;
  return at[offset_at] + at[gain_at] * u * (1 + at[quadratic_at] * (s - 1) + at[cubic_at] * (s * s - 1));
}

VectorXd residuals_of(const Columns& data, const Model& model, const VectorXd& at) {
  VectorXd residuals(data.command.size());
  for (Index i = 0; i < residuals.size(); ++i)
    residuals[i] = data.newton[i] - predicted(model, at, data.command[i], data.peak);
  return residuals;
}

/// Derivatives of the predictions by the free parameters.
MatrixXd jacobian(const Columns& data, const Model& model, const VectorXd& at) {
  const std::vector<int> free = model.free();
  MatrixXd all = MatrixXd::Zero(data.command.size(), parameters);
  for (Index i = 0; i < all.rows(); ++i) {
    all(i, offset_at) = 1;
    if (data.command[i] >= model.saturates_from) {
      all(i, most_at) = 1;
      continue;
    }
    const double u = data.command[i] - at[band_at], s = u / data.peak;
    if (!(u > 0)) continue;
    all(i, gain_at) = u * (1 + at[quadratic_at] * (s - 1) + at[cubic_at] * (s * s - 1));
    all(i, band_at) = -at[gain_at] * (1 + at[quadratic_at] * (2 * s - 1) + at[cubic_at] * (3 * s * s - 1));
    all(i, quadratic_at) = at[gain_at] * u * (s - 1);
    all(i, cubic_at) = at[gain_at] * u * (s * s - 1);
  }
  MatrixXd chosen(all.rows(), static_cast<Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) chosen.col(static_cast<Index>(i)) = all.col(free[i]);
  return chosen;
}

/// The best fit with this dead band: all other parameters enter linearly.
Fitted with_band(const Columns& data, const Model& model, double band) {
  Fitted fitted{.model = model};
  fitted.at[band_at] = band;
  fitted.at[gain_at] = 1;
  Model rest = model;
  const std::vector<int> free = rest.free();
  // With a gain of 1 and no bends, the derivatives are the columns of the linear problem in gain, gain * bends.
  MatrixXd columns = jacobian(data, model, fitted.at);
  columns.col(band_at).setZero();
  const VectorXd solved = columns.completeOrthogonalDecomposition().solve(data.newton);
  for (std::size_t i = 0; i < free.size(); ++i)
    if (free[i] != band_at) fitted.at[free[i]] = solved[static_cast<Index>(i)];
  if (!(std::abs(fitted.at[gain_at]) > 0)) return fitted;
  for (const int bend : {quadratic_at, cubic_at}) fitted.at[bend] /= fitted.at[gain_at];
  fitted.squares = residuals_of(data, model, fitted.at).squaredNorm();
  return fitted;
}

/// The least squares by Gauss and Newton from a start nearby, with steps that are halved while they gain nothing.
Fitted refined(const Columns& data, Fitted best) {
  const std::vector<int> free = best.model.free();
  constexpr int most_steps = 30;
  for (int step = 0; step < most_steps; ++step) {
    const MatrixXd slopes = jacobian(data, best.model, best.at);
    const VectorXd move = slopes.completeOrthogonalDecomposition().solve(residuals_of(data, best.model, best.at));
    bool gains = false;
    for (double share = 1; share > 1e-4 && !gains; share /= 2) {
      Fitted next = best;
      for (std::size_t i = 0; i < free.size(); ++i) next.at[free[i]] += share * move[static_cast<Index>(i)];
      next.at[band_at] = std::clamp(next.at[band_at], 0.0, ForceResponse::most_dead_band * data.peak);
      next.squares = residuals_of(data, next.model, next.at).squaredNorm();
      if (!(next.squares < best.squares)) continue;
      gains = true;
      const bool is_little = best.squares - next.squares < 1e-10 * best.squares;
      best = std::move(next);
      if (is_little) return best;
    }
    if (!gains) break;
  }
  return best;
}

/// The best fit of a model: a grid of dead bands finds the valley.
Fitted fit_model(const Columns& data, const Model& model) {
  Fitted best;
  best.model = model;
  constexpr int steps = 50;
  for (int i = 0; i <= steps; ++i) {
    Fitted each = with_band(data, model, ForceResponse::most_dead_band * data.peak * i / steps);
    if (each.squares < best.squares) best = std::move(each);
  }
  return refined(data, std::move(best));
}

/// How far the 95 % interval of the dead band reaches: to where the squares of the best fit with another dead band are
/// too many by F. Where the dead band is near a reading its valley is no parabola, and the standard error alone is too
/// small.
double reach_of_band(const Columns& data, const Fitted& best, double freedom) {
  const double most = best.squares * (1 + analysis::f_quantile(0.95, 1, freedom) / freedom);
  const double widest = ForceResponse::most_dead_band * data.peak;
  double reach = 0;
  constexpr double steps = 400;
  for (const double way : {-1.0, 1.0})
    for (double step = 1; step <= steps; ++step) {
      const double band = best.at[band_at] + way * widest * step / steps;
      if (band < 0 || band > widest || with_band(data, best.model, band).squares > most) break;
      reach = std::max(reach, widest * step / steps);
    }
  return reach;
}

Error unfit(std::string sentence, std::string mend = {}) {
  return Error{.code = Code::not_measured, .sentence = std::move(sentence), .mend = std::move(mend)};
}

/// The different commands, in rising order.
std::vector<double> commands_of(const Columns& data) {
  const std::set<double> different(data.command.begin(), data.command.end());
  return {different.begin(), different.end()};
}

/// The fits that the readings allow: the best one, and the same model with a saturation that begins elsewhere.
struct Fits {
  Fitted best;
  std::vector<Fitted> others;
};

/// The best model: with a saturation where one is plain.
Fits best_fit(const Columns& data, const std::vector<double>& commands, int bends) {
  const Fitted without = fit_model(data, {.bends = bends});
  Fitted with = without;
  std::vector<Fitted> all;
  // Enough commands must remain below it for the rest of the model.
  const std::size_t least_below = static_cast<std::size_t>(3 + bends);
  for (std::size_t from = least_below; from + 2 <= commands.size(); ++from) {
    Fitted each = fit_model(data, {.bends = bends, .saturates_from = commands[from]});
    if (!(each.at[most_at] > 0)) continue;
    if (each.squares < with.squares) with = each;
    all.push_back(std::move(each));
  }
  const double freedom = static_cast<double>(data.command.size()) - static_cast<double>(with.model.free().size());
  if (!with.model.saturates() || !(freedom > 0)) return {without, {}};
  const double f = (without.squares - with.squares) / (with.squares / freedom);
  if (!(analysis::f_above(f, 1, freedom) < chance_of_saturation)) return {without, {}};
  return {std::move(with), std::move(all)};
}

/// The inverse of the normal equations at a fit.
MatrixXd inverse_at(const Columns& data, const Fitted& fit) {
  const MatrixXd slopes = jacobian(data, fit.model, fit.at);
  return (slopes.transpose() * slopes).ldlt().solve(MatrixXd::Identity(slopes.cols(), slopes.cols()));
}

/// How far the 95 % interval of each parameter reaches from the best fit, by places: over all fits whose squares are
/// not too many by F. Where it is open whether a command is saturated, both answers count.
VectorXd reaches(const Columns& data, const Fits& fits, double freedom) {
  VectorXd reach = VectorXd::Zero(parameters);
  const double most = fits.best.squares * (1 + analysis::f_quantile(0.95, 1, freedom) / freedom);
  const auto count = [&](const Fitted& each) {
    if (!(each.squares <= most)) return;
    const MatrixXd inverse = inverse_at(data, each);
    const std::vector<int> free = each.model.free();
    for (std::size_t i = 0; i < free.size(); ++i) {
      const auto at = static_cast<Index>(i);
      reach[free[i]] = std::max(reach[free[i]], std::abs(each.at[free[i]] - fits.best.at[free[i]]) +
                                                    std::sqrt((most - each.squares) * inverse(at, at)));
    }
  };
  count(fits.best);
  for (const Fitted& each : fits.others) count(each);
  return reach;
}

/// Deviation between commands against that between readings of the same one.
std::optional<double> lack_of_fit(const Columns& data, const VectorXd& residuals, std::size_t commands,
                                  std::size_t parameters_fitted) {
  std::map<double, std::pair<double, double>> sums;  // of residuals, and their number
  for (Index i = 0; i < residuals.size(); ++i) {
    auto& [sum, count] = sums[data.command[i]];
    sum += residuals[i];
    ++count;
  }
  double pure = 0;
  for (Index i = 0; i < residuals.size(); ++i) {
    const auto& [sum, count] = sums[data.command[i]];
    pure += (residuals[i] - sum / count) * (residuals[i] - sum / count);
  }
  const double within = static_cast<double>(residuals.size()) - static_cast<double>(commands);
  const double between = static_cast<double>(commands) - static_cast<double>(parameters_fitted);
  if (!(within >= 3 && between >= 1 && pure > 0)) return std::nullopt;
  return analysis::f_above(((residuals.squaredNorm() - pure) / between) / (pure / within), between, within);
}

/// The change of the force from the first round to the last, at commands that give a fifth of the greatest force.
std::optional<Coefficient> drift_of(std::span<const GaugeReading> readings, double offset) {
  double greatest = 0;
  for (const GaugeReading& each : readings) greatest = std::max(greatest, each.newton - offset);
  std::map<double, std::pair<const GaugeReading*, const GaugeReading*>> ends;
  for (const GaugeReading& each : readings) {
    if (each.newton - offset < greatest / 5) continue;
    auto& [first, last] = ends[each.command];
    if (first == nullptr || each.repeat < first->repeat) first = &each;
    if (last == nullptr || each.repeat > last->repeat) last = &each;
  }
  std::vector<double> changes;
  for (const auto& [command, pair] : ends)
    if (pair.first->repeat != pair.second->repeat)
      changes.push_back((pair.second->newton - pair.first->newton) / (pair.first->newton - offset));
  const auto count = static_cast<double>(changes.size());
  if (changes.size() < 3) return std::nullopt;
  double mean = 0, squares = 0;
  for (const double each : changes) mean += each / count;
  for (const double each : changes) squares += (each - mean) * (each - mean);
  return Coefficient{"drift", mean, std::sqrt(squares / (count - 1) / count), count - 1};
}

/// What the readings must have before anything is fitted.
std::optional<Error> too_few(const Columns& data, const std::vector<double>& commands, Way way) {
  const std::string name = in_words(way);
  if (static_cast<std::size_t>(data.command.size()) < fewest_readings || commands.size() < fewest_commands)
    return unfit(
        fmt::format("{} has {} reading{} at {} different command{}, too few for a fit", name, data.command.size(),
                    data.command.size() == 1 ? "" : "s", commands.size(), commands.size() == 1 ? "" : "s"),
        fmt::format("measure at least {} readings at {} different commands, spread from 0 N to the device's "
                    "force; twelve commands, each twice, are better",
                    fewest_readings, fewest_commands));
  if (commands.front() > 0)
    return unfit(
        fmt::format("{} has no reading at a command of 0 N, so its dead band cannot be told from the gauge's zero",
                    name),
        "add what the gauge shows without a command, at least once in each way");
  return std::nullopt;
}

/// The first of the figures that the loader of declarations would refuse.
std::optional<Error> absurd(const WayFit& fit, double peak) {
  const std::string name = in_words(fit.way);
  const double gain = fit.gain.value;
  if (!(gain > 0))
    return unfit(fmt::format("{} does not push harder with a greater command: {}", name,
                             readable("its gain would be {:.3g}", gain)),
                 "check the sign of the readings: each is positive if the handle is pushed in the way of its row");
  if (!(gain >= DeviceWiring::least_gain && gain <= DeviceWiring::most_gain))
    return unfit(readable("{} would have a gain of {:.4g}, and no device has one outside {:g} .. {:g}", name, gain,
                          DeviceWiring::least_gain, DeviceWiring::most_gain),
                 "check the units of the readings: gram-force typed as newton makes a gain 102 times too large, and "
                 "newton typed as gram-force 102 times too small");
  const ForceResponse response = fit.response();
  if (!(std::abs(response.quadratic) <= ForceResponse::most_bend &&
        std::abs(response.cubic) <= ForceResponse::most_bend &&
        response.least_slope_of_bends() >= ForceResponse::least_slope))
    return unfit(fmt::format("{} does not push harder with every greater command, which no correction can mend", name),
                 "look for a mistyped reading, or measure only as far as the force grows");
  if (fit.most && !(fit.most->value >= ForceResponse::least_most * peak))
    return unfit(
        readable("{} would saturate at {:.3g} N, below a twentieth of the device's force", name, fit.most->value),
        "check the units of the readings");
  return std::nullopt;
}

}  // namespace

ForceResponse WayFit::response() const {
  return {.gain = gain.value,
          .dead_band = dead_band.value,
          .quadratic = quadratic.value,
          .cubic = cubic.value,
          .most = most ? most->value : 0};
}

Result<WayFit> fit_way(std::span<const GaugeReading> readings, double peak) {
  Columns data{VectorXd(static_cast<Index>(readings.size())), VectorXd(static_cast<Index>(readings.size())), peak};
  for (std::size_t i = 0; i < readings.size(); ++i) {
    data.command[static_cast<Index>(i)] = readings[i].command;
    data.newton[static_cast<Index>(i)] = readings[i].newton;
  }
  WayFit fit;
  if (!readings.empty()) fit.way = readings.front().way;
  const std::vector<double> commands = commands_of(data);
  if (auto error = too_few(data, commands, fit.way)) return *std::move(error);

  fit.bends = commands.size() >= 8 ? 2 : commands.size() >= 6 ? 1 : 0;
  Fits fits = best_fit(data, commands, fit.bends);
  // The bends need enough commands between dead band and saturation.
  const auto between = [&](const Fitted& of) {
    return std::ranges::count_if(
        commands, [&](double command) { return command > of.at[band_at] && command < of.model.saturates_from; });
  };
  const auto bends_too_much = [&](const Fitted& of) {
    return ForceResponse{.quadratic = of.at[quadratic_at], .cubic = of.at[cubic_at]}.least_slope_of_bends() <
           ForceResponse::least_slope;
  };
  while (fit.bends > 0 && (between(fits.best) < 4 + fit.bends || bends_too_much(fits.best)))
    fits = best_fit(data, commands, --fit.bends);
  const Fitted& fitted = fits.best;

  const VectorXd residuals = residuals_of(data, fitted.model, fitted.at);
  const std::vector<int> free = fitted.model.free();
  const double freedom = static_cast<double>(data.command.size()) - static_cast<double>(free.size());
  const double variance = freedom > 0 ? fitted.squares / freedom : std::nan("");
  const VectorXd reach = freedom > 0 ? reaches(data, fits, freedom) : VectorXd::Constant(parameters, HUGE_VAL);
  const double quantile = freedom > 0 ? analysis::t_quantile(0.975, freedom) : 1;
  const auto figure = [&](const char* name, int place) {
    Coefficient coefficient{.name = name, .value = fitted.at[place]};
    if (std::ranges::find(free, place) == free.end()) return coefficient;
    coefficient.error = reach[place] / quantile;
    coefficient.freedom = freedom;
    return coefficient;
  };
  fit.gain = figure("gain", gain_at);
  fit.dead_band = figure("dead band", band_at);
  if (freedom > 0) fit.dead_band.error = std::max(fit.dead_band.error, reach_of_band(data, fitted, freedom) / quantile);
  fit.quadratic = figure("quadratic", quadratic_at);
  fit.cubic = figure("cubic", cubic_at);
  fit.offset = figure("offset", offset_at);
  if (fitted.model.saturates()) fit.most = figure("saturation", most_at);
  fit.readings = readings.size();
  fit.commands = commands.size();
  fit.deviation = std::sqrt(variance);
  fit.greatest_residual = residuals.cwiseAbs().maxCoeff();
  fit.greatest_command = commands.back();
  fit.lack_of_fit = lack_of_fit(data, residuals, commands.size(), free.size());
  fit.drift = drift_of(readings, fit.offset.value);
  fit.residuals.assign(residuals.begin(), residuals.end());
  if (auto error = absurd(fit, peak)) return *std::move(error);
  if (!std::isfinite(fit.gain.error) || !std::isfinite(fit.dead_band.error))
    return unfit(fmt::format("the readings of {} do not tell its gain from its dead band", in_words(fit.way)),
                 "measure at more commands, some of them small");
  return fit;
}

Coefficient axis_offset(const WayFit& forward, const WayFit& backward) {
  const double a = forward.offset.error * forward.offset.error / 4,
               b = backward.offset.error * backward.offset.error / 4;
  const double freedom = a + b > 0
                             ? (a + b) * (a + b) / (a * a / forward.offset.freedom + b * b / backward.offset.freedom)
                             : forward.offset.freedom;  // Welch and Satterthwaite
  return {"offset", (forward.offset.value - backward.offset.value) / 2, std::sqrt(a + b), freedom};
}

}  // namespace wale
