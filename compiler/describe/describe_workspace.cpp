#include "compiler/describe/describe_workspace.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/describe/describe.hpp"
#include "compiler/parse/overloaded.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// Levels that differ by less are shown as one: people do not tell them apart.
constexpr double same_level = 0.02;

/// "roughness 0.35 (asked 0.6), viscosity 0.20"; why there is no percept, if there is none.
std::string feels_line(const Description& description) {
  std::string line;
  for (const DescribedPercept& each : description.percepts) {
    if (!line.empty()) line += ", ";
    line += each.unknown ? readable("{} unknown", each.name) : readable("{} {:.2f}", each.name, each.level);
    if (each.asked && (each.unknown || std::abs(*each.asked - each.level) >= same_level))
      line += readable(" (asked {:.2f})", *each.asked);
  }
  return line.empty() ? description.no_percept : line;
}

/// "low 2 mm, high 4 mm": the ends of a mark in the unit of its slider.
std::string ends_of(const DescribedMark& described) {
  const SliderMark& mark = described.mark;
  std::vector<std::string> ends;
  for (const auto& [name, end] : {std::pair{"low", mark.low}, {"high", mark.high}})
    if (end)
      ends.push_back(
          readable("{} {:.4g}{}", name, *end / described.unit_in_si, mark.unit.empty() ? "" : " " + mark.unit));
  return fmt::format("{}", fmt::join(ends, ", "));
}

/// The text with spaces up to that many bytes; the names of patches are ASCII.
std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

/// How the patches lie, and the declared rules that this does not keep.
nlohmann::ordered_json layout_json(const WorkspaceDescription& description) {
  nlohmann::ordered_json layout{{"textures", description.layout.textures}};
  if (description.layout.gap) layout["narrowest_gap_m"] = *description.layout.gap;
  if (description.layout.element) layout["smallest_m"] = *description.layout.element;
  layout["rules_not_kept"] = description.rules;
  return layout;
}

}  // namespace

std::string outline_text(const Outline& outline) {
  return std::visit(
      Overloaded{
          [](const RectangleOutline&) -> std::string { return "rectangle"; },
          [](const EllipseOutline&) -> std::string { return "ellipse"; },
          [](const PolygonOutline& polygon) { return fmt::format("polygon, {} corners", polygon.corners.size()); },
          [](const MaskOutline& mask) {
            return mask.colour.empty() ? fmt::format("mask {}", mask.file)
                                       : fmt::format("colour {} of {}", mask.colour, mask.file);
          },
      },
      outline);
}

WorkspaceDescription describe_workspace(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid,
                                        const std::string& device, const Declarations& declarations) {
  WorkspaceDescription description{workspace.name, workspace.documentation, device, {}, {}, {}};
  std::map<const Program*, std::string> known;
  for (const LaidPatch& each : laid) {
    const auto [feels, is_new] = known.try_emplace(each.program.get());
    if (is_new)
      feels->second = feels_line(describe(
          Bank(*each.program, each.program->default_parameters(), each.program->default_size()), declarations));
    const CheckedPatch& patch = *each.patch;
    DescribedPatch described{patch.name,         patch.made_of, patch.at, each.size,
                             outline_text(patch.outline), feels->second, {}};
    const auto& parameters = each.program->description().parameters;
    for (const SliderMark& mark : patch.marks) {
      const auto parameter = std::ranges::find(parameters, mark.slider, &Parameter::name);
      const bool has_unit = !mark.is_percept && parameter != parameters.end();
      described.marks.push_back({mark, has_unit ? parameter->unit_in_si : 1.0});
    }
    description.patches.push_back(std::move(described));
  }
  const DeviceDeclaration* declared = declarations.devices.find(device);
  if (declared == nullptr || !declared->profile.has_position()) return description;
  description.layout = layout_figures(laid, Ground(laid, 0.5 * declared->profile.workspace_diameter));
  for (const BrokenRule& each : broken_rules(description.layout, declarations))
    description.rules.push_back(rule_words(each));
  return description;
}

std::string workspace_text(const WorkspaceDescription& description) {
  const std::size_t count = description.patches.size();
  std::string text = readable("workspace {} on {}: {} patch{}{}\n", description.name, description.device, count,
                              count == 1 ? "" : "es", count > 1 ? ", the last in front" : "");
  if (!description.documentation.empty()) text += readable("  {}\n", description.documentation);
  std::size_t widest = 0;
  for (const DescribedPatch& each : description.patches) widest = std::max(widest, each.name.size());
  for (const DescribedPatch& each : description.patches) {
    text += readable("  {}  at {:.4g} mm, {:.4g} mm; {:.4g} mm x {:.4g} mm {}, rim {:.3g} mm\n",
                     padded(each.name, widest), 1e3 * each.at[0], 1e3 * each.at[1], 1e3 * each.size.width,
                     1e3 * each.size.height, each.shape, 1e3 * each.size.rim);
    text += fmt::format("  {}  {}: {}\n", padded("", widest), each.made_of, each.feels);
    for (const DescribedMark& described : each.marks)
      text += fmt::format("  {}  marked: {}, {}{}\n", padded("", widest), described.mark.slider, ends_of(described),
                          described.mark.says.empty() ? "" : fmt::format(", \"{}\"", described.mark.says));
  }
  const LayoutFigures& layout = description.layout;
  if (layout.textures > 1) {
    text += readable("  {} textures", layout.textures);
    if (layout.gap)
      text += *layout.gap > 0 ? readable(", the narrowest gap {:.2g} mm", 1e3 * *layout.gap) : ", some edge to edge";
    if (layout.element) text += readable(", the smallest {:.3g} mm wide", 1e3 * *layout.element);
    text += "\n";
  }
  for (const std::string& rule : description.rules) text += fmt::format("  not kept, {}\n", rule);
  return text;
}

std::string workspaces_json(const std::vector<WorkspaceDescription>& descriptions) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const WorkspaceDescription& each : descriptions) {
    nlohmann::ordered_json patches = nlohmann::ordered_json::array();
    for (const DescribedPatch& patch : each.patches) {
      nlohmann::ordered_json marks = nlohmann::ordered_json::array();
      for (const DescribedMark& described : patch.marks) {
        const SliderMark& mark = described.mark;
        nlohmann::ordered_json entry{{"slider", mark.slider}, {"is_percept", mark.is_percept}};
        if (mark.low) entry["low_si"] = *mark.low;
        if (mark.high) entry["high_si"] = *mark.high;
        if (!mark.says.empty()) entry["says"] = mark.says;
        marks.push_back(std::move(entry));
      }
      patches.push_back({{"name", patch.name},
                         {"made_of", patch.made_of},
                         {"x_m", patch.at[0]},
                         {"y_m", patch.at[1]},
                         {"width_m", patch.size.width},
                         {"height_m", patch.size.height},
                         {"rim_m", patch.size.rim},
                         {"shape", patch.shape},
                         {"feels", patch.feels},
                         {"marks", std::move(marks)}});
    }
    all.push_back({{"workspace", each.name},
                   {"documentation", each.documentation},
                   {"device", each.device},
                   {"patches", std::move(patches)},
                   {"layout", layout_json(each)}});
  }
  return json_lines(all.size() == 1 ? all.front() : all);
}

}  // namespace wale
