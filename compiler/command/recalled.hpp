#pragma once

#include <set>

#include "compiler/declarations/declarations.hpp"

namespace wale::command {

/// Warns of recalled thresholds, whose publications nobody has looked up, on standard error, sorted by their cues. The
/// warnings have no place in the user's own files.
void print_recalled(const std::set<const Threshold*>& thresholds);

}  // namespace wale::command
