#include "library/licence/licence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/text/embedded_files.hpp"
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

Result<LibraryProject> project_in(std::string_view left, const std::string& path) {
  LibraryProject project;
  const auto value_of = [](std::string_view line, std::string_view word) -> std::optional<std::string> {
    const std::string_view value = line.starts_with(word) ? trimmed(line.substr(word.size())) : std::string_view{};
    if (value.size() < 3 || value.front() != '"' || value.back() != '"') return std::nullopt;
    return std::string(value.substr(1, value.size() - 2));
  };
  for (int number = 1; !left.empty(); ++number) {
    const std::size_t end = left.find('\n');
    const std::string_view line = trimmed(left.substr(0, end));
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    if (line.empty() || line.starts_with("//")) continue;
    if (auto licence = value_of(line, "licence"); licence && project.licence.empty())
      project.licence = *std::move(licence);
    else if (auto stimuli = value_of(line, "stimuli"))
      project.stimuli.push_back(*std::move(stimuli));
    else if (auto modules = value_of(line, "modules"))
      project.modules.push_back(*std::move(modules));
    else
      return Error{.code = Code::malformed_value,
                   .sentence = fmt::format("line {} is none of `licence \"…\"`, once, `stimuli \"…\"` and "
                                           "`modules \"…\"` with the name of a folder, nor a comment",
                                           number),
                   .mend = "write, for example, `licence \"CC0-1.0\"`",
                   .place = {.name = path}};
  }
  return project;
}

/// Writes out a family that its licence is one of: "CC0" begins "CC0-1.0".
std::optional<std::string> begun_by(std::string_view id) {
  const auto small = [](std::string_view text) {
    std::string folded(text);
    for (char& c : folded)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return folded;
  };
  const std::string word = small(trimmed(id));
  std::optional<std::string> newest;
  for (const std::string& each : shareable())
    // They are in the order of their versions; a longer name is another family, as CC-BY-SA-4.0 beside CC-BY-4.0.
    if (!word.empty() && small(each).starts_with(word + "-") && (!newest || each.size() <= newest->size())) newest = each;
  return newest;
}

}  // namespace

bool may_be_shared(std::string_view id) {
  if (id.find(" OR ") != std::string_view::npos) return parts_hold(id, " OR ", false);
  if (id.find(" AND ") != std::string_view::npos) return parts_hold(id, " AND ", true);
  return std::ranges::find(shareable(), trimmed(id)) != shareable().end();
}

std::optional<std::string> nearest_licence(std::string_view id) {
  if (auto begun = begun_by(id)) return begun;
  return nearest_spelling(std::string(id), shareable());
}

bool LibraryProject::is_apart(std::string_view folder) const {
  const auto has = [&](const std::vector<std::string>& folders) { return std::ranges::find(folders, folder) != folders.end(); };
  return has(stimuli) || has(modules);
}

Result<LibraryProject> project_of_library(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / project_marker).string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return LibraryProject();
  constexpr std::size_t largest = 1 << 16;  // bytes
  auto text = read_regular_file(path, largest);
  if (!text) {
    text.error().place.name = path;
    return text.error();
  }
  return project_in(*text, path);
}

const LibraryProject& shipped_project() {
  static const LibraryProject project = [] {
    for (const EmbeddedFile& each : embedded_assets())
      if (each.name == "library/wale.project")
        if (auto read = project_in(each.text, std::string(each.name))) return *std::move(read);
    return LibraryProject();
  }();
  return project;
}

Result<std::string> licence_of_library(const std::string& folder) {
  auto project = project_of_library(folder);
  if (!project) return project.error();
  return std::move(project->licence);
}

}  // namespace wale
