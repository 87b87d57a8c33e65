#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/describe/describe_grade.hpp"

namespace wale {
namespace {

std::string heading(const Description& description) {
  for (const auto& [key, values] : description.layers.representative)
    if (key == "title" && !values.empty()) return fmt::format("{} ({})", values.front(), description.material);
  return description.material;
}

void write_percepts(std::string& text, const Description& description) {
  text += "\nfeels\n";
  if (!description.no_percept.empty())
    text += fmt::format("  {}: {}\n", description.percepts.empty() ? "none can be read" : "no roughness",
                        description.no_percept);
  for (const auto& percept : description.percepts) {
    text +=
        fmt::format("  {:<12} {:.2f}   (95 % of the means of {}: {:.2f} .. {:.2f}; magnitude {:.3g})\n", percept.name,
                    percept.level, percept.observers > 0 ? fmt::format("{} people", percept.observers) : "groups",
                    percept.low, percept.high, percept.magnitude);
    text += fmt::format("  {:<12} {} {:.4g} {}{}\n", "", percept.carrier, percept.amplitude, percept.unit,
                        percept.asked       ? fmt::format(", solved for {} {:.3g}", percept.name, *percept.asked)
                        : percept.blended   ? ", solved for the levels of its components"
                        : percept.extracted ? ", read from the force"
                                            : ", written by the author");
    if (percept.individual_high > percept.high * 1.005)
      text += fmt::format("  {:<12} 95 % of single people: {:.2f} .. {:.2f}\n", "", percept.individual_low,
                          percept.individual_high);
    if (percept.near_threshold) text += fmt::format("  {:<12} near or below threshold\n", "");
    if (percept.saturated)
      text += fmt::format("  {:<12} saturated: `{}` cannot {} harder\n", "", description.device.name,
                          description.shaking ? "shake" : "push");
    if (!percept.realisation.empty())
      text += fmt::format("  {:<12} {}`{}` renders it as {}\n", "",
                          description.shaking ? "" : "the author wrote no physics: ", description.device.name,
                          percept.realisation);
    if (percept.outside_validity) text += fmt::format("  {:<12} outside the range that was measured\n", "");
    if (!percept.alone && !percept.extracted)
      text += fmt::format("  {:<12} other {} too, so a run cannot read it back\n", "",
                          description.shaking ? "percepts shake it" : "forces push");
    text += fmt::format("  {:<12} evidence: slope {}, anchor {}, handle {}\n", "", evidence_word(percept.slope),
                        evidence_word(percept.anchor), evidence_word(percept.handle));
    text += fmt::format("  {:<12} {} ({}, on {})\n", "", percept.source, percept.map, percept.device);
  }
}

std::string range_text(const Parameter& parameter, float low, float high) {
  return fmt::format("{} .. {}{}{}", shown(low, parameter.unit_in_si), shown(high, parameter.unit_in_si),
                     parameter.unit.empty() ? "" : " ", parameter.unit);
}

void write_parameters(std::string& text, const std::vector<Parameter>& parameters) {
  text += "\nparameters\n";
  if (parameters.empty()) text += "  none\n";
  std::size_t width = 12;
  for (const auto& parameter : parameters) width = std::max(width, parameter.name.size());
  for (const auto& parameter : parameters) {
    const bool usual = parameter.soft_low != parameter.low || parameter.soft_high != parameter.high;
    text += fmt::format("  {:<{}} {:<12} {:<20} {}\n", parameter.name, width,
                        fmt::format("{} {}", shown(parameter.value, parameter.unit_in_si), parameter.unit),
                        range_text(parameter, parameter.low, parameter.high), parameter.description);
    if (usual)
      text += fmt::format("  {:<{}} {:<12} usually {}\n", "", width, "",
                          range_text(parameter, parameter.soft_low, parameter.soft_high));
  }
}

/// A direction in [0, pi) in whole degrees below 180.
long degrees(double radians) { return std::lround(radians * 180 / std::numbers::pi) % 180; }

/// Writes the fates of the percepts on the device, then those of the physics.
void write_fates(std::string& text, const Description& description) {
  if (description.fates.empty()) return;
  text += fmt::format("\non {}\n", description.device.name);
  for (const DescribedFate& described : description.fates) {
    const FateRecord& each = described.record;
    std::string level;
    if (each.percept && each.fate == Fate::saturated)
      level = fmt::format(" from {:.2f} to {:.2f}", each.asked, each.given);
    // Of a force that no level asked for, nothing was compared: it is only not solved for.
    const std::string reason =
        !each.percept && each.fate == Fate::kept ? "by the material's formulas, not found from a level" : each.reason;
    text += fmt::format("  {:<18} {}{}{}{}{}\n", each.name, fate_word(each.fate), level, reason.empty() ? "" : ": ",
                        reason, described.changes.empty() ? "" : "; " + changes_text(described));
  }
}

void write_shaking(std::string& text, const MeasuredShaking& shaking) {
  text += fmt::format("\nshakes\n  {:.3f} m/s^2 at most under the hand `normal`: P99 {:.3f} m/s^2, RMS {:.3f} m/s^2\n",
                      shaking.max, shaking.p99, shaking.rms);
  if (shaking.highest > 0) text += fmt::format("  {:.4g} .. {:.4g} Hz\n", shaking.lowest, shaking.highest);
  text += "\nstability\n  does not apply: it only vibrates, so there is no loop with the hand\n";
}

void write_texture(std::string& text, const Description& description) {
  if (!description.texture) return;
  const DescribedTexture& texture = *description.texture;
  const Relief& force = texture.force;
  text += "\ntexture\n";
  if (force.amplitude > 0) {
    text += fmt::format("  {:.3g} N (the thesis's maximum {:.3g} N, RMS {:.3g} N, mean {:.3g} N)\n", force.amplitude,
                        force.maximum, force.rms, force.mean);
    if (force.regular())
      text += fmt::format("  period {:.3g} mm, {:.0f} % regular, {:.2g} sign changes per millimetre\n",
                          1e3 * force.period, 100 * force.regularity, 1e-3 * force.transitions);
    else if (force.period == 0)
      text += fmt::format("  single features, no period\n");
    else
      text += fmt::format("  irregular, about {:.2g} mm; {:.2g} sign changes per millimetre\n", 1e3 * force.period,
                          1e-3 * force.transitions);
    text += fmt::format("  anisotropy {:.1f}{}\n", force.anisotropy,
                        force.oriented() ? fmt::format(", changes along the direction {} from x",
                                                       in_degrees(fmt::format("{}", degrees(force.orientation))))
                                         : "");
    if (force.waves.size() > 1)
      for (const ReliefWave& wave : force.waves)
        text += fmt::format("  {:.0f} % of it has a period of {:.2g} mm along {}\n", 100 * wave.share,
                            1e3 * wave.period, in_degrees(fmt::format("{}", degrees(wave.orientation))));
    if (!texture.texture_class.empty()) text += fmt::format("  people would call it {}\n", texture.texture_class);
    if (!texture.size_class.empty() && texture.size_class != "texture")
      text += fmt::format("  period {:.3g} mm: felt as {}\n", 1e3 * force.period,
                          texture.size_class == "transitional" ? "something between a texture and single features"
                                                               : texture.size_class);
  } else {
    text += fmt::format("  none{}\n", texture.kind.empty() ? "" : fmt::format(": {}", texture.kind));
  }
  if (texture.confidence_mean)
    text += fmt::format("  confidence that it is a texture: {:.0f} % (s.d. {:.0f} %; {})\n",
                        100 * *texture.confidence_mean, 100 * texture.confidence_spread.value_or(0), texture.source);
  else if (!texture.confidence.empty())
    text += fmt::format("  confidence that it is a texture: {} ({})\n", texture.confidence, texture.source);
}

/// Over every hand, every parameter and every size of patch that the runtime allows.
std::string bound_lines(const Description& description) {
  const ForceBound& bound = description.bound;
  std::string line = fmt::format("  proved never to push harder than {:.3f} N at any parameters", bound.newton);
  if (bound.found.newton > 0)
    line += fmt::format(", {:.2f} times the largest force found ({:.3f} N)", bound.ratio(), bound.found.newton);
  line += "\n";
  if (!description.limit_matters) return line;
  const double most = description.device.force_newton, asked = description.asked.largest();
  if (asked > most)
    line += fmt::format(
        "  limited by the compiler: the formulas may ask for {} along x or y, and `{}` gives {:.4g} N.\n"
        "  Limiting x and y separately turns the force; `force = … limit {:.4g} N` keeps its direction\n",
        std::isfinite(asked) ? with_digits(asked, 3) + " N" : "any force", description.device.name, most, most);
  if (description.asked.maybe_nan)
    line += "  limited by the compiler: where its formulas give no number, the force is 0\n";
  return line;
}

void write_pushing(std::string& text, const Description& description) {
  text += fmt::format(
      "\npushes\n  {:.3f} N at most at these parameters; on a hand at rest, over the patch: P99 {:.3f} N, RMS {:.3f} "
      "N\n",
      description.force.max_newton, description.force.p99_newton, description.force.rms_newton);
  if (const auto& wall = description.wall)
    text += fmt::format(
        "  a wall {}: {:.3g} N/m, up to {:.3g} N on a hand that goes {:.3g} mm into it, to the patch's edge\n",
        wall_place(wall->face), wall->face.stiffness, wall->depth.newton, 1e3 * wall->depth.depth);
  text += bound_lines(description);
  text += "\nstability\n" + grade_text(description.grade, description.device);
}

/// A program does not store the units of its states; in SI units every figure is unambiguous.
void write_memory(std::string& text, const Description& description) {
  if (description.states.empty() && description.memories.empty()) return;
  text += "\nremembers (in SI units)\n";
  for (const auto& state : description.states)
    text += fmt::format("  {:<12} {:.6g} .. {:.6g}\n", state.name, state.low + 0.0, state.high + 0.0);
  for (const auto& grid : description.memories)
    text += fmt::format("  {:<12} {:.6g} .. {:.6g}, at first {:.6g}; {} x {} cells, {} bytes\n", grid.name, grid.low,
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

std::string description_text(const Description& description) {
  const DeviceProfile& device = description.device;
  std::string text = fmt::format("{}\n  built for {}, {:.3g} {} at {:.4g} Hz\n", heading(description), device.name,
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
  write_parameters(text, description.parameters);
  write_memory(text, description);
  write_shown(text, description);
  const auto& code = description.code;
  text += fmt::format("\npatch\n  {:.4g} mm x {:.4g} mm, fading over {:.3g} mm at its edge\n",
                      1e3 * description.patch.width, 1e3 * description.patch.height, 1e3 * description.patch.rim);
  text += fmt::format("\nprogram\n  tick {} instructions (cost {}), setup {} ({}), peaks {} ({:.2g} with all points)",
                      code.tick, code.tick_cost, code.setup, code.setup_cost, code.peaks,
                      static_cast<double>(code.peak_cost));
  if (code.enter > 0) text += fmt::format(", enter {} ({})", code.enter, code.enter_cost);
  text += fmt::format(", picture {} ({})", code.picture, code.picture_cost);
  if (code.frame > 0) text += fmt::format(", frame {} ({})", code.frame, code.frame_cost);
  text += fmt::format("; {} bytes\n", description.bytes);
  if (description.coarseness > 1)
    text += fmt::format("  its tick costs so much that only one of {} places was sampled{}\n", description.coarseness,
                        description.states.empty() && description.memories.empty()
                            ? ""
                            : ", and its answer to motion was not measured");
  return text;
}

}  // namespace wale
