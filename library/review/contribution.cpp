#include "library/review/contribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "schema/visible_text.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// Why a library cannot hold what was found below a folder; empty if it can.
std::string unfit_because(const fs::directory_entry& entry, int depth) {
  std::error_code trouble;
  const fs::path& path = entry.path();
  const bool of_wale = path.extension() == ".wale";
  if (entry.is_symlink(trouble))
    return of_wale || entry.is_directory(trouble) ? "this is a link, and a library holds files" : "";
  if (entry.is_directory(trouble)) {
    if (depth >= deepest_folder) return fmt::format("more than {} folders lie in one another", deepest_folder);
  } else if (!of_wale) {
    return {};
  } else if (!entry.is_regular_file(trouble)) {
    return "this is no regular file";
  }
  const std::string name = path.filename().string();
  return visible_text(name) == name ? "" : "its name has characters that a terminal obeys";
}

Result<> add_below(const std::string& folder, std::set<std::string>& files, std::map<std::string, std::string>& unfit) {
  const auto unreadable = [&](std::string sentence, std::string mend) {
    return Error{.code = Code::unreadable_file,
                 .sentence = std::move(sentence),
                 .mend = std::move(mend),
                 .place = {.name = folder}};
  };
  std::error_code trouble;
  std::size_t seen = 0;
  for (fs::recursive_directory_iterator at(folder, trouble), end; !trouble && at != end; at.increment(trouble)) {
    if (++seen > most_files) return unreadable(fmt::format("there are more than {} files", most_files), "name a part of it");
    std::error_code ignored;
    const bool is_folder = !at->is_symlink(ignored) && at->is_directory(ignored);
    if (is_folder && at->path().filename() == ".git") {
      at.disable_recursion_pending();
    } else if (std::string why = unfit_because(*at, at.depth()); !why.empty()) {
      unfit.emplace(at->path().string(), std::move(why));
      if (is_folder) at.disable_recursion_pending();
    } else if (!is_folder && at->path().extension() == ".wale") {
      files.insert(at->path().string());
    }
  }
  if (trouble) return unreadable(fmt::format("the folder cannot be read: {}", trouble.message()), "make it readable");
  return {};
}

}  // namespace

Result<Contribution> contribution_of(const std::vector<std::string>& paths) {
  std::set<std::string> files;
  std::map<std::string, std::string> unfit;
  for (const std::string& path : paths) {
    std::error_code trouble;
    if (fs::is_directory(path, trouble)) {
      if (const auto added = add_below(path, files, unfit); !added) return added.error();
    } else if (fs::exists(path, trouble)) {
      files.insert(path);
    } else {
      return Error{.code = Code::unreadable_file,
                   .sentence = "there is no such file or folder",
                   .mend = "name a Wale file or a folder of them",
                   .place = {.name = path}};
    }
  }
  if (files.empty() && unfit.empty())
    return Error{.code = Code::unknown_material,
                 .sentence = "there is no Wale file here",
                 .mend = "name a `.wale` file, or a folder that holds some",
                 .place = {.name = paths.empty() ? std::string() : paths.front()}};
  Contribution all{.files = {files.begin(), files.end()}, .unfit = {}};
  for (const auto& [path, why] : unfit) all.unfit.push_back({path, why});
  return all;
}

}  // namespace wale
