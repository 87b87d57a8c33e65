#include "schema/closest_names.hpp"

#include <algorithm>
#include <utility>

#include "schema/spelling.hpp"

namespace wale {
namespace {

/// Bytes; whoever calls something by a longer name has made no slip, and comparing takes the product of the lengths.
constexpr std::size_t longest_compared = 64;

}  // namespace

std::vector<std::string> closest_names(std::string_view word, const std::vector<std::string>& names, std::size_t most) {
  std::vector<std::string> closest = nearest_spellings(word, names, most);
  std::erase(closest, word);
  if (closest.size() >= most) return closest;
  std::vector<std::pair<std::size_t, std::string>> others;
  for (const std::string& name : names)
    if (name != word && !name.empty() && std::ranges::find(closest, name) == closest.end())
      others.emplace_back(letters_changed(word.substr(0, longest_compared), name.substr(0, longest_compared)), name);
  std::ranges::sort(others);
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (std::size_t i = 0; i < others.size() && closest.size() < most; ++i) closest.push_back(others[i].second);
  return closest;
}

}  // namespace wale
