#include "schema/companion.hpp"

#include <dlfcn.h>
#include <link.h>

#include <filesystem>
#include <system_error>

namespace wale {
namespace {

namespace fs = std::filesystem;

/// The folder of the shared library that contains this code; empty if that is the program itself. A library that was
/// loaded by a relative path has none: the present folder may be another one by now.
fs::path own_library_folder() {
  static const char here = 0;
  Dl_info info{};
  void* entry = nullptr;
  if (dladdr1(&here, &info, &entry, RTLD_DL_LINKMAP) == 0 || entry == nullptr) return {};
  const fs::path named = static_cast<const link_map*>(entry)->l_name;
  std::error_code error;
  const fs::path path = named.is_absolute() ? fs::canonical(named, error) : fs::path();
  return error ? fs::path() : path.parent_path();
}

}  // namespace

std::vector<std::string> companion_paths(const std::string& name) {
  std::vector<std::string> paths;
  const auto add = [&](const fs::path& folder) { paths.push_back((folder.lexically_normal() / name).string()); };
  if (const fs::path folder = own_library_folder(); !folder.empty()) add(folder / WALE_FROM_LIBRARIES);
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) return paths;
  for (const char* from : {WALE_FROM_PROGRAMS, "libexec/wale", ""}) add(self.parent_path() / from);
  return paths;
}

}  // namespace wale
