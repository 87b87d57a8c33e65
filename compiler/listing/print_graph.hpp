#pragma once

#include <string>

#include "compiler/emit/lower.hpp"
#include "compiler/emit/source_lines.hpp"

namespace wale {

/// The single-assignment graph of a lowered material, a value a line and operands before what uses them: its number,
/// its rate, what it is, its line of Wale. The rate is constant, setup, or the sections that work the value out at each
/// of their runs (peak, enter, tick, picture, frame, prediction). Values that nothing needs are left out and counted.
std::string print_graph(const LoweredMaterial& lowered, const SolvedMaterial& material, const SourceLines& lines);

}  // namespace wale
