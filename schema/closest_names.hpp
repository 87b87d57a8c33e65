#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wale {

/// Up to `most` of the names: first those that are near to the word (`nearest_spellings`), then those with the fewest
/// slips from it, so that fewer come back only where fewer exist. Each once, and never the word itself.
std::vector<std::string> closest_names(std::string_view word, const std::vector<std::string>& names,
                                       std::size_t most = 3);

}  // namespace wale
