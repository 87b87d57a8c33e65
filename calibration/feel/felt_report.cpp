#include "calibration/feel/felt_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "calibration/feel/own_force.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/relief.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/wall.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"
#include "schema/without_place.hpp"

namespace wale {

namespace {

/// s, at most half a run, in which forces slew in and the hand comes up to speed.
constexpr double settling_seconds = 0.5;

std::string force_text(const ForceSize& size) {
  return fmt::format("P99 {:.3f} N, maximum {:.3f} N, RMS {:.3f} N", size.p99, size.maximum, size.rms);
}

/// Ticks on which each guard stepped in.
std::vector<std::pair<std::string, long>> named(const GuardCounts& counts) {
  return {{"slew", counts.slew},
          {"device_limit", counts.device_limit},
          {"user_limit", counts.user_limit},
          {"heat", counts.heat},
          {"energy", counts.energy},
          {"passivity", counts.passivity},
          {"not_a_number", counts.not_a_number},
          {"overrun", counts.overrun},
          {"stale", counts.stale},
          {"lost", counts.lost}};
}

/// "slew 12, passivity 3 (ticks)": the guards that stepped in.
std::string shown(const GuardCounts& counts) {
  std::string text;
  for (auto [name, count] : named(counts)) {
    std::ranges::replace(name, '_', name == "not_a_number" ? '-' : ' ');
    if (count > 0) text += readable("{}{} {}", text.empty() ? "" : ", ", name, count);
  }
  return text.empty() ? "none stepped in" : text + " (ticks)";
}

std::string vibration_text(const FeltVibration& vibration) {
  std::string text = fmt::format("  actuator     P99 {:.3f} m/s^2, maximum {:.3f} m/s^2, RMS {:.3f} m/s^2{}\n",
                                 vibration.acceleration.p99, vibration.acceleration.maximum, vibration.acceleration.rms,
                                 vibration.ticks > 0 ? " (amplitude, within the patch)" : " (never within the patch)");
  if (vibration.highest > 0)
    text += fmt::format("  frequency    {:.1f} .. {:.1f} Hz where it shakes\n", vibration.lowest, vibration.highest);
  return text;
}

/// Every step with its name.
std::vector<std::pair<std::string, Times>> named(const TickCosts& costs) {
  std::vector<std::pair<std::string, Times>> all;
  for (std::size_t step = 0; step < TickCosts::steps; ++step)
    all.emplace_back(name_of(static_cast<TickCosts::Step>(step)), costs.of[step]);
  return all;
}

std::string cost_text(const TickCosts& costs) {
  const auto steps = named(costs);
  const auto& [name, most] = *std::ranges::max_element(steps, {}, [](const auto& step) { return step.second.p50; });
  return fmt::format(
      "  cost         p50 {:.1f} us, p99 {:.1f} us a tick; most of it to {}: p50 {:.1f} us, p99 {:.1f} us\n",
      1e6 * costs.whole.p50, 1e6 * costs.whole.p99, name, 1e6 * most.p50, 1e6 * most.p99);
}

nlohmann::ordered_json times_json(const Times& times) {
  return {{"p50_s", times.p50}, {"p99_s", times.p99}, {"max_s", times.maximum}};
}

nlohmann::ordered_json vibration_json(const FeltVibration& vibration) {
  return {{"p99_m_per_s2", vibration.acceleration.p99},
          {"max_m_per_s2", vibration.acceleration.maximum},
          {"rms_m_per_s2", vibration.acceleration.rms},
          {"lowest_hz", vibration.lowest},
          {"highest_hz", vibration.highest},
          {"ticks", vibration.ticks}};
}

nlohmann::ordered_json force_json(const ForceSize& size) {
  return {{"p99_newton", size.p99}, {"max_newton", size.maximum}, {"rms_newton", size.rms}};
}

/// About how long such a run must be for the hand to cross the texture often enough, s, a fifth longer than at the pace
/// of this one; infinite if it crossed nothing, and nothing if this run was long enough or no percept needs crossings.
std::optional<double> needed_seconds(const PatchProgram& program, const Felt& felt, double seconds, double settling) {
  const bool needs = std::ranges::any_of(program.percepts, [](const PerceptRecord& percept) {
    return percept.extractor == Extractor::lateral_force && percept.alone;
  });
  if (felt.vibration || !needs || felt.crossings >= least_crossings) return std::nullopt;
  if (felt.crossings == 0) return HUGE_VAL;
  constexpr double margin = 1.2;
  const double pace = static_cast<double>(felt.crossings) / (seconds - settling);
  return std::ceil(settling + margin * static_cast<double>(least_crossings) / pace);
}

/// What the hand may cross of a program.
struct CrossedTexture {
  bool has_relief = true;
  bool is_all = true;   ///< it is the whole force, so that the swings of the force are its flanks
  float amplitude = 0;  ///< N: of its force as it comes to the handle if the device gives all of it
};

/// Whether a hand that moves about meets the same force again at the same place.
bool depends_on_place_alone(const PatchProgram& program) {
  return !depends_on_motion(program) && !goes_by_time(program) && !remembers_anything(program);
}

/// Whether something pushes beside the relief on a hand at rest: a spring, a wall, an even force.
bool pushes_beside_relief(const StaticForce& read, PatchSize size) {
  constexpr double hardly = 0.1;  // of the relief: swings are told by its upper and lower quarter
  const LinearForce& trend = read.trend;
  const double most = glm::length(trend.mean) + 0.5 * size.width * glm::length(trend.by_x) +
                      0.5 * size.height * glm::length(trend.by_y);
  return most > std::max(least_force, hardly * read.relief.amplitude) || !read.obstacles.walls.empty() ||
         !read.obstacles.steps.empty() || std::ranges::any_of(read.features, &Feature::monotone);
}

CrossedTexture crossed_texture(const Bank& bank, float aimed) {
  const PatchProgram& program = bank.program().description();
  if (program.device.shaker) return {.amplitude = aimed};
  const auto texture = std::ranges::find(program.percepts, Extractor::lateral_force, &PerceptRecord::extractor);
  const bool is_texture = texture != program.percepts.end();
  if (is_texture && texture->alone && texture->basis.summand) return {.amplitude = aimed};
  if (!depends_on_place(program)) return {.has_relief = false, .is_all = false};
  // A factor or a limit leaves another size than the one that was solved, and formulas solve none.
  const StaticForce read = static_force(bank);
  const bool is_all = (is_texture && texture->alone) ||
                      (depends_on_place_alone(program) && !pushes_beside_relief(read, bank.size()));
  return {is_texture || read.relief.amplitude >= least_force, is_all, static_cast<float>(read.relief.amplitude)};
}

bool needs_wall(const PerceptRecord& percept) {
  return percept.extractor == Extractor::wall_stiffness || percept.extractor == Extractor::wall_damping;
}

/// "press along 180 deg at -20 mm, 0 mm": the motion of a hand into a wall.
std::string pressing_into(const WallFace& wall) {
  constexpr double half_turn = 180;
  const double angle = std::atan2(wall.inward.y, wall.inward.x) * half_turn / std::numbers::pi;
  // The place of the face that is nearest to the middle.
  const glm::dvec2 place = glm::dot(wall.place, wall.inward) * wall.inward;
  return fmt::format("press along {} deg at {} mm, {} mm", with_decimals(angle, 0), with_decimals(1e3 * place.x, 0),
                     with_decimals(1e3 * place.y, 0));
}

/// "roughness 0.36 and viscosity 0.20": percepts with their levels.
std::string read_text(const std::vector<ReadLevel>& read) {
  std::string text;
  for (std::size_t i = 0; i < read.size(); ++i)
    text += fmt::format("{}{} {}{:.2f}",
                        i == 0                 ? ""
                        : i + 1 == read.size() ? " and "
                                               : ", ",
                        read[i].name, read[i].at_least ? "at least " : "", read[i].level);
  return text;
}

/// Whether the hand went where a texture pushes less or more than over the whole patch, as along the crests of one of
/// two waves.
bool shows_other_size(const FeltReport& report, std::size_t index) {
  const float aimed = report.aimed[index], shown = report.shown[index];
  return shown > 0 && std::abs(shown - aimed) > reading * aimed && report.let_through[index] >= std::min(aimed, shown);
}

/// "0.5 of 0.5 N that --max-force lets through (100 %); without it 0.918 N": a size of the carrier against the size
/// that the program aims at, as far as it may come.
std::string delivered_text(const FeltReport& report, std::size_t index) {
  const float size = report.levels[index].size, aimed = report.aimed[index], let = report.let_through[index];
  const std::string& unit = report.units[index];
  const float shown = report.shown[index];
  if (shows_other_size(report, index))
    return readable("{:.4g} of {:.4g} {} on the hand's way ({:.0f} %); over the whole patch it is {:.4g} {}", size,
                    shown, unit, 100 * size / shown, aimed, unit);
  const std::string share = let > 0 ? readable(" ({:.0f} %)", 100 * size / let) : "";
  if (let < aimed)
    return readable("{:.4g} of {:.4g} {} that --max-force lets through{}; it aims at {:.4g} {}", size, let, unit, share,
                    aimed, unit);
  // A limit of force bounds no size in another unit, but cuts what shows it.
  const bool cut = report.guards.user_limit > 0 && unit != (report.felt.vibration ? "m/s^2" : "N");
  return readable("{:.4g} of {:.4g} {}{}{}", size, aimed, unit, share, cut ? ", with forces that --max-force cut" : "");
}

/// "; its actuators follow to 20 Hz", or "to 20 Hz along x and 40 Hz along y", behind a size off which they take some.
std::string following_text(const FeltReport& report, std::size_t index) {
  constexpr float plainly_less = 0.97F;
  const double x = report.device.bandwidth_x, y = report.device.bandwidth_y;
  const float expected = std::min(report.aimed[index], report.let_through[index]);
  if (!(x > 0 || y > 0) || report.felt.vibration || report.levels[index].size > plainly_less * expected) return {};
  if (x == y) return readable("; its actuators follow to {:.4g} Hz", x);
  const std::string along_x = x > 0 ? readable("{:.4g} Hz along x", x) : "";
  const std::string along_y = y > 0 ? readable("{:.4g} Hz along y", y) : "";
  return "; its actuators follow to " + along_x + (x > 0 && y > 0 ? " and " : "") + along_y;
}

/// The largest force of all ticks, if the figures of the actuator leave it out; otherwise empty.
std::string largest_text(const FeltReport& report) {
  constexpr double hardly_more = 1.001;
  const bool rubbed = report.felt.ticks_rubbing > 0;
  const double told = rubbed ? report.felt.force_rubbing.maximum : report.felt.force.maximum;
  if (report.felt.vibration || report.largest <= hardly_more * told) return {};
  if (report.device.bandwidth_x > 0 || report.device.bandwidth_y > 0)
    return readable("  largest      {:.3f} N that the actuator was told, at {:.3g} s\n", report.largest,
                    report.largest_at);
  return readable("  largest      {:.3f} N, at {:.3g} s: {}\n", report.largest, report.largest_at,
                  report.largest_at < report.settling
                      ? readable("in the first {:.2g} s, which the figures leave out", report.settling)
                      : "where the hand did not rub");
}

/// What a map makes of the force, or why it makes nothing of it, for each percept.
std::string levels_text(const FeltReport& report) {
  const Felt& felt = report.felt;
  std::string text;
  for (std::size_t i = 0; i < report.levels.size(); ++i) {
    const LevelBack& level = report.levels[i];
    if (!level.back) {
      text += fmt::format("  {:<12} no level: {}\n", level.name, in_words_without_place(level.back.error()));
      continue;
    }
    text += readable("  delivered    {}{}\n", delivered_text(report, i), following_text(report, i));
    text += fmt::format("  {:<12} {}{:.2f}, as its map reads that {}{}\n", level.name,
                        report.at_least[i] ? "at least " : "", level.back->level,
                        felt.vibration              ? "shaking"
                        : shows_other_size(report, i) ? "force over the whole patch"
                        : report.units[i] == "N" ? "force"
                                                 : "size",
                        report.asked[i] >= 0 ? fmt::format(" (asked: {:.2f})", report.asked[i]) : "");
  }
  if (report.levels.empty())
    text += felt.vibration ? "  percepts     none that a map reads: it does not vibrate\n"
            : report.read.empty()
                ? "  percepts     none that a map reads\n"
                : fmt::format("  percepts     none is asked for; `wale describe` reads {}\n", read_text(report.read));
  if (!report.levels.empty() && !report.read.empty())
    text += fmt::format("  besides      `wale describe` reads {}\n", read_text(report.read));
  if (!report.needed_seconds) return text;
  if (*report.needed_seconds <= longest_proposed_run)
    return text +
           fmt::format("  longer       about {:.0f} s of this motion cross it {} times: --seconds \"{:.0f} s\"\n",
                       *report.needed_seconds, least_crossings, *report.needed_seconds);
  if (report.crossing_motion.empty()) return text;
  return text + (report.manner.plugged ? fmt::format("  longer       move {}\n", report.crossing_motion)
                                       : fmt::format("  longer       another motion crosses it sooner: --hand \"{}\"\n",
                                                     report.crossing_motion));
}

/// "forces sent x" for "forces_sent_x".
std::string spaced(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// The losses and counts of a real device, with counts also per second.
std::string plugged_text(const HotPlugReport& plugged, double seconds) {
  std::string text = "  driven       " + plugged.manner + "\n", counts;
  for (const auto& [name, count] : plugged.tally)
    if (count > 0)
      counts += readable("{}{} {} ({:.0f} a second)", counts.empty() ? "" : ", ", spaced(name), count,
                         static_cast<double>(count) / seconds);
  if (!counts.empty()) text += "  packets      " + counts + "\n";
  const auto times = [](long count) { return fmt::format("{} time{}", count, count == 1 ? "" : "s"); };
  if (plugged.losses > 0)
    text += fmt::format("  lost         {} ({}), set up again {}{}\n", times(plugged.losses), plugged.reason,
                        times(plugged.returns),
                        plugged.refusal.empty() ? "" : "; the last attempt failed: " + plugged.refusal);
  return text;
}

nlohmann::ordered_json plugged_json(const HotPlugReport& plugged) {
  nlohmann::ordered_json json = {{"manner", plugged.manner},
                                 {"losses", plugged.losses},
                                 {"returns", plugged.returns},
                                 {"reason", plugged.reason},
                                 {"refusal", plugged.refusal}};
  for (const auto& [name, count] : plugged.tally) json["tally"][name] = count;
  return json;
}

}  // namespace

FeltReport felt_report(const Bank& bank, const RunResult& run, const DeviceProfile& device, RunManner manner) {
  const PatchProgram& program = bank.program().description();
  FeltReport report{.material = program.material, .manner = std::move(manner), .device = device};
  report.ticks_run = run.ticks_run;
  report.ticks_missed = run.ticks_missed;
  report.seconds = static_cast<double>(run.ticks_run + run.ticks_missed) * run.record.seconds_per_tick;
  report.lateness = run.lateness;
  report.costs = run.costs;
  report.guards = run.guards;
  report.scheduling = run.scheduling;
  const CrossedTexture texture = crossed_texture(bank, predicted_amplitude(bank));
  report.predicted_amplitude = std::min(predicted_amplitude(bank), static_cast<float>(device.most()));
  const auto let_through = static_cast<float>(std::min(report.manner.most, device.most()));
  const double settling = std::min(settling_seconds, report.seconds / 2);
  report.settling = settling;
  for (const TickRecord& tick : run.record.ticks)
    if (const double size = glm::length(tick.force); size > report.largest)
      report.largest = size, report.largest_at = tick.time;
  const MeasureOptions options{.position_step = device.position_step(),
                               .predicted_amplitude = std::min(texture.amplitude, let_through),
                               .settling = settling,
                               .vibrates = device.shaker.has_value(),
                               .bandwidth = {device.bandwidth_x, device.bandwidth_y}};
  report.felt = measure(run.record, options);
  report.has_relief = texture.has_relief, report.crossings_counted = texture.is_all;
  report.needed_seconds = needed_seconds(program, report.felt, report.seconds, settling);
  report.levels = levels_back(bank, report.felt, least_crossings);
  std::vector<LevelBack> own;
  if (const auto felt = measured_of_program(bank, run.record, options)) own = levels_back(bank, *felt, 0);
  for (auto& level : report.levels) {
    const PerceptRecord& percept = program.percepts[level.percept];
    // The device's limit cuts only carriers in the unit of its output.
    const bool limited = percept.unit == (device.shaker ? "m/s^2" : "N");
    report.units.push_back(percept.unit);
    report.aimed.push_back(limited ? std::min(level.predicted_amplitude, static_cast<float>(device.most()))
                                   : level.predicted_amplitude);
    // A texture may be one part of the force that is limited.
    const float share = percept.extractor == Extractor::lateral_force ? percept.basis.share : 1;
    report.let_through.push_back(limited ? std::min(report.aimed.back(), let_through * share) : report.aimed.back());
    report.at_least.push_back(false);
    const std::size_t index = report.shown.size();
    report.shown.push_back(index < own.size() && own[index].back ? std::max(own[index].size, 0.0f) : 0);
    if (!level.back && level.back.error().mend.empty() && percept.alone && needs_wall(percept))
      if (const auto wall = wall_face(bank)) level.back.error().mend = "--hand \"" + pressing_into(*wall) + "\" does";
    const auto& parameter = percept.parameter;
    report.asked.push_back(parameter ? bank.registers()[program.first_parameter() + *parameter] : -1);
  }
  return report;
}

std::string felt_text(const FeltReport& report) {
  const Felt& felt = report.felt;
  std::string text = report.manner.plugged
                         ? readable("{} on {} as {}, in your hand, {:.4g} s\n", report.material, report.manner.device,
                                    report.device.name, report.seconds)
                         : readable("{} on the {} {}, hand {}, {:.4g} s{}\n", report.material, report.manner.device,
                                    report.device.name, visible_text(report.manner.hand), report.seconds,
                                    report.manner.virtual_time ? " of virtual time" : "");
  if (report.manner.versions > 1)
    text += readable(
        "  versions     {} of the file were felt: measured figures are over all of them, predicted ones of the last\n",
        report.manner.versions);
  text += readable("  ticks        {} run, {} missed, at {:.4g} Hz\n", report.ticks_run, report.ticks_missed,
                   report.device.rate);
  if (report.manner.virtual_time)
    text += "  lateness     none: virtual time\n";
  else
    text += readable("  lateness     p50 {:.0f} us, p99 {:.0f} us, maximum {:.0f} us\n", 1e6 * report.lateness.p50,
                     1e6 * report.lateness.p99, 1e6 * report.lateness.maximum);
  if (report.costs) text += cost_text(*report.costs);
  if (!report.scheduling.empty()) text += readable("  scheduling   {}\n", report.scheduling);
  if (report.manner.plugged) text += plugged_text(*report.manner.plugged, report.seconds);
  if (felt.vibration)
    text += vibration_text(*felt.vibration);
  else
    text +=
        readable("  actuator     {}{}\n", force_text(felt.ticks_rubbing > 0 ? felt.force_rubbing : felt.force),
                 felt.ticks_rubbing > 0 ? " (at the handle, while rubbing)" : " (at the handle; the hand did not rub)");
  text += largest_text(report);
  if (report.predicted_amplitude > 0)
    text +=
        readable("  aims at      amplitude {:.3f} {}\n", report.predicted_amplitude, felt.vibration ? "m/s^2" : "N");
  if (felt.interaction)
    text += readable(
        "  interaction  {} (hand on handle, with inertia and friction)\n",
        force_text(felt.interaction_rubbing && felt.ticks_rubbing > 0 ? *felt.interaction_rubbing : *felt.interaction));
  if (!report.device.has_position())
    text += readable("  place        none: `{}` does not measure the hand's position\n", report.device.name);
  else if (felt.vibration)
    text += readable("  place        the hand ranged over {:.1f} mm\n", 1e3 * felt.position_range);
  else if (!report.has_relief)
    text += readable("  place        the hand ranged over {:.1f} mm, {:.1f} % of the time stuck\n",
                     1e3 * felt.position_range, 100 * felt.stuck);
  else
    text += readable("  texture      {} {:.1f} % of the time stuck; the hand ranged over {:.1f} mm\n",
                     report.crossings_counted ? readable("{} crossings,", felt.crossings)
                                              : "crossings not counted: other forces push too;",
                     100 * felt.stuck, 1e3 * felt.position_range);
  text += levels_text(report);
  text += "  guards       " + shown(report.guards) + "\n";
  if (report.guards.restored > 0)
    text += readable("  memory       {} time{} a state was not a number and got its first value again\n",
                     report.guards.restored, report.guards.restored == 1 ? "" : "s");
  return text;
}

std::string felt_json(const FeltReport& report) {
  const Felt& felt = report.felt;
  nlohmann::ordered_json json;
  json["material"] = report.material;
  json["device"] = report.manner.device;
  json["profile"] = report.device.name;
  json["hand"] = report.manner.hand;
  json["virtual_time"] = report.manner.virtual_time;
  json["versions"] = report.manner.versions;
  json["seconds"] = report.seconds;
  json["ticks"] = {{"run", report.ticks_run}, {"missed", report.ticks_missed}, {"rubbing", felt.ticks_rubbing}};
  json["lateness"] = times_json(report.lateness);
  if (report.costs) {
    auto& cost = json["cost"] = {{"tick", times_json(report.costs->whole)}};
    for (const auto& [name, times] : named(*report.costs)) cost[name] = times_json(times);
  }
  json["scheduling"] = report.scheduling;
  if (report.manner.plugged) json["plugged"] = plugged_json(*report.manner.plugged);
  if (felt.vibration) {
    json["vibration"] = vibration_json(*felt.vibration);
    json["predicted_amplitude_m_per_s2"] = report.predicted_amplitude;
  } else {
    json["actuator"] = force_json(felt.force);
    json["actuator_rubbing"] = force_json(felt.force_rubbing);
    json["largest"] = {{"newton", report.largest}, {"at_s", report.largest_at}};
    // The force of formulas without a level aims at nothing.
    json["predicted_amplitude_newton"] =
        report.predicted_amplitude > 0 ? nlohmann::ordered_json(report.predicted_amplitude) : nullptr;
  }
  if (felt.interaction) json["interaction"] = force_json(*felt.interaction);
  if (!felt.vibration) {
    json["crossings"] = report.crossings_counted ? nlohmann::ordered_json(felt.crossings) : nullptr;
    json["alternations"] = felt.alternations;
    json["stuck"] = felt.stuck;
  }
  json["position_rms_m"] = felt.position_rms;
  json["position_range_m"] = felt.position_range;
  auto& percepts = json["percepts"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < report.levels.size(); ++i) {
    auto& entry = percepts[report.levels[i].name];
    if (const auto& back = report.levels[i].back)
      entry = {
          {"level", back->level},     {"magnitude", back->magnitude},         {"delivered", report.levels[i].size},
          {"aimed", report.aimed[i]}, {"let_through", report.let_through[i]}, {"at_least", bool(report.at_least[i])},
          {"unit", report.units[i]}};
    else
      entry = {{"refused", in_words_without_place(report.levels[i].back.error())}};
    if (const float shown = report.shown[i]; shown > 0 && report.levels[i].back) entry["on_the_way"] = shown;
    if (report.asked[i] >= 0) entry["asked"] = report.asked[i];
  }
  for (const ReadLevel& each : report.read)
    percepts[each.name] = {{"described", each.level}, {"at_least", each.at_least}};
  if (report.needed_seconds && std::isfinite(*report.needed_seconds)) json["needed_seconds"] = *report.needed_seconds;
  if (!report.crossing_motion.empty()) json["crossing_motion"] = report.crossing_motion;
  if (std::isfinite(report.manner.most))
    json[felt.vibration ? "max_force_m_per_s2" : "max_force_newton"] = report.manner.most;
  for (const auto& [name, count] : named(report.guards)) json["guards"][std::string(name)] = count;
  json["guards"]["restored"] = report.guards.restored;
  return json_lines(json);
}

std::string progress_line(const Now& now, bool vibrates) {
  const std::string output = vibrates ? fmt::format("{:5.1f} m/s^2  {:4.0f} Hz", now.force.x, now.force.y)
                                      : fmt::format("{:5.2f} N", glm::length(now.force));
  return readable("{:7.1f} s  x {:>6} mm  y {:>6} mm  {:5.0f} mm/s  {}  {} ticks, {} missed{}\033[K", now.time,
                  with_decimals(1e3 * now.position.x, 1), with_decimals(1e3 * now.position.y, 1),
                  1e3 * glm::length(now.velocity), output, now.ticks_run, now.ticks_missed,
                  now.inside ? "" : "  (off the patch)");
}

}  // namespace wale
