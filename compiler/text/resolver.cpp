#include "compiler/text/resolver.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "compiler/text/source.hpp"
#include "schema/regular_file.hpp"
#include "schema/visible_text.hpp"

namespace wale {

namespace fs = std::filesystem;

namespace {

/// A folder with more files than this is not a library; listing stops there.
constexpr std::size_t most_listed = 100'000;

/// Imports are followed recursively; this bounds them.
constexpr std::size_t most_modules = 1000;

Error unreadable(const std::string& path, std::string sentence) {
  return {.code = Code::unreadable_file, .sentence = std::move(sentence), .place = {.name = path}};
}

/// The bytes of all files of one kind that may be read.
class ReadTotal {
 public:
  ReadTotal(std::size_t most, std::string what, std::string mend)
      : most_(most), left_(most), what_(std::move(what)), mend_(std::move(mend)) {}

  /// Reads a file that fits into what is left.
  Result<ResolvedFile> read(const std::string& path, std::size_t largest) {
    std::error_code unknown;
    if (const std::uintmax_t size = fs::file_size(path, unknown); !unknown && size <= largest && size > left_)
      return Error{
          .code = Code::too_much_read,
          .sentence = fmt::format("expected at most {} MB of {}, found {:.1f} MB with `{}`", most_ >> 20, what_,
                                  static_cast<double>(most_ - left_ + size) / (1 << 20), visible_text(path)),
          .mend = mend_,
          .place = {.name = path}};
    auto read = read_file(path, std::min(largest, left_));
    if (read) left_ -= read->bytes.size();
    return read;
  }

 private:
  std::size_t most_, left_;
  std::string what_, mend_;
};

/// The file of a module: "fabric/denim.wale" for "fabric.denim".
std::string file_of(std::string module) {
  std::ranges::replace(module, '.', '/');
  return module + ".wale";
}

class FileResolver final : public Resolver {
 public:
  FileResolver(std::vector<std::string> roots, std::vector<std::string>* looked_for, Sandbox sandbox,
               std::vector<ResolvedFile> devices)
      : roots_(std::move(roots)), looked_for_(looked_for), sandbox_(sandbox), devices_(std::move(devices)) {}

  std::vector<ResolvedFile> devices() override { return devices_; }

  Result<ResolvedFile> module(const std::string& path, const std::string& from) override {
    const auto found = look_for(file_of(path), from);
    if (!found) return found.error();
    if (modules_.size() >= most_modules && !modules_.contains(*found))
      return unreadable(*found, fmt::format("more than {} files would be imported", most_modules));
    modules_.insert(*found);
    return imports_.read(*found, largest_source);
  }

  std::string module_name(const std::string& path, const std::string& from) override {
    const auto found = look_for(file_of(path), from);
    return found ? *found : "";
  }

  Result<ResolvedFile> file(const std::string& name, const std::string& from) override {
    const auto found = look_for(name, from);
    if (!found) return found.error();
    return assets_.read(*found, largest_asset);
  }

  Result<ResolvedFile> listed_module(const std::string& path, const std::string& from) override {
    // A listing is no question about one file: what it says is asked for again where it is used.
    std::vector<std::string>* const told = std::exchange(looked_for_, nullptr);
    const auto found = look_for(file_of(path), from);
    looked_for_ = told;
    if (!found) return found.error();
    return read_file(*found, largest_source);
  }

  Sandbox sandbox() const override { return sandbox_; }

  std::string library(const std::string& from) override {
    std::error_code ignored;
    std::string name = fs::absolute(own_folder(from), ignored).lexically_normal().string();
    for (const auto& root : roots_) name += '\n' + fs::absolute(root, ignored).lexically_normal().string();
    return name;
  }

  std::vector<std::string> modules(const std::string& from) override {
    std::vector<std::string> all;
    for (const ListedModule& each : listed(from))
      if (std::ranges::find(all, each.name) == all.end()) all.push_back(each.name);
    return all;
  }

  std::vector<ListedModule> hidden_modules(const std::string& from) override {
    std::vector<ListedModule> hidden;
    std::map<std::string, std::string> first;  // the path that an import of this name finds
    for (ListedModule& each : listed(from)) {
      const auto [known, is_first] = first.try_emplace(each.name, each.path);
      std::error_code ignored;
      if (!is_first && !fs::equivalent(known->second, each.path, ignored)) hidden.push_back(std::move(each));
    }
    return hidden;
  }

  std::vector<std::string> unreadable_folders(const std::string& from) override {
    unreadable_.clear();
    listed(from);
    return unreadable_;
  }

 private:
  /// The folder of a file's project, or else the folder that contains the file.
  fs::path own_folder(const std::string& from) {
    if (const auto& project = project_of(from)) return *project;
    const fs::path folder = fs::path(from).parent_path();
    return folder.empty() ? fs::path(".") : folder;
  }

  /// All files that `from` could import, hidden ones among them, in the order in which folders are searched.
  std::vector<ListedModule> listed(const std::string& from) {
    std::vector<ListedModule> all;
    list(own_folder(from), project_of(from).has_value(), all);
    for (const auto& root : roots_) list(root, true, all);
    return all;
  }

  /// Adds the modules of a folder in the order of their names; if `whole`, those of its subfolders too.
  void list(const fs::path& folder, bool whole, std::vector<ListedModule>& all) {
    const auto note_unreadable = [&](const fs::path& each) {
      const std::string name = each.lexically_normal().string();
      if (access(name.c_str(), R_OK | X_OK) != 0 && errno == EACCES) unreadable_.push_back(name);
    };
    note_unreadable(folder);
    std::vector<ListedModule> found;
    std::error_code error;
    fs::recursive_directory_iterator each(folder, fs::directory_options::skip_permission_denied, error);
    for (std::size_t seen = 0; !error && each != fs::recursive_directory_iterator() && seen < most_listed; ++seen) {
      const fs::path& path = each->path();
      std::error_code ignored;
      if (each->is_directory(ignored)) {
        if (!whole || path.filename().string().starts_with('.'))
          each.disable_recursion_pending();
        else
          note_unreadable(path);
      } else if (path.extension() == ".wale") {
        std::string module = path.lexically_relative(folder).replace_extension().generic_string();
        // A dot in a module's name would mean a folder.
        if (module.find_first_of(". ") == std::string::npos) {
          std::ranges::replace(module, '/', '.');
          found.push_back({std::move(module), path.lexically_normal().string()});
        }
      }
      each.increment(error);
    }
    std::ranges::sort(found, {}, &ListedModule::name);
    std::ranges::move(found, std::back_inserter(all));
  }

  /// The path of the file that `name` means.
  Result<std::string> look_for(const std::string& name, const std::string& from) {
    std::vector<fs::path> candidates{fs::path(from).parent_path() / name};
    if (const auto project = project_of(from)) candidates.push_back(*project / name);
    for (const auto& root : roots_) candidates.push_back(fs::path(root) / name);
    for (const auto& candidate : candidates) {
      std::error_code ignored;
      if (looked_for_ != nullptr) looked_for_->push_back(candidate.lexically_normal().string());
      if (fs::exists(candidate, ignored)) return candidate.lexically_normal().string();
    }
    std::string searched;
    std::set<std::string> said;  // a folder may occur twice, if the file is in the root of its project
    for (const auto& candidate : candidates)
      if (const auto shown = candidate.lexically_normal().string(); said.insert(shown).second)
        searched += fmt::format("{}`{}`", searched.empty() ? "" : ", ", visible_text(shown));
    const bool is_elsewhere = said.size() > 1 || !said.contains(name);  // otherwise the name says it already
    return unreadable(name, is_elsewhere ? fmt::format("no such file; looked for {}", searched) : "no such file");
  }

  /// The project of a file. Cached by folder, since each import asks for it.
  const std::optional<fs::path>& project_of(const std::string& from) {
    const fs::path folder = fs::path(from).parent_path();
    const auto [known, added] = projects_.try_emplace(folder.string());
    if (!added) return known->second;
    std::error_code ignored;
    fs::path above = fs::absolute(folder.empty() ? fs::path(".") : folder, ignored).lexically_normal();
    fs::path shown = folder.empty() ? fs::path(".") : folder;  // keep names relative if the file's name was
    while (!above.empty()) {
      if (fs::is_regular_file(above / project_marker, ignored)) {
        if (looked_for_ != nullptr) looked_for_->push_back((shown / project_marker).lexically_normal().string());
        known->second = shown;
        break;
      }
      if (above == above.root_path()) break;
      above = above.has_filename() ? above.parent_path() : above.parent_path().parent_path();
      shown /= "..";
    }
    return known->second;
  }

  std::vector<std::string> roots_;
  std::vector<std::string>* looked_for_;
  Sandbox sandbox_;
  std::vector<ResolvedFile> devices_;
  std::map<std::string, std::optional<fs::path>> projects_;
  std::vector<std::string> unreadable_;  ///< of the last listing
  std::set<std::string> modules_;        ///< all modules requested so far
  ReadTotal imports_{most_imported, "imported files", "import fewer or smaller files"};
  ReadTotal assets_{most_assets, "pictures and tables to read", "use fewer or smaller ones"};
};

}  // namespace

Result<ResolvedFile> Resolver::listed_module(const std::string& path, const std::string& from) {
  return file(file_of(path), from);
}

std::unique_ptr<Resolver> file_resolver(std::vector<std::string> roots, std::vector<std::string>* looked_for,
                                        Sandbox sandbox, std::vector<ResolvedFile> devices) {
  return std::make_unique<FileResolver>(std::move(roots), looked_for, sandbox, std::move(devices));
}

Result<ResolvedFile> read_file(const std::string& path, std::size_t largest) {
  auto bytes = read_regular_file(path, largest);
  if (!bytes) return bytes.error();
  return ResolvedFile{path, *std::move(bytes)};
}

}  // namespace wale
