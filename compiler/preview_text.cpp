#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/preview.hpp"
#include "compiler/preview/axis.hpp"

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

/// What the representative layer says under a word, empty when it does not.
std::vector<std::string> said(const Layers& layers, std::string_view word) {
  for (const auto& [name, values] : layers.representative) {
    if (name == word) return values;
  }
  return {};
}

std::string evidence_word(Evidence evidence) {
  constexpr std::array words = {"measured", "published", "estimated", "recalled", "transferred"};
  const auto index = static_cast<std::size_t>(evidence) - 1;
  return index < words.size() ? words[index] : "unknown";
}

/// "roughness: measured (Minsky 1995, figure 19) on sandpaper": the worst of the three grades, and where from.
std::string evidence_of(const PerceptRecord& percept, float amplitude) {
  const Evidence worst = std::max({percept.slope, percept.anchor, percept.handle});
  std::string text = fmt::format("{}: {}", percept.name, evidence_word(worst));
  if (!percept.source.empty()) text += fmt::format(" ({})", percept.source);
  if (!percept.device.empty()) text += " on " + percept.device;
  const bool inside = amplitude >= percept.valid_low && amplitude <= percept.valid_high;
  if (percept.valid_high > percept.valid_low && !inside) text += ", outside the measured range";
  return text;
}

}  // namespace

PreviewText preview_text(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  PreviewText text;
  text.title = joined(said(program.layers, "title"), " ");
  if (text.title.empty()) {
    text.title = program.material;
    std::ranges::replace(text.title, '_', ' ');
  }
  text.names = joined(said(program.layers, "called"), " · ");

  std::vector<std::string> evidence;
  std::vector<bool> is_level(program.parameters.size(), false);
  for (std::size_t i = 0; i < program.percepts.size(); ++i) {
    const PerceptRecord& percept = program.percepts[i];
    const float newton = amplitude(bank, i);
    text.figures.push_back({percept.name, fmt::format("{:.2f}", predict(bank, i, newton).level)});
    text.figures.push_back({percept.carrier, shown_quantity(newton, force_notation(newton))});
    evidence.push_back(evidence_of(percept, newton));
    if (percept.parameter && *percept.parameter < is_level.size()) is_level[*percept.parameter] = true;
  }
  text.evidence = evidence.empty() ? "described by its physics alone: no percept" : joined(evidence, " · ");

  float ceiling = 0;
  for (const Output& output : program.outputs) ceiling = std::max(ceiling, bank.registers()[output.ceiling]);
  text.figures.push_back({"force at most", shown_quantity(ceiling, force_notation(ceiling))});
  for (std::size_t i = 0; i < program.parameters.size(); ++i) {
    const Parameter& parameter = program.parameters[i];
    if (is_level[i]) continue;
    const double value = bank.registers()[program.first_parameter() + i];
    text.figures.push_back({parameter.name, shown_quantity(value, {parameter.unit, 1 / parameter.unit_in_si})});
  }
  return text;
}

}  // namespace wale
