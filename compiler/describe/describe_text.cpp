#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/describe/describe_grade.hpp"
#include "compiler/describe/describe_motion.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

std::string heading(const Description& description) {
  for (const auto& [key, values] : description.layers.representative)
    if (key == "title" && !values.empty()) return readable("{} ({})", values.front(), description.material);
  return description.material;
}

/// "assumed: the ranges of amplitude and rate", without what the interval's line tells; empty if there is nothing.
std::string assumed_line(const DescribedPercept& percept) {
  std::vector<std::string> ranges;
  for (const std::string& each : percept.assumed)
    if (each != "scatter" && each != "spread" && each != "noise") ranges.push_back(each);
  if (ranges.empty()) return {};
  return fmt::format("assumed: the range{} of {}", ranges.size() == 1 ? "" : "s", fmt::join(ranges, " and "));
}

/// "measured: slope measured, …" and how the stimulus differs from those that the map was measured with.
std::vector<std::string> evidence_lines(const DescribedPercept& percept) {
  const std::string domain = percept.domain ? "domain " + evidence_word(*percept.domain) : "domain not stated";
  const std::string word = evidence_word(percept.evidence());
  std::vector<std::string> lines;
  const bool alike = percept.slope == percept.anchor && percept.anchor == percept.handle && percept.domain &&
                     *percept.domain == percept.slope;
  lines.push_back(alike ? readable("{}: slope, anchor, handle and domain", word)
                        : readable("{}: slope {}, anchor {}, handle {}, {}", word, evidence_word(percept.slope),
                                   evidence_word(percept.anchor), evidence_word(percept.handle), domain));
  if (std::string line = assumed_line(percept); !line.empty()) lines.push_back(std::move(line));
  for (const OutsideRange& each : percept.outside) lines.push_back(outside_in_words(each));
  if (!percept.domain_why.empty()) lines.push_back(percept.domain_why);
  lines.push_back(readable("{} ({}, on {})", percept.source, percept.map, percept.device));
  return lines;
}

std::vector<std::string> reading_lines(const DescribedPercept& percept, const Description& description) {
  std::vector<std::string> lines;
  if (percept.unknown) return {"unknown"};
  if (percept.amplitude == 0) {
    lines.push_back(readable("{:.2f}: nothing in the finished program carries it", percept.level));
    return lines;
  }
  lines.push_back(readable("{:.2f} from {}{} {}{:.4g} {} (magnitude {:.3g})", percept.level,
                           percept.effective ? "an effective " : "", percept.carrier, percept.effective ? "of " : "",
                           percept.amplitude, percept.unit, percept.magnitude));
  lines.push_back(people_words(percept));
  if (!percept.readable && !description.shaking)
    lines.push_back(readable("not read but aimed at: `{}` cuts the forces, which hides it", description.device.name));
  if (percept.near_threshold) lines.emplace_back("near or below threshold");
  if (percept.saturated)
    lines.push_back(
        readable("saturated: `{}` cannot {} harder", description.device.name, description.shaking ? "shake" : "push"));
  if (!percept.realisation.empty())
    lines.push_back(readable("{}`{}` renders it as {}", description.shaking ? "" : "the author wrote no physics: ",
                             description.device.name, percept.realisation));
  if (!percept.alone && !percept.extracted)
    lines.push_back(readable("{}, so a run cannot read it back", percept.changed       ? "a limit, a factor or a condition changes its force"
                                                                 : description.shaking ? "other percepts shake it too"
                                                                                       : "other forces push too"));
  return lines;
}

std::string asked_line(const DescribedPercept& percept) {
  if (!percept.asked) return "nothing";
  return readable("{:.2f}{}{}", *percept.asked, percept.claimed ? readable(" ({})", evidence_word(*percept.claimed)) : "",
                  percept.blended  ? ", by the levels of its components"
                  : percept.solved ? ""
                                   : ", and the author wrote the force");
}

void write_percepts(std::string& text, const Description& description) {
  text += "\nfeels\n";
  if (!description.no_percept.empty()) text += readable("  none can be read: {}\n", description.no_percept);
  for (const auto& percept : description.percepts) {
    std::string name = percept.name;
    const auto add = [&](std::string label, const std::vector<std::string>& lines) {
      for (const std::string& line : lines) {
        text += readable("  {:<12} {:<9} {}\n", name, label, line);
        name.clear(), label.clear();
      }
    };
    add("asked", {asked_line(percept)});
    add("reads", reading_lines(percept, description));
    add("evidence", evidence_lines(percept));
  }
}

std::string range_text(const Parameter& parameter, float low, float high) {
  return readable("{} .. {}{}{}", shown(low, parameter.unit_in_si), shown(high, parameter.unit_in_si),
                  parameter.unit.empty() ? "" : " ", parameter.unit);
}

/// "0.42", "unknown": a level that is read.
std::string read_level(double level) { return std::isfinite(level) ? with_decimals(level, 2) : "unknown"; }

/// "; at 0 roughness reads 0.00": where a parameter ends, the levels that people would notice to be others.
std::string ends_text(const std::vector<DescribedPercept>& percepts, const Parameter& parameter, std::size_t number) {
  std::string text;
  for (const DescribedPercept& percept : percepts)
    for (const DescribedPercept::End& end : percept.ends)
      if (end.parameter == number)
        text += readable("{}at {}{}{} {} reads {}", text.empty() && parameter.description.empty() ? "" : "; ",
                         shown(end.value, parameter.unit_in_si), parameter.unit.empty() ? "" : " ", parameter.unit,
                         percept.name, read_level(end.reads));
  return text;
}

/// "; reads as asked at 0, 0.5 and 1", of a level that was solved.
std::string settings_text(const std::vector<DescribedPercept>& percepts, const std::string& parameter) {
  const auto percept = std::ranges::find(percepts, parameter, &DescribedPercept::parameter);
  if (percept == percepts.end() || percept->settings.empty()) return {};
  const bool as_asked = std::ranges::all_of(percept->settings, [](const DescribedPercept::Setting& each) {
    return std::abs(each.asked - each.reads) < 0.005;
  });
  std::vector<std::string> asked, reads;
  for (const DescribedPercept::Setting& each : percept->settings) {
    asked.push_back(with_digits(each.asked, 2));
    reads.push_back(read_level(each.reads));
  }
  return as_asked ? readable("; reads as asked at {}, {} and {}", asked[0], asked[1], asked[2])
                  : readable("; at {}, {} and {} it reads {}, {} and {}", asked[0], asked[1], asked[2], reads[0],
                             reads[1], reads[2]);
}

/// "from 10 N on, `sandpaper` cuts the force".
std::string cut_text(const CutRange& cut, const Parameter& parameter, const DeviceProfile& device) {
  const std::string value =
      readable("{:.3g}{}{}", cut.value / parameter.unit_in_si, parameter.unit.empty() ? "" : " ", parameter.unit);
  return readable("{}, `{}` cuts the force", cut.above ? "from " + value + " on" : "up to " + value, device.name);
}

void write_parameters(std::string& text, const Description& description) {
  const std::vector<Parameter>& parameters = description.parameters;
  text += "\nparameters\n";
  if (parameters.empty()) text += "  none\n";
  std::size_t width = 12;
  for (const auto& parameter : parameters) width = std::max(width, parameter.name.size());
  for (const auto& parameter : parameters) {
    const auto number = static_cast<std::size_t>(&parameter - parameters.data());
    const bool usual = parameter.soft_low != parameter.low || parameter.soft_high != parameter.high;
    text += fmt::format("  {:<{}} {:<12} {:<20} {}\n", parameter.name, width,
                        readable("{} {}", shown(parameter.value, parameter.unit_in_si), parameter.unit),
                        range_text(parameter, parameter.low, parameter.high),
                        parameter.description + settings_text(description.percepts, parameter.name) +
                            ends_text(description.percepts, parameter, number));
    if (usual)
      text += fmt::format("  {:<{}} {:<12} usually {}\n", "", width, "",
                          range_text(parameter, parameter.soft_low, parameter.soft_high));
    if (number < description.cuts.size())
      for (const CutRange& cut : description.cuts[number])
        text += fmt::format("  {:<{}} {:<12} {}\n", "", width, "", cut_text(cut, parameter, description.device));
  }
  if (description.not_searched > 0)
    text += readable("  {} of these that move the force were not searched for where the device cuts it: they are too many\n",
                     description.not_searched);
}

/// A direction in [0, pi) in whole degrees below 180.
long degrees(double radians) { return std::lround(radians * 180 / std::numbers::pi) % 180; }

/// Writes the fates of the percepts on the device, then those of the physics.
void write_fates(std::string& text, const Description& description) {
  if (description.fates.empty()) return;
  text += readable("\non {}\n", description.device.name);
  for (const DescribedFate& described : description.fates) {
    const FateRecord& each = described.record;
    std::string level;
    if (each.percept && std::abs(each.given - each.asked) >= 0.005f && each.fate != Fate::lost)
      level = readable(" from {:.2f} to {:.2f}", each.asked, each.given);
    text += readable("  {:<18} {}{}{}{}{}\n", each.name, fate_word(each.fate), level, each.reason.empty() ? "" : ": ",
                     each.reason, described.changes.empty() ? "" : "; " + changes_text(described));
  }
}

void write_shaking(std::string& text, const MeasuredShaking& shaking) {
  text += readable("\nshakes\n  {:.3f} m/s^2 at most under the hand `normal`: P99 {:.3f} m/s^2, RMS {:.3f} m/s^2\n",
                   shaking.max, shaking.p99, shaking.rms);
  if (shaking.highest > 0) text += readable("  {:.4g} .. {:.4g} Hz\n", shaking.lowest, shaking.highest);
  text += "\nstability\n  does not apply: it only vibrates, so there is no loop with the hand\n";
}

void write_texture(std::string& text, const Description& description) {
  if (!description.texture) return;
  const DescribedTexture& texture = *description.texture;
  const Relief& force = texture.force;
  text += "\ntexture\n";
  if (force.amplitude > 0) {
    text += readable("  {:.3g} N (the thesis's maximum {:.3g} N, RMS {:.3g} N, mean {:.3g} N)\n", force.amplitude,
                     force.maximum, force.rms, force.mean);
    if (force.regular())
      text += readable("  period {:.3g} mm, {:.0f} % regular, {:.2g} sign changes per millimetre\n", 1e3 * force.period,
                       100 * force.regularity, 1e-3 * force.transitions);
    else if (force.period == 0)
      text += readable("  single features, no period; where they are, they push with up to {:.3g} N\n", force.maximum);
    else
      text += readable("  irregular, about {:.2g} mm; {:.2g} sign changes per millimetre\n", 1e3 * force.period,
                       1e-3 * force.transitions);
    text += readable("  anisotropy {:.1f}{}\n", force.anisotropy,
                     force.oriented() ? readable(", changes along the direction {} from x",
                                                 in_degrees(readable("{}", degrees(force.orientation))))
                                      : "");
    // A texture in a part of the patch is found as several waves of one period.
    std::vector<ReliefWave> waves;
    for (const ReliefWave& wave : force.waves) {
      const auto same = std::ranges::find_if(waves, [&](const ReliefWave& each) {
        constexpr double near = 0.02;
        return std::abs(wave.period - each.period) < near * each.period &&
               std::abs(std::remainder(wave.orientation - each.orientation, std::numbers::pi)) < near;
      });
      if (same == waves.end())
        waves.push_back(wave);
      else
        same->share += wave.share;
    }
    if (waves.size() > 1)
      for (const ReliefWave& wave : waves)
        text += readable("  {:.0f} % of it has a period of {:.2g} mm along {}\n", 100 * wave.share, 1e3 * wave.period,
                         in_degrees(readable("{}", degrees(wave.orientation))));
    if (const auto& met = texture.encoder_pattern)
      text += readable(
          "  too fine for the encoder of `{}`, through which it is {}\n", description.device.name,
          std::isfinite(met->period) ? readable("a pattern of {:.3g} mm", 1e3 * met->period) : "the same everywhere");
    if (!texture.texture_class.empty()) text += readable("  people would call it {}\n", texture.texture_class);
    if (!texture.felt_as.empty())
      text += readable("  period {:.3g} mm: felt as {}\n", 1e3 * texture.named_by, texture.felt_as);
  } else {
    const std::string& why = texture.kind.empty() ? description.no_texture : texture.kind;
    text += readable("  none{}{}\n", why.empty() ? "" : ": ", why);
  }
  // People were asked of what never pushes too, but nobody who reads this asks whether nothing is a texture.
  if (description.force.max_newton == 0 && force.amplitude == 0) return;
  if (texture.confidence_mean)
    text += readable("  confidence that it is a texture: {:.0f} % (s.d. {:.0f} %; {})\n",
                     100 * *texture.confidence_mean, 100 * texture.confidence_spread.value_or(0), texture.source);
  else if (!texture.confidence.empty())
    text += readable("  confidence that it is a texture: {} ({})\n", texture.confidence, texture.source);
}

/// Over every hand, every parameter and every size of patch that the runtime allows.
std::string bound_lines(const Description& description) {
  const ForceBound& bound = description.bound;
  std::string line;
  if (bound.found.newton >= 0.5 * description.device.force_step())
    line = readable(
        "  over all parameters, sizes of the patch and hands, the largest force found is {:.3f} N; the proved bound is "
        "{:.2f} times that\n",
        bound.found.newton, bound.ratio());
  if (!description.limit_matters) return line;
  constexpr double told_newtons = 1e6;  // a larger number tells nothing more
  const double most = description.device.force_newton, asked = description.asked.largest();
  if (asked > most)
    line += readable(
        "  limited by the compiler: the formulas may ask for {} along x or y, and `{}` gives {:.4g} N.\n"
        "  Limiting x and y separately turns the force; `force = … limit {:.4g} N` keeps its direction\n",
        asked < told_newtons ? with_digits(asked, 3) + " N" : "any force", description.device.name, most, most);
  if (description.asked.maybe_nan)
    line += "  limited by the compiler: where its formulas give no number, the force is 0\n";
  return line;
}

/// Of a direction in [0, 2 pi), in rad.
long whole_degrees(double angle) { return std::lround(angle * 180 / std::numbers::pi) % 360; }

/// "goes with time, half of it after 3 s".
std::string coming_words(const ComingForce& coming) {
  const char* const does = coming.goes ? "goes" : "comes";
  return coming.after > 0 ? readable("{} with time, half of it after {:.3g} s", does, coming.after)
                          : readable("{} with time", does);
}

/// "; a push of 2 N towards 0 degrees comes after 12 s", or a swing: of what was looked for after the first seconds.
std::string found_later_words(const Description& description) {
  const ComingForce& coming = description.coming;
  if (coming.later_swing > 0 && description.other.slowly == 0)
    return readable("; a swing of {:.3g} N{} comes after {:.3g} s", coming.later_swing,
                    coming.later_rate > 0 ? readable(" at {:.3g} Hz", coming.later_rate) : "", coming.after);
  const glm::dvec2 push = coming.later_push;
  if (push == glm::dvec2(0) || description.other.slowly > 0) return {};
  const double angle = std::fmod(std::atan2(push.y, push.x) + 2 * std::numbers::pi, 2 * std::numbers::pi);
  return readable(
      "; a push of {:.3g} N {}{} after {:.3g} s", glm::length(push),
      description.coming.goes ? "" : readable("towards {} ", in_degrees(readable("{}", whole_degrees(angle)))),
      description.coming.goes ? "goes" : "comes", description.coming.after);
}

/// What resists along one axis, what pushes everywhere alike, and what no percept tells.
std::string other_forces(const Description& description) {
  std::string text;
  for (const Description::Directed& each : description.directed) {
    if (!each.size.directed()) {
      text += readable("  {} {:.3g} {} in all directions: it pushes on\n", each.name, each.size.greatest, each.unit);
      continue;
    }
    const double across = std::abs(each.size.across) < 0.01 * std::abs(each.size.greatest) ? 0 : each.size.across;
    const long angle = degrees(std::atan2(each.size.axis.y, each.size.axis.x) + std::numbers::pi);
    const std::string way = angle == 0    ? "x"
                            : angle == 90 ? "y"
                                          : in_degrees(readable("the direction {}", angle)) + " from x";
    text += readable("  {} {:.3g} {} along {}, {} across\n", each.name, each.size.greatest, each.unit, way,
                     across == 0 ? std::string("none") : readable("{:.3g} {}", across, each.unit));
  }
  // What the device cuts is told with its bounds.
  constexpr double plainly_less = 0.99;
  if (description.spring_force > 0 && description.spring_force < plainly_less * description.device.most())
    text += description.spring_beyond > 0
                ? readable("  a part of the spring ends at {:.3g} N: beyond, {:.3g} N/m are left\n",
                           description.spring_force, description.spring_beyond)
                : readable("  a spring whose force ends at {:.3g} N\n", description.spring_force);
  if (description.swirl != 0)
    text += readable("  a swirl of {:.3g} N/m, which turns a resting hand {}\n", std::abs(description.swirl),
                     description.swirl > 0 ? "counterclockwise" : "clockwise");
  if (description.rest)
    text += readable("  its spring pulls to {:.3g} mm, {:.3g} mm from the middle\n", 1e3 * description.rest->x,
                     1e3 * description.rest->y);
  if (const glm::dvec2 push = description.constant_push; push != glm::dvec2(0))
    text +=
        readable("  a {} of {:.3g} N towards {}\n",
                 description.rest ? "push in the middle" : "constant push", std::hypot(push.x, push.y),
                 in_degrees(readable("{:.0f}", std::round(std::atan2(push.y, push.x) * 180 / std::numbers::pi) + 0.0)));
  if (description.sway.amplitude > 0)
    text += readable("  a sway of {:.3g} N at {:.3g} Hz, which no percept tells\n", description.sway.amplitude,
                     description.sway.frequency);
  text += parts_line("sway", description.sway.parts) + parts_line("vibration", description.vibration_parts);
  if (description.sway.course) text += course_line("sway", *description.sway.course);
  if (description.vibration_course) text += course_line("vibration", *description.vibration_course);
  if (description.noise.amplitude > 0)
    text += readable("  up to {:.3g} N that changes with time without a rate, which no percept tells\n",
                     description.noise.amplitude);
  if (description.travel)
    text += readable("  a pattern that travels towards {}\n",
                     in_degrees(readable("{}", whole_degrees(*description.travel))));
  text += uneven_line(description.uneven) + motion_lines(description.motion) + mass_lines(description.mass) +
          held_lines(description.held);
  if (description.small_feature > 0)
    text += readable("  up to {:.3g} N in less than a hundredth of the patch, which no percept tells\n",
                     description.small_feature);
  const OtherForce& other = description.other;
  if (other.button > 0) text += readable("  up to {:.3g} N by the button, which no percept tells\n", other.button);
  if (other.slowly > 0)
    text +=
        readable("  up to {:.3g} N that {}, which no percept tells\n", other.slowly, coming_words(description.coming));
  if (other.remembered > 0)
    text += readable("  up to {:.3g} N by where the hand has been, which no percept tells\n", other.remembered);
  if (other.moving > 0)
    text += readable("  up to {:.3g} N on a hand at 250 mm/s, which no percept tells\n", other.moving);
  if (other.later > 0) text += readable("  {}\n", later_words(other.later) + found_later_words(description));
  if (description.aside > 0)
    text += readable("  {:.3g} N aside on a hand at 200 mm/s, which no percept tells\n", description.aside);
  if (description.unread > 0) text += readable("  up to {:.3g} N that no percept tells\n", description.unread);
  return text;
}

std::string wall_line(const Description::Wall& wall) {
  const double power = wall.face.power;
  const std::string bend = power == 1  ? ""
                           : power > 0 ? readable(" where it is deepest, growing as depth^{:.2g}", power)
                                       : std::string(" where it is deepest, not in proportion to the depth");
  return readable("  a wall {}: {:.3g} N/m{}{}, up to {:.3g} N on a hand that goes {:.3g} mm into it, to {}\n",
                  wall_place(wall.face), wall.face.stiffness, bend,
                  wall.face.preload > 0 ? readable(" from {:.3g} N on", wall.face.preload) : "", wall.depth.newton,
                  1e3 * wall.depth.depth, wall.face.fills ? "its middle" : "the patch's edge");
}

/// A line where the force jumps, and by how much.
std::string step_line(const StaticStep& step) {
  WallFace line;
  line.inward = step.way, line.place = step.offset * step.way + 0.0;
  const double towards = std::round(std::atan2(step.change.y, step.change.x) * 180 / std::numbers::pi) + 0.0;
  return readable("  a step of {:.3g} N towards {}{}, {}\n", glm::length(step.change),
                  in_degrees(readable("{:.0f}", towards)),
                  step.width > 0 ? readable(" within {:.2g} mm", 2e3 * step.width) : "", wall_place(line));
}

void write_pushing(std::string& text, const Description& description) {
  text +=
      readable("\npushes\n  {:.3f} N {} with these parameters; with any, never more than {:.3f} N (proved)\n",
               description.force.max_newton, description.force.may_be_larger ? "is the largest force found" : "at most",
               description.bound.newton);
  const double seconds = description.force.over_seconds;
  text += readable("  on a hand at rest, over the patch{}: P99 {:.3f} N, RMS {:.3f} N\n",
                   seconds > 0 ? readable(" and the first {:.3g} s there", seconds) : "", description.force.p99_newton,
                   description.force.rms_newton);
  if (description.wall) text += wall_line(*description.wall);
  for (const Description::Wall& each : description.more_walls) text += wall_line(each);
  for (const StaticStep& each : description.steps) text += step_line(each);
  text += other_forces(description);
  text += bound_lines(description);
  text += "\nstability\n" + grade_text(description.grade, description.device);
}

/// A program does not store the units of its states; in SI units every figure is unambiguous.
void write_memory(std::string& text, const Description& description) {
  if (description.states.empty() && description.memories.empty()) return;
  text += "\nremembers (in SI units)\n";
  for (const auto& state : description.states)
    text += readable("  {:<12} {:.6g} .. {:.6g}\n", state.name, state.low + 0.0, state.high + 0.0);
  for (const auto& grid : description.memories)
    text += readable("  {:<12} {:.6g} .. {:.6g}, at first {:.6g}; {} x {} cells, {} bytes\n", grid.name, grid.low,
                     grid.high, grid.initial, grid.columns, grid.rows, bytes_of(grid));
}

void write_shown(std::string& text, const Description& description) {
  std::vector<std::string> shown;
  if (description.shows_relief) shown.emplace_back("its relief");
  if (description.shows_colour) shown.emplace_back("its own colours");
  for (const auto& mark : description.marks)
    shown.push_back(fmt::format("{} #{:06x}", mark_word(mark.kind), mark.colour & 0xffffff));
  if (!shown.empty()) text += fmt::format("\nshows\n  {}\n", fmt::join(shown, ", "));
}

}  // namespace

std::string means_words(const DescribedPercept& percept) {
  const LawUncertainty& law = percept.uncertainty;
  const auto& [means, differ_more, people] = percept.intervals;
  return readable("95 % of the means of {}: {}{:.2f} .. {:.2f}{}",
                  law.observers > 0 ? readable("{} people", law.observers) : "groups", differ_more ? "at least " : "",
                  means.low, means.high, law.scatter_assumed ? " (scatter assumed)" : "");
}

std::string people_words(const DescribedPercept& percept) {
  const LawUncertainty& law = percept.uncertainty;
  const std::optional<LevelBounds>& people = percept.intervals.people;
  std::string words = means_words(percept);
  if (!people) return words;
  words += readable("; of single people: {:.2f} .. {:.2f}", people->low, people->high);
  const char* assumed = law.spread_assumed && law.noise_assumed ? "spread and noise"
                        : law.spread_assumed                    ? "spread"
                        : law.noise_assumed                     ? "noise"
                                                                : nullptr;
  return assumed ? words + readable(" ({} assumed)", assumed) : words;
}

std::string description_text(const Description& description) {
  const DeviceProfile& device = description.device;
  std::string text = readable("{}\n  built for {}, {:.3g} {} at {:.4g} Hz\n", heading(description), device.name,
                              device.most(), device.shaker ? "m/s^2" : "N", device.rate);
  write_documentation(text, 2, description.layers.documentation);
  for (const auto& [key, values] : description.layers.representative)
    if (key != "title") text += fmt::format("  {:<12} {}\n", key, fmt::join(values, ", "));
  write_percepts(text, description);
  write_fates(text, description);
  write_texture(text, description);
  if (description.shaking)
    write_shaking(text, *description.shaking);
  else
    write_pushing(text, description);
  write_parameters(text, description);
  write_memory(text, description);
  write_shown(text, description);
  const auto& code = description.code;
  text += readable("\npatch\n  {:.4g} mm x {:.4g} mm, fading over {:.3g} mm at its edge\n",
                   1e3 * description.patch.width, 1e3 * description.patch.height, 1e3 * description.patch.rim);
  text +=
      readable("\nprogram\n  tick {} instructions (cost {}), setup {} ({}), peaks {} ({:.2g} with all points)",
               code.tick, code.tick_cost, code.setup, code.setup_cost, code.peaks, static_cast<double>(code.peak_cost));
  if (code.enter > 0) text += readable(", enter {} ({})", code.enter, code.enter_cost);
  text += readable(", picture {} ({})", code.picture, code.picture_cost);
  if (code.frame > 0) text += readable(", frame {} ({})", code.frame, code.frame_cost);
  text += readable("; {} bytes\n", description.bytes);
  if (description.coarseness > 1)
    text += readable("  its tick costs so much that only one of {} places was sampled{}\n", description.coarseness,
                     description.states.empty() && description.memories.empty()
                         ? ""
                         : ", and its answer to motion was not measured");
  return text;
}

}  // namespace wale
