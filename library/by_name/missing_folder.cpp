#include "library/by_name/missing_folder.hpp"

#include <filesystem>

#include "schema/visible_text.hpp"

namespace wale {

std::optional<Error> missing_folder(const std::vector<std::string>& folders) {
  for (const std::string& each : folders) {
    std::error_code why;
    if (each.empty() || std::filesystem::is_directory(each, why)) continue;
    return Error{.code = Code::unreadable_file,
                 .sentence = "no such folder: `" + visible_text(each) + "`",
                 .mend = "make it first, or leave it out",
                 .place = {.name = "folders", .text = each}};
  }
  return std::nullopt;
}

}  // namespace wale
