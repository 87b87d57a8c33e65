#include "library/store/read_library.hpp"

#include <atomic>

#include "library/index/content_hash.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {

ReadFile read_library_file(const LibraryFile& file, const FileRequest& request) {
  ReadFile result;
  // Before it is read: what changes meanwhile is found changed the next time.
  result.rests_on.emplace_back(file.path, hash_of_file(file.path));
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
  result.entries = std::move(read->entries);
  return result;
}

std::vector<Entry> read_library(const std::vector<LibraryFile>& files, const FileRequest& request,
                                const StoreProgress& tell) {
  std::vector<ReadFile> read(files.size());
  std::atomic<std::size_t> next{0}, done{0};
  in_parallel(files.size(), [&](std::size_t, std::size_t) {
    for (std::size_t i; (i = next.fetch_add(1)) < files.size();) {
      read[i] = read_library_file(files[i], request);
      const std::size_t count = ++done;
      if (tell) tell(count, files.size());
    }
  });
  std::vector<Entry> entries;
  for (ReadFile& each : read)
    for (Entry& entry : each.entries) entries.push_back(std::move(entry));
  return entries;
}

}  // namespace wale
