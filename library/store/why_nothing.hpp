#pragma once

#include <string>
#include <vector>

#include "compiler/modules/find_materials.hpp"
#include "wale/result.hpp"

namespace wale {

/// Why no material of an index, of a kind unless that is empty, has all of these words, with a proposal: a word that is
/// spelled nearly so, or the percept of which it is a word. Its code is `unknown_name`.
Error why_nothing_is_found(const LibraryIndex& index, const std::vector<std::string>& texts, const std::string& kind);

}  // namespace wale
