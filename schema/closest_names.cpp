#include "schema/closest_names.hpp"

#include <algorithm>

#include "schema/spelling.hpp"

namespace wale {
namespace {

/// Bytes; whoever calls something by a longer name has made no slip, and comparing takes the product of the lengths.
constexpr std::size_t longest_compared = 64;

/// The least comes first: near names, then the others by their slips.
std::size_t rank(std::string_view word, std::string_view name) {
  constexpr std::size_t not_near = 1000;  // more than a near name has
  if (const auto near = distance_from(word, name)) return *near;
  return not_near + letters_changed(word.substr(0, longest_compared), name.substr(0, longest_compared));
}

}  // namespace

std::vector<std::string> closest_names(std::string_view word, const std::vector<std::string>& names, std::size_t most) {
  std::vector<std::string> closest;
  while (closest.size() < most) {  // sorting would be more code, which is linked wherever a name is asked for
    const std::string* best = nullptr;
    std::size_t least = 0;
    for (const std::string& name : names) {
      const std::size_t here = rank(word, name);
      if (best != nullptr && (here > least || (here == least && name >= *best))) continue;
      if (name != word && !name.empty() && std::find(closest.begin(), closest.end(), name) == closest.end())
        best = &name, least = here;
    }
    if (best == nullptr) break;
    closest.push_back(*best);
  }
  return closest;
}

}  // namespace wale
