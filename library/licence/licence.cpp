#include "library/licence/licence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/text/resolver.hpp"
#include "schema/regular_file.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

const std::vector<std::string>& shareable() {
  static const std::vector<std::string> all = {
#define WALE_LICENCE(id) id,
#include "library/licence/licences.def"
  };
  return all;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// Whether each part of an expression holds, or one of them.
bool parts_hold(std::string_view text, std::string_view word, bool all) {
  bool any = false;
  for (;;) {
    const std::size_t at = text.find(word);
    const bool holds = may_be_shared(text.substr(0, at));
    if (holds != all) return holds;
    any = holds;
    if (at == std::string_view::npos) return any;
    text.remove_prefix(at + word.size());
  }
}

}  // namespace

bool may_be_shared(std::string_view id) {
  if (id.find(" OR ") != std::string_view::npos) return parts_hold(id, " OR ", false);
  if (id.find(" AND ") != std::string_view::npos) return parts_hold(id, " AND ", true);
  return std::ranges::find(shareable(), trimmed(id)) != shareable().end();
}

std::optional<std::string> nearest_licence(std::string_view id) { return nearest_spelling(std::string(id), shareable()); }

Result<std::string> licence_of_library(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / project_marker).string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::string();
  constexpr std::size_t largest = 1 << 16;  // bytes
  auto text = read_regular_file(path, largest);
  if (!text) {
    text.error().place.name = path;
    return text.error();
  }
  std::string licence;
  std::string_view left = *text;
  for (int number = 1; !left.empty(); ++number) {
    const std::size_t end = left.find('\n');
    const std::string_view line = trimmed(left.substr(0, end));
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    if (line.empty() || line.starts_with("//")) continue;
    const std::string_view value = line.starts_with("licence") ? trimmed(line.substr(7)) : std::string_view{};
    if (value.size() < 3 || value.front() != '"' || value.back() != '"' || !licence.empty())
      return Error{.code = Code::malformed_value,
                   .sentence = fmt::format("line {} is not `licence \"…\"`, once, nor a comment", number),
                   .mend = "write, for example, `licence \"CC0-1.0\"`",
                   .place = {.name = path}};
    licence = value.substr(1, value.size() - 2);
  }
  return licence;
}

}  // namespace wale
