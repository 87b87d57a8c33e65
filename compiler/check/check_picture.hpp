#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// A coloured area of a picture, which becomes a patch.
struct ColouredArea {
  ExprId material;
  std::string colour;  ///< "#c04020"
  Span statement;      ///< `colour "#c04020" = brick`
  Span colour_span;    ///< of the text
  MaskOutline outline;
  std::array<double, 2> at{};  ///< m; the centre of its box, from the workspace's centre
  std::optional<double> rim;   ///< m
};

/// Reads `patches from picture("map.png", scale: 0.3 mm/px) { colour "#c04020" = brick }`, decodes the picture, and
/// finds its areas, in the order of the colours. Reports errors: W0314 for a colour that the picture does not have,
/// W0315 for an area that is too narrow, and those of settings, arguments and pictures; then nothing is laid out. Warns
/// of the share of the picture that has none of the colours (W0434).
std::vector<ColouredArea> check_picture(const PicturePlacing& node, const Declared<WorkspaceDecl>& declared,
                                        const Surroundings& surroundings);

}  // namespace wale
