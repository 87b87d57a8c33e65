#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/describe/describe.hpp"
#include "compiler/drawing/axis.hpp"
#include "compiler/preview/preview.hpp"
#include "compiler/read/read.hpp"

namespace wale {
namespace {

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += between;
    text += word;
  }
  return text;
}

/// The entries of the representative layer under a key; empty if there are none.
std::vector<std::string> said(const Layers& layers, std::string_view word) {
  for (const auto& [name, values] : layers.representative) {
    if (name == word) return values;
  }
  return {};
}

/// "roughness: measured (Minsky 1995, figure 19) on sandpaper, 95 % of the means of 15 people: 0.48 .. 0.75": the
/// worst of the three grades, its source and its interval, in the words and with the marks of `wale describe`.
std::string evidence_of(const DescribedPercept& percept) {
  std::string text = fmt::format("{}: {}", percept.name, evidence_word(percept.evidence()));
  if (!percept.source.empty()) text += fmt::format(" ({})", percept.source);
  if (!percept.device.empty()) text += " on " + percept.device;
  if (percept.intervals.means.low < percept.intervals.means.high) text += ", " + means_words(percept);
  if (percept.saturated) text += ", limited by the device";
  for (const OutsideRange& each : percept.outside) text += ", " + outside_in_words(each);
  return text;
}

/// Forces in N or mN, other sizes in the unit of their carrier.
Notation notation_of(const DescribedPercept& percept) {
  if (percept.unit == "N") return force_notation(percept.amplitude);
  return {percept.unit == "m/s^2" ? "m/s²" : percept.unit, 1};
}

/// Leaves as many figures as there is room for, the maximum among them, and says how many are left out.
void keep_what_fits(std::vector<PreviewText::Figure>& figures) {
  constexpr std::size_t room = 6;
  if (figures.size() <= room) return;
  const auto maximum =
      std::ranges::find_if(figures, [](const auto& each) { return each.word.starts_with("maximum "); });
  if (maximum != figures.end() && maximum - figures.begin() >= static_cast<std::ptrdiff_t>(room) - 1) {
    const PreviewText::Figure kept = *maximum;
    figures.erase(maximum);
    figures.insert(figures.begin() + room - 2, kept);
  }
  const std::size_t left_out = figures.size() - room + 1;
  figures.resize(room - 1);
  figures.push_back({"in `wale describe`", fmt::format("{} more", left_out)});
}

}  // namespace

PreviewText preview_text(const Bank& bank, const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  PreviewText text;
  text.title = joined(said(program.layers, "title"), " ");
  if (text.title.empty()) {
    text.title = program.material;
    std::ranges::replace(text.title, '_', ' ');
  }
  text.names = joined(said(program.layers, "called"), " · ");

  const Description description = describe(bank, declarations, Texture::as_set);
  std::vector<std::string> evidence;
  std::vector<PreviewText::Figure> others;
  for (const DescribedPercept& percept : description.percepts) {
    const bool otherwise = percept.asked && !(std::abs(*percept.asked - percept.level) < 0.005);
    text.figures.push_back(
        {percept.name, percept.unknown ? fmt::format("unknown, asked {:.2f}", percept.asked.value_or(0))
                       : otherwise     ? fmt::format("{:.2f}, asked {:.2f}", percept.level, *percept.asked)
                                       : fmt::format("{:.2f}", percept.level)});
    // Of a level that is unknown, the size is that of no carrier that was read.
    if (!percept.unknown)
      others.push_back({percept.carrier, shown_quantity(percept.amplitude, notation_of(percept))});
    evidence.push_back(evidence_of(percept));
    const Percept* declared = declarations.percepts.find(percept.name);
    if (declared && declared->extractor == Extractor::lateral_force && !percept.unknown)
      text.felt = std::max(text.felt.value_or(0), percept.level);
  }
  text.evidence = evidence.empty() ? "physics only, without a percept" : joined(evidence, " · ");
  if (description.shaking)
    text.figures.push_back({"maximum shaking", shown_quantity(description.shaking->max, {"m/s²", 1})});
  else
    text.figures.push_back(
        {"maximum force", shown_quantity(description.force.max_newton, force_notation(description.force.max_newton))});
  if (description.wall)
    text.figures.push_back({"wall " + wall_place(description.wall->face),
                            fmt::format("to {}", shown_quantity(description.wall->depth.newton, {"N", 1}))});
  text.figures.insert(text.figures.end(), others.begin(), others.end());

  std::vector<bool> is_level(program.parameters.size(), false);
  for (const PerceptRecord& percept : program.percepts) {
    if (percept.parameter) is_level[*percept.parameter] = true;
  }
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    const Parameter& parameter = description.parameters[i];
    if (is_level[i]) continue;
    text.figures.push_back(
        {parameter.name, shown_quantity(parameter.value, {parameter.unit, 1 / parameter.unit_in_si})});
  }
  keep_what_fits(text.figures);
  return text;
}

}  // namespace wale
