#include "library/by_name/missing_folder.hpp"

#include <filesystem>

#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// What is wrong with a folder; an empty sentence if nothing is.
Error wrong_with(const std::string& folder) {
  std::error_code ignored;
  const std::string shown = "`" + visible_text(folder) + "`";
  if (folder.empty()) return {.sentence = "expected a folder, found an empty text", .mend = "write \".\" for the current one"};
  if (folder.find('\0') != std::string::npos)
    return {.sentence = "expected a path, found a zero byte in it", .mend = "hand over the text up to there"};
  if (std::filesystem::is_directory(folder, ignored)) return {};
  if (std::filesystem::exists(folder, ignored))
    return {.sentence = shown + " is a file, and no folder", .mend = "name the folder that it is in"};
  return {.sentence = "no such folder: " + shown, .mend = "make it first, or leave it out"};
}

}  // namespace

std::optional<Error> missing_folder(const std::vector<std::string>& folders, const std::string& argument) {
  for (const std::string& each : folders) {
    Error error = wrong_with(each);
    if (error.sentence.empty()) continue;
    error.code = each.find('\0') == std::string::npos ? Code::unreadable_file : Code::invalid_encoding;
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
