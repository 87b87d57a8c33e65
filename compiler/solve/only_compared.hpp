#pragma once

#include <string>

#include "compiler/declarations/percepts.hpp"

namespace wale {

/// What to do where a level is asked of a percept that has none: which verbs tell of finished materials what it is
/// about.
[[gnu::cold]] std::string instead_of_a_level(const Percept& percept);

}  // namespace wale
