#pragma once

#include <cstddef>
#include <optional>

#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// What a function does with an argument beyond its size. The name of the dimension with which it is declared says so
/// (schema/units.wale).
enum class FormalUse {
  any,
  place,      ///< `position`: where on a line a texture is looked at, so it changes with the hand
  repeating,  ///< `wavelength`: after which something repeats
  choosing,   ///< `choice`: one of many that are alike, so it is the same everywhere
};

inline FormalUse use_of(const FormalParameter& formal) {
  if (!formal.dimension) return FormalUse::any;
  if (formal.dimension->text == "position") return FormalUse::place;
  if (formal.dimension->text == "wavelength") return FormalUse::repeating;
  return formal.dimension->text == "choice" ? FormalUse::choosing : FormalUse::any;
}

/// The argument of a force function that is the height of its relief: the one that may be of any dimension. Nothing for
/// a force without a relief.
inline std::optional<std::size_t> height_of(const FunctionDecl& function) {
  for (std::size_t i = 0; i < function.parameters.size(); ++i)
    if (!function.parameters[i].dimension && !function.parameters[i].default_value) return i;
  return std::nullopt;
}

}  // namespace wale
