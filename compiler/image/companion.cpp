#include "compiler/image/companion.hpp"

#include <filesystem>

namespace wale {

std::vector<std::string> companion_paths(const std::string& name, const std::string& built) {
  std::vector<std::string> paths;
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    const auto folder = self.parent_path();
    paths.push_back((folder / name).string());
    paths.push_back((folder.parent_path() / "libexec" / "wale" / name).string());
  }
  paths.push_back(built);
  return paths;
}

}  // namespace wale
