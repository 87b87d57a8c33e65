#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wale {

/// The number of slips that turn `a` into `b`, ignoring case: a letter inserted, dropped or replaced, or two neighbours
/// swapped, each letter touched once (the optimal string alignment distance).
std::size_t letters_changed(std::string_view a, std::string_view b);

/// The candidate that a reader would take `word` for: the fewest letters changed, and at most a third of them;
/// capitals and two neighbours that changed places count little.
std::optional<std::string> nearest_spelling(std::string_view word, const std::vector<std::string>& candidates);

/// A candidate near to a word.
struct NearSpelling {
  std::string text;
  /// One slip at most, capitals counted, and no other candidate is as near: there is no doubt what was meant.
  bool certain = false;
};

/// As `nearest_spelling`, and whether it is the only candidate.
std::optional<NearSpelling> near_spelling(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace wale
