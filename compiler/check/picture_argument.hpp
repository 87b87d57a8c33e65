#pragma once

#include <optional>
#include <string>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// A picture and the size of its pixels: `mask("river.png", scale: 0.5 mm/px)`.
struct PictureArgument {
  std::string written;  ///< "river.png"
  ResolvedFile file;
  double scale = 0;  ///< m
  Span span;         ///< of the file's name
};

/// Reads the arguments of a `mask` or a `picture`, and the file. `what` is "mask" or "picture" in messages. Empty after
/// an error, which is reported: W0303, W0207, W0305, W0501.
std::optional<PictureArgument> picture_argument(const Call& call, Span span, const char* what, const char* example,
                                                const SyntaxTree& tree, const Surroundings& surroundings,
                                                ExpressionChecker& checker);

}  // namespace wale
