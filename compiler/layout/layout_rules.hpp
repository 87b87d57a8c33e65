#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/layout/ground.hpp"

namespace wale {

/// The figures of a layout to which rules apply (`rule`, `classifies layout`): how many textures, the narrowest gap
/// between two of them (0 if they touch) and the narrowest element, m.
struct LayoutFigures {
  std::size_t textures = 0;
  std::optional<double> gap, element;
};

LayoutFigures layout_figures(const std::vector<LaidPatch>& laid, const Ground& ground);

/// A declared rule that a layout breaks.
struct BrokenRule {
  const Rule* rule;
  const Rule::Case* broken;
};
std::vector<BrokenRule> broken_rules(const LayoutFigures& figures, const Declarations& declarations);

/// "made for a fingertip: at least 1/8 inch between two elements (Hasty)".
std::string rule_words(const BrokenRule& broken);

/// What a declared rule says of a size of "textures", "gap" or "element", SI, with what it was made for: "made for a
/// fingertip: at least 3.2 mm between two (Hasty)". Empty if none says anything.
std::string layout_rule(std::string_view quantity, double size, const Declarations& declarations);

}  // namespace wale
