#pragma once

#include <string>

#include "compiler/emit/source_lines.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// A material as `check` leaves it, all in SI units: parameters, states and memories with their ranges, the percepts
/// asked for, the carriers that tell of percepts, and every expression with functions inlined and vectors taken apart.
///
/// What is used more than once is a line of its own, `t12 = …`, so that sharing shows; `?0` is the quantity that is
/// left open for `solve`.
std::string print_checked(const CheckedMaterial& material, const DimensionNames& dimensions, const SourceLines& lines);

}  // namespace wale
