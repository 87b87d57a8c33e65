#pragma once

#include <string>

#include "compiler/emit/source_lines.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// A material after `check`, in SI units: parameters, states and memories with their ranges, the percepts asked for,
/// the carriers of percepts, and every expression with functions inlined and vectors split into components.
///
/// A term that is used more than once has its own line, `t12 = …`. `?0` is the quantity that is left open for `solve`.
std::string print_checked(const CheckedMaterial& material, const DimensionNames& dimensions, const SourceLines& lines);

}  // namespace wale
