#include "library/index/library_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "compiler/text/embedded_files.hpp"
#include "compiler/text/resolver.hpp"
#include "library/index/content_hash.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// Names modules as imports of their library name them: by their way from the nearest folder with a `wale.project`, or
/// else from the folder that was named.
class ModuleNames {
 public:
  std::string of(const fs::path& file, const fs::path& named) {
    std::error_code ignored;
    const fs::path whole = fs::absolute(file, ignored).lexically_normal();
    const std::optional<fs::path>& root = root_of(whole.parent_path());
    fs::path way = whole.lexically_relative(root ? *root : fs::absolute(named, ignored).lexically_normal());
    if (way.empty() || way.begin()->string() == "..") way = file.filename();
    std::string module;
    for (const fs::path& part : way.replace_extension()) module += (module.empty() ? "" : ".") + part.string();
    return module;
  }

 private:
  /// The nearest folder with a `wale.project`, of a whole path; each is looked into once.
  const std::optional<fs::path>& root_of(const fs::path& folder) {
    const auto [known, is_new] = roots_.try_emplace(folder.string());
    if (!is_new) return known->second;
    std::error_code ignored;
    std::optional<fs::path> root;
    if (fs::exists(folder / project_marker, ignored))
      root = folder;
    else if (folder != folder.parent_path())
      root = root_of(folder.parent_path());
    return roots_[folder.string()] = std::move(root);
  }

  std::map<std::string, std::optional<fs::path>> roots_;
};

Error nothing_here(const std::string& path, Code code, std::string sentence) {
  return Error{.code = code,
               .sentence = std::move(sentence),
               .mend = "name a `.wale` file, or a folder that holds some",
               .place = {.name = path}};
}

}  // namespace

Result<std::vector<LibraryFile>> library_files_in(const std::vector<std::string>& paths) {
  std::vector<LibraryFile> files;
  if (paths.empty()) {
    for (const EmbeddedFile& each : embedded_files())
      if (!each.common) {
        fs::path way = fs::path(each.name).lexically_relative("library");
        way.replace_extension();
        std::string module;
        for (const fs::path& part : way) module += (module.empty() ? "" : ".") + part.string();
        files.push_back({std::string(each.name), module});
      }
    return files;
  }
  std::set<std::string> seen;
  ModuleNames modules;
  const auto add = [&](const fs::path& file, const fs::path& named) {
    if (seen.insert(file.string()).second) files.push_back({file.string(), modules.of(file, named)});
  };
  for (const std::string& path : paths) {
    std::error_code trouble;
    if (!fs::exists(path, trouble)) return nothing_here(path, Code::unreadable_file, "there is no such file or folder");
    if (!fs::is_directory(path, trouble)) {
      add(path, fs::path(path).parent_path());
      continue;
    }
    for (fs::recursive_directory_iterator at(path, trouble), end; !trouble && at != end; at.increment(trouble))
      if (at->path().extension() == ".wale" && at->is_regular_file(trouble)) add(at->path(), path);
    if (trouble)
      return nothing_here(path, Code::unreadable_file, fmt::format("the folder cannot be read: {}", trouble.message()));
  }
  if (files.empty()) return nothing_here(paths.front(), Code::unknown_material, "there is no Wale file here");
  std::ranges::sort(files, {}, &LibraryFile::path);
  return files;
}

std::vector<LibraryFile> library_files_in(const LibraryIndex& catalogue) {
  std::vector<LibraryFile> files;
  for (const IndexedMaterial& each : catalogue.materials())
    if (each.origin != Origin::hidden) files.push_back({each.file, each.module});
  std::ranges::sort(files, {}, &LibraryFile::path);
  const auto is_same = [](const LibraryFile& a, const LibraryFile& b) { return a.path == b.path; };
  files.erase(std::unique(files.begin(), files.end(), is_same), files.end());
  return files;
}

std::string hash_of_file(const std::string& path) {
  std::error_code trouble;
  if (!fs::is_regular_file(path, trouble)) return {};
  const auto found = read_file(path, largest_asset);
  return found ? ContentHash().take(found->bytes).digits() : std::string();
}

}  // namespace wale
