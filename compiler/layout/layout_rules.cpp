#include "compiler/layout/layout_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace wale {
namespace {

/// Whether all conditions of a case hold, which a layout thereby breaks.
bool holds(const Rule::Case& each, const Sizes& sizes) {
  return std::ranges::all_of(each.conditions, [&](const Condition& condition) {
    const auto size = sizes.find(condition.quantity);
    return size != sizes.end() && condition.range.holds(size->second);
  });
}

std::vector<BrokenRule> broken_by(const Sizes& sizes, const Declarations& declarations) {
  std::vector<BrokenRule> broken;
  for (const Rule* rule : declarations.rules()) {
    if (rule->classified != Classified::layout) continue;
    for (const Rule::Case& each : rule->cases)
      if (holds(each, sizes)) broken.push_back({rule, &each});
  }
  return broken;
}

}  // namespace

LayoutFigures layout_figures(const std::vector<LaidPatch>& laid, const Ground& ground) {
  LayoutFigures figures;
  std::set<std::string> materials;
  const auto widths = ground.widths();
  for (std::size_t i = 0; i < laid.size(); ++i) {
    if (!(widths[i] > 0)) continue;
    materials.insert(laid[i].patch->made_of);
    const double shorter = std::min<double>(laid[i].size.width, laid[i].size.height);
    const double width = std::min(widths[i] + ground.square(), shorter);
    figures.element = std::min(figures.element.value_or(width), width);
  }
  figures.textures = materials.size();
  const auto differ = [&](const std::pair<int, int>& both) {
    return laid[static_cast<std::size_t>(both.first)].patch->made_of !=
           laid[static_cast<std::size_t>(both.second)].patch->made_of;
  };
  const auto gaps = ground.gaps();
  for (const auto& [both, gap] : gaps)
    if (differ(both)) figures.gap = std::min(figures.gap.value_or(gap), gap);
  for (const auto& [both, crossings] : ground.neighbours())
    if (differ(both) && !gaps.contains(both)) figures.gap = 0;
  return figures;
}

std::vector<BrokenRule> broken_rules(const LayoutFigures& figures, const Declarations& declarations) {
  Sizes sizes{{"textures", static_cast<double>(figures.textures)}};
  if (figures.gap) sizes["gap"] = *figures.gap;
  if (figures.element) sizes["element"] = *figures.element;
  return broken_by(sizes, declarations);
}

std::string rule_words(const BrokenRule& broken) {
  return fmt::format("made for a {}: {} ({})", broken.rule->device, broken.broken->label, broken.rule->source);
}

std::string layout_rule(std::string_view quantity, double size, const Declarations& declarations) {
  const auto broken = broken_by({{std::string(quantity), size}}, declarations);
  return broken.empty() ? std::string() : rule_words(broken.front());
}

}  // namespace wale
