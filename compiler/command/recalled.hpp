#pragma once

#include <set>

#include "compiler/declarations/declarations.hpp"

namespace wale::command {

/// Warns of thresholds whose publications nobody has looked up, on standard error and in the order of their cues. They
/// have no place in the person's own files.
void print_recalled(const std::set<const Threshold*>& thresholds);

}  // namespace wale::command
