#include "library/store/read_library.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/text/resolver.hpp"
#include "library/index/content_hash.hpp"
#include "library/licence/passing_on.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {

ReadFile read_library_file(const LibraryFile& file, const FileRequest& request, bool to_pass_on) {
  ReadFile result;
  // Before it is read: what changes meanwhile is found changed the next time.
  result.rests_on.emplace_back(file.path, hash_of_file(file.path));
  // The licence of its library may change.
  if (const std::string project = result.rests_on.front().second.empty() ? "" : project_over(file.path); !project.empty()) {
    const std::string path = (std::filesystem::path(project) / project_marker).string();
    result.rests_on.emplace_back(path, hash_of_file(path));
  }
  FileRequest watched = request;
  watched.file = file.path;
  auto read = read_entries(watched, file.module);
  if (!read) {
    Entry& lost = result.entries.emplace_back();
    lost.name = file.module.substr(file.module.rfind('.') + 1), lost.module = file.module, lost.file = file.path;
    lost.device = request.device, lost.trouble = read.error().sentence;
    return result;
  }
  result.uses_names = read->uses_names;
  for (const std::string& path : read->looked_for)
    if (path != file.path) result.rests_on.emplace_back(path, hash_of_file(path));
  if (to_pass_on) result.imports_keep_back = why_imports_keep_back(read->opened);
  result.entries = std::move(read->entries);
  return result;
}

Result<> read_library_files(const std::vector<LibraryFile>& files, const std::vector<std::size_t>& which,
                            const FileRequest& request, bool to_pass_on, const StoreProgress& tell,
                            const std::function<Result<>(std::size_t which, ReadFile read)>& keep) {
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex lock;
  std::optional<Error> trouble;
  in_parallel(which.size(), [&](std::size_t, std::size_t) {
    for (std::size_t i; (i = next.fetch_add(1)) < which.size();) {
      ReadFile read = read_library_file(files[which[i]], request, to_pass_on);
      {
        const std::lock_guard guard(lock);
        if (trouble) return;
        if (const auto kept = keep(which[i], std::move(read)); !kept) trouble = kept.error();
      }
      const std::lock_guard guard(lock);
      if (trouble) return;
      if (tell && !tell(++done, which.size()) && done < which.size())
        trouble = Error{.code = Code::stopped,
                        .sentence = "stopped before the library was read",
                        .mend = "begin again: what was read is kept",
                        .place = {.name = "index"}};
    }
  });
  return trouble ? Result<>(*std::move(trouble)) : Result<>();
}

FileHashes hashes_of(const std::vector<LibraryFile>& files, const std::vector<std::string>& names) {
  FileHashes hashes{std::vector<std::string>(files.size()), {}};
  in_parallel(files.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) hashes.each[i] = hash_of_file(files[i].path);
  });
  ContentHash hash;
  for (std::size_t i = 0; i < files.size(); ++i) hash.take(names[i]).take(hashes.each[i]);
  hashes.all = hash.digits();
  return hashes;
}

std::string HashesOnce::of(const std::string& path) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = known_.find(path); known != known_.end()) return known->second;
  }
  std::string hash = hash_of_file(path);
  const std::lock_guard lock(mutex_);
  return known_.try_emplace(path, std::move(hash)).first->second;
}

std::string rests_on_text(const std::vector<std::pair<std::string, std::string>>& rests_on) {
  using Json = nlohmann::json;
  return Json(rests_on).dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_unchanged(const KnownFile& known, const std::string& module, const std::string& name, const std::string& hash,
                  const std::string& others, HashesOnce& hashes,
                  const std::function<std::string(const std::string& name)>& path_of) {
  if (known.module != module || (!known.others.empty() && known.others != others)) return false;
  const auto rests_on = nlohmann::json::parse(known.rests_on, nullptr, false);
  if (!rests_on.is_array()) return false;
  return std::ranges::all_of(rests_on, [&](const nlohmann::json& each) {
    if (!each.is_array() || each.size() != 2 || !each[0].is_string() || !each[1].is_string()) return false;
    const auto& path = each[0].get_ref<const std::string&>();
    return (path == name ? hash : hashes.of(path_of(path))) == each[1].get_ref<const std::string&>();
  });
}

Result<std::vector<Entry>> read_library(const std::vector<LibraryFile>& files, const FileRequest& request,
                                const StoreProgress& tell) {
  std::vector<std::size_t> all(files.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  std::vector<ReadFile> read(files.size());
  const auto done = read_library_files(files, all, request, false, tell, [&](std::size_t i, ReadFile each) -> Result<> {
    read[i] = std::move(each);
    return {};
  });
  if (!done) {
    Error error = done.error();
    if (error.code == Code::stopped) error.mend = "begin again: no index can be kept, so all is read again";
    return error;
  }
  std::vector<Entry> entries;
  for (ReadFile& each : read)
    for (Entry& entry : each.entries) entries.push_back(std::move(entry));
  return entries;
}

}  // namespace wale
