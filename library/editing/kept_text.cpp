#include "library/editing/kept_text.hpp"

#include <algorithm>

namespace wale {
namespace {

struct Replacement {
  std::size_t begin = 0, end = 0;
  std::string replacement;
};

/// Between a setting that is put before the one that begins at `at`, and that one: a new line as its own, or `; `.
std::string parted_at(std::string_view text, std::size_t at) {
  const std::size_t line = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  if (line == std::string_view::npos) return "; ";
  const std::string_view blank = text.substr(line, at - line);
  return blank.find_first_not_of(" \t\r\n") == std::string_view::npos ? std::string(blank) : "; ";
}

}  // namespace

std::string edited(const WrittenPatch& written, const LaidOutPatch& patch, const SettingLines& settings) {
  if (patch.before != written.before || patch.inside != written.inside || patch.verbatim != written.verbatim) return {};
  if (!patch.verbatim.empty()) return written.lead + written.text;
  std::vector<Replacement> edits;
  std::vector<bool> told(settings.size(), false);
  const auto next_of = [&](const std::string& key) {
    for (std::size_t i = 0; i < settings.size(); ++i)
      if (!told[i] && settings[i].first == key) return i;
    return settings.size();
  };
  const WrittenPatch::Part* first = nullptr;
  for (const WrittenPatch::Part& part : written.parts) {
    std::string now;
    if (part.key == "name") {
      now = patch.name;
    } else if (part.key == "made_of") {
      now = patch.made_of;
    } else {
      if (!first || part.begin < first->begin) first = &part;
      if (const std::size_t i = next_of(part.key); i < settings.size()) told[i] = true, now = settings[i].second;
    }
    if (now == part.says) continue;
    if (now.empty()) return {};  // it has gone, and the comments about it cannot be told from others
    edits.push_back({part.begin, part.end, now});
  }
  std::vector<std::string> added;
  if (settings != written.settings)
    for (std::size_t i = 0; i < settings.size(); ++i)
      if (!told[i]) added.push_back(settings[i].second);
  if (!added.empty() && first) {
    const std::string between = parted_at(written.text, first->begin);
    std::string lines;
    for (const std::string& each : added) lines += each + between;
    edits.push_back({first->begin, first->begin, lines});
  } else if (!added.empty()) {
    if (written.has_braces) return {};
    std::string lines;
    for (const std::string& each : added) lines += (lines.empty() ? "" : "; ") + each;
    edits.push_back({written.end, written.end, " { " + lines + " }"});
  }
  // From behind, so that places stay; of two at one place, what is inserted comes first in the text.
  std::ranges::stable_sort(
      edits, [](const Replacement& a, const Replacement& b) { return std::pair(a.begin, a.end) > std::pair(b.begin, b.end); });
  std::string text = written.text;
  for (const Replacement& each : edits) text.replace(each.begin, each.end - each.begin, each.replacement);
  return written.lead + text;
}

bool begins_a_line(std::string_view piece) {
  const std::string_view blank = piece.substr(0, std::min(piece.find_first_not_of(" \t\r\n"), piece.size()));
  return blank.find('\n') != std::string_view::npos;
}

}  // namespace wale
