#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/describe/describe.hpp"
#include "compiler/preview/axis.hpp"
#include "compiler/preview/preview.hpp"

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

/// "roughness: measured (Minsky 1995, figure 19) on sandpaper, 95 % of observers' means within 0.48 .. 0.75": the worst
/// of the three grades, its source and its interval.
std::string evidence_of(const DescribedPercept& percept) {
  std::string text = fmt::format("{}: {}", percept.name, evidence_word(percept.evidence()));
  if (!percept.source.empty()) text += fmt::format(" ({})", percept.source);
  if (!percept.device.empty()) text += " on " + percept.device;
  if (percept.low < percept.high)
    text += fmt::format(", 95 % of means within {:.2f} .. {:.2f}", percept.low, percept.high);
  if (percept.saturated) text += ", limited by the device";
  for (const OutsideRange& each : percept.outside)
    text += fmt::format(", outside what was measured ({})", in_words(each));
  return text;
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

  const Description description = describe(bank, declarations, Texture::left_out);
  std::vector<std::string> evidence;
  for (const DescribedPercept& percept : description.percepts) {
    const bool otherwise = percept.asked && std::abs(*percept.asked - percept.level) >= 0.005;
    text.figures.push_back({percept.name, otherwise ? fmt::format("{:.2f}, asked {:.2f}", percept.level, *percept.asked)
                                                    : fmt::format("{:.2f}", percept.level)});
    const Notation notation = percept.unit == "m/s^2" ? Notation{"m/s²", 1} : force_notation(percept.amplitude);
    text.figures.push_back({percept.carrier, shown_quantity(percept.amplitude, notation)});
    evidence.push_back(evidence_of(percept));
  }
  text.evidence = evidence.empty() ? "physics only, without a percept" : joined(evidence, " · ");
  if (description.shaking)
    text.figures.push_back({"maximum shaking", shown_quantity(description.shaking->max, {"m/s²", 1})});
  else
    text.figures.push_back(
        {"maximum force", shown_quantity(description.force.max_newton, force_notation(description.force.max_newton))});

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
  return text;
}

}  // namespace wale
