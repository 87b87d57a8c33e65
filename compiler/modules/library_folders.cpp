#include "compiler/modules/library_folders.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace wale {

std::vector<std::string> library_folders(std::vector<std::string> given, const char* variable) {
  std::vector<std::string> folders = std::move(given);
  std::string_view rest = variable ? variable : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    folders.emplace_back(folder);
    rest.remove_prefix(std::min(folder.size() + 1, rest.size()));
  }
  std::erase(folders, "");
  return folders;
}

}  // namespace wale
