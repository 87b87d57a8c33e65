#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/truth/truth.hpp"

namespace wale::truth {
namespace {

constexpr double huge_error = 1000;  // of what is there and not read, or read and not there

/// The angle between two lines, rad.
double between_lines(double a, double b) { return std::abs(std::remainder(a - b, std::numbers::pi)); }

double error_of(const CueRule& rule, double expected, double read) {
  if (rule.cue == Cue::orientation || rule.cue == Cue::axis) return between_lines(expected, read) / rule.relative;
  return std::abs(read - expected) / std::max(rule.relative * std::abs(expected), rule.least);
}

std::string in_unit(const CueRule& rule, double value) {
  return fmt::format("{:.4g} {}", rule.scale * value, rule.unit);
}

/// How wrong a cue is: 1 is the bar.
double error_of(const CueRule& rule, const Expected& expected, const std::optional<double>& read) {
  const bool is_read = read && (rule.least == 0 || std::abs(*read) > rule.least);
  switch (expected.kind) {
    case Expected::Kind::open: return 0;
    case Expected::Kind::some: return is_read ? 0 : huge_error;
    case Expected::Kind::none:
      if (!is_read) return 0;
      return rule.least == 0 ? huge_error : std::abs(*read) / rule.least;
    case Expected::Kind::value:
      if (read) return error_of(rule, expected.value, *read);
      return rule.least > 0 && std::abs(expected.value) <= rule.least ? 0 : huge_error;
  }
  return huge_error;
}

std::string fault_of(const CueRule& rule, const Expected& expected, const std::optional<double>& read) {
  const std::string wanted = expected.kind == Expected::Kind::value  ? in_unit(rule, expected.value)
                             : expected.kind == Expected::Kind::none ? "none"
                                                                     : "some";
  return fmt::format("expected {}, read {}", wanted, read ? in_unit(rule, *read) : "none");
}

std::string text_of(const std::vector<WaveTruth>& waves) {
  std::string text;
  for (const WaveTruth& wave : waves)
    text += fmt::format("{}{:.4g} mm at {:.1f} degrees", text.empty() ? "" : " and ", 1e3 * wave.period,
                        wave.orientation * 180 / std::numbers::pi);
  return text.empty() ? "none" : text;
}

std::string text_of(const std::vector<WallTruth>& walls) {
  std::string text;
  for (const WallTruth& wall : walls)
    text += fmt::format(
        "{}{:.4g} N/m{} from {:.2f} mm on {}", text.empty() ? "" : " and ", wall.stiffness,
        wall.power == 1 ? "" : fmt::format(" and depth^{:.3g}", wall.power), 1e3 * wall.face,
        wall.round == 0
            ? fmt::format("towards {:.1f} degrees", wall.inward * 180 / std::numbers::pi)
            : fmt::format("{} ({:.2f}, {:.2f}) mm", wall.round > 0 ? "around" : "within", 1e3 * wall.x, 1e3 * wall.y));
  return text.empty() ? "none" : text;
}

std::string text_of(const std::vector<StepTruth>& steps) {
  std::string text;
  for (const StepTruth& step : steps)
    text += fmt::format("{}({:.3f}, {:.3f}) N at {:.2f} mm towards {:.1f} degrees", text.empty() ? "" : " and ", step.x,
                        step.y, 1e3 * step.place, step.angle * 180 / std::numbers::pi);
  return text.empty() ? "none" : text;
}

/// Judges a list of things by what is alike.
template <typename Thing>
void judge_all(const std::vector<Thing>& expected, const std::vector<Thing>& read, std::size_t at,
               Judgement& judgement) {
  bool same = expected.size() == read.size();
  for (const Thing& each : expected)
    same = same && std::ranges::any_of(read, [&](const Thing& other) { return alike(each, other); });
  judgement.verdicts[at] = same ? Verdict::right : Verdict::wrong;
  judgement.errors[at] = same ? 0 : huge_error;
  if (!same) judgement.faults[at] = fmt::format("expected {}, read {}", text_of(expected), text_of(read));
}

}  // namespace

const std::array<CueRule, cue_count>& cue_rules() {
  // A force of 0.01 N is a sixth of the smallest that a hand notices; 2 N/m change it by that much over 5 mm, 0.05 N
  // s/m at 0.2 m/s, 1 g at 10 m/s^2. A period, a rate or a direction is there or not.
  static constexpr std::array<CueRule, cue_count> rules{{
      {Cue::amplitude, "amplitude", "N", 1, 0.03, 0.01},
      {Cue::period, "period", "mm", 1e3, 0.02, 0},
      {Cue::orientation, "orientation", "degrees", 180 / std::numbers::pi, 2 * std::numbers::pi / 180, 0},
      {Cue::roughness, "roughness", "N", 1, 0.03, 0.01},
      {Cue::bumpiness, "bumpiness", "N", 1, 0.03, 0.01},
      {Cue::stiffness, "stiffness", "N/m", 1, 0.03, 2},
      {Cue::wall_stiffness, "wall", "N/m", 1, 0.03, 2},
      {Cue::viscosity, "viscosity", "N s/m", 1, 0.03, 0.05},
      {Cue::friction, "friction", "N", 1, 0.03, 0.01},
      {Cue::breakaway, "breakaway", "N", 1, 0.03, 0.01},
      {Cue::mass, "mass", "kg", 1, 0.03, 1e-3},
      {Cue::vibration, "vibration", "N", 1, 0.03, 0.01},
      {Cue::vibration_rate, "rate", "Hz", 1, 0.02, 0},
      {Cue::sway, "sway", "N", 1, 0.03, 0.01},
      {Cue::sway_rate, "sway rate", "Hz", 1, 0.02, 0},
      {Cue::constant, "constant", "N", 1, 0.03, 0.01},
      {Cue::stiffness_across, "across", "N/m", 1, 0.03, 2},
      {Cue::viscosity_across, "across", "N s/m", 1, 0.03, 0.05},
      {Cue::friction_across, "across", "N", 1, 0.03, 0.01},
      {Cue::mass_across, "across", "kg", 1, 0.03, 1e-3},
      {Cue::axis, "axis", "degrees", 180 / std::numbers::pi, 2 * std::numbers::pi / 180, 0},
      {Cue::wall_damping, "damping", "N s/m", 1, 0.03, 0.05},
      {Cue::face, "face", "mm", 1e3, 0.02, 0.3e-3},
      {Cue::wall_jump, "jump", "N", 1, 0.03, 0.01},
      {Cue::wall_push, "wall push", "N", 1, 0.03, 0.01},
      {Cue::other_vibration, "other vibration", "N", 1, 0.03, 0.01},
      {Cue::other_vibration_rate, "other rate", "Hz", 1, 0.02, 0},
      {Cue::other_sway, "other sway", "N", 1, 0.03, 0.01},
      {Cue::other_sway_rate, "other sway rate", "Hz", 1, 0.02, 0},
      {Cue::one_way_mass, "mass one way", "kg", 1, 0.03, 1e-3},
      {Cue::uneven_mass, "mass in a part", "kg", 1, 0.03, 1e-3},
  }};
  return rules;
}

bool alike(const WaveTruth& a, const WaveTruth& b) {
  constexpr double degree = std::numbers::pi / 180;
  return std::abs(a.period - b.period) <= 0.02 * a.period && between_lines(a.orientation, b.orientation) <= 2 * degree;
}

bool alike(const WallTruth& a, const WallTruth& b) {
  constexpr double degree = std::numbers::pi / 180;
  // A push that begins flat is not felt in its first millimetre.
  const double least = a.power == 1 ? 0.3e-3 : 1e-3;
  if (a.round != b.round || std::abs(a.stiffness - b.stiffness) > 0.03 * a.stiffness ||
      std::abs(a.face - b.face) > std::max(0.02 * std::abs(a.face), least) ||
      std::abs(a.power - b.power) > 0.05 * a.power)
    return false;
  if (a.round != 0) return std::hypot(a.x - b.x, a.y - b.y) < 0.5e-3;
  return std::abs(std::remainder(a.inward - b.inward, 2 * std::numbers::pi)) <= 2 * degree;
}

bool alike(const StepTruth& a, const StepTruth& b) {
  constexpr double degree = std::numbers::pi / 180;
  // A line that is crossed the other way round has the same step with the other sign.
  const double way = std::cos(a.angle - b.angle) < 0 ? -1 : 1;
  return std::hypot(a.x - way * b.x, a.y - way * b.y) <= std::max(0.03 * std::hypot(a.x, a.y), 0.01) &&
         std::abs(a.place - way * b.place) <= 0.5e-3 && between_lines(a.angle, b.angle) <= 2 * degree;
}

bool follows(Cue cue, Cue from) {
  return (cue == Cue::roughness || cue == Cue::bumpiness) && (from == Cue::amplitude || from == Cue::period);
}

const char* judged_name(std::size_t judged) {
  constexpr const char* lists[] = {"waves", "walls", "steps"};
  return judged < cue_count ? cue_rules()[judged].name : lists[judged - cue_count];
}

bool Judgement::right() const { return std::ranges::find(verdicts, Verdict::wrong) == verdicts.end(); }

Judgement judge(const Truth& truth, const Reading& reading) {
  Judgement judgement;
  for (std::size_t i = 0; i < cue_count; ++i) {
    const CueRule& rule = cue_rules()[i];
    const Expected& expected = truth.cues[i];
    if (expected.kind == Expected::Kind::open) continue;
    const double error = error_of(rule, expected, reading.cues[i]);
    judgement.errors[i] = error;
    judgement.verdicts[i] = error <= 1 ? Verdict::right : Verdict::wrong;
    if (error <= 1) continue;
    judgement.faults[i] = fault_of(rule, expected, reading.cues[i]);
    if (expected.kind == Expected::Kind::none) judgement.invents = true;
  }
  if (truth.waves) judge_all(*truth.waves, reading.waves, cue_count, judgement);
  if (truth.walls) judge_all(*truth.walls, reading.walls, cue_count + 1, judgement);
  if (truth.steps) judge_all(*truth.steps, reading.steps, cue_count + 2, judgement);
  return judgement;
}

}  // namespace wale::truth
