#include "library/by_name/missing_folder.hpp"

#include <filesystem>

#include "schema/name_text.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// What is wrong with a folder; an empty sentence if nothing is.
Error wrong_with(const std::string& folder) {
  std::error_code ignored;
  const std::string shown = "`" + visible_text(folder) + "`";
  if (folder.empty()) return {.sentence = "expected a folder, found an empty text", .mend = "write \".\" for the current one"};
  if (std::filesystem::is_directory(folder, ignored)) return {};
  if (std::filesystem::exists(folder, ignored))
    return {.sentence = shown + " is a file, and no folder", .mend = "name the folder that it is in"};
  return {.sentence = "no such folder: " + shown, .mend = "make it first, or leave it out"};
}

}  // namespace

std::optional<Error> missing_folder(const std::vector<std::string>& folders, const std::string& argument) {
  for (const std::string& each : folders) {
    if (auto possible = is_path_text(argument, each); !possible) return std::move(possible.error());
    Error error = wrong_with(each);
    if (error.sentence.empty()) continue;
    error.code = Code::unreadable_file;
    error.place = {.name = argument, .text = each};
    return error;
  }
  return std::nullopt;
}

std::vector<std::string> whole_paths(std::vector<std::string> folders) {
  for (std::string& each : folders) {
    std::error_code why;
    const std::filesystem::path whole = std::filesystem::absolute(each, why);
    if (!each.empty() && !why) each = whole.string();
  }
  return folders;
}

}  // namespace wale
