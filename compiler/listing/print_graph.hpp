#pragma once

#include <string>

#include "compiler/emit/lower.hpp"
#include "compiler/emit/source_lines.hpp"

namespace wale {

/// The single-assignment graph of a lowered material, one value per line, operands first: its number, its rate, its
/// operation and its line of Wale. The rate is constant, setup, or the sections that compute the value at each run
/// (peak, enter, tick, picture, frame, prediction). Values that are not needed are left out and counted.
std::string print_graph(const LoweredMaterial& lowered, const SolvedMaterial& material, const SourceLines& lines);

}  // namespace wale
