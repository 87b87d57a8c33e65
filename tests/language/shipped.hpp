#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace wale {

/// The text of a file of the project, by its path in the project. Throws std::runtime_error where there is none.
inline std::string shipped_file(const std::string& name) {
  std::ifstream file(std::filesystem::path(WALE_SOURCE_DIR) / name, std::ios::binary);
  if (!file) throw std::runtime_error("no file " + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Every Wale file that the project ships: its path in the project, and its text.
inline std::vector<std::pair<std::string, std::string>> shipped_files() {
  namespace fs = std::filesystem;
  std::vector<std::pair<std::string, std::string>> files;
  for (const char* folder : {"schema", "calibration", "library", "examples"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".wale") {
        const std::string name = fs::relative(entry.path(), WALE_SOURCE_DIR).string();
        files.emplace_back(name, shipped_file(name));
      }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace wale
