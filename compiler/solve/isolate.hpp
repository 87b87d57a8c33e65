#pragma once

#include <optional>

#include "compiler/graph/term.hpp"

namespace wale {

/// The equation `left = right` solved for the one place where the unknown stands, or nothing where its inverse is not
/// known or it stands in several places. `unknown` is a term of `terms`; new terms are added there.
std::optional<TermId> isolate(Terms& terms, TermId left, TermId right, TermId unknown);

}  // namespace wale
