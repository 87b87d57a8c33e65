#include "library/store/read_library.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/modules/library_index.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/read/kept_readings.hpp"
#include "compiler/text/resolver.hpp"
#include "library/index/content_hash.hpp"
#include "library/licence/passing_on.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {

ReadFile read_library_file(const LibraryFile& file, const FileRequest& request, bool to_pass_on, KeptReadings* kept) {
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
  auto read = read_entries(watched, file.module, felt_of, kept);
  const auto lose = [&](const Error& error) {
    Entry& lost = result.entries.emplace_back();
    lost.name = file.module.substr(file.module.rfind('.') + 1), lost.module = file.module, lost.file = file.path;
    lost.device = request.device, lost.trouble = error.sentence;
  };
  if (!read) {
    lose(read.error());
    return result;
  }
  result.uses_names = read->uses_names;
  for (const std::string& path : read->looked_for)
    if (path != file.path) result.rests_on.emplace_back(path, hash_of_file(path));
  if (to_pass_on) result.imports_keep_back = why_imports_keep_back(read->opened);
  result.entries = std::move(read->entries);
  if (read->unparsed) lose(*read->unparsed);
  return result;
}

Result<> read_library_files(const std::vector<LibraryFile>& files, const std::vector<std::size_t>& which,
                            const FileRequest& request, bool to_pass_on, const StoreProgress& tell,
                            const std::function<Result<>(std::size_t which, ReadFile read)>& keep) {
  KeptReadings kept;
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex lock;
  std::optional<Error> trouble;
  in_parallel(which.size(), [&](std::size_t, std::size_t) {
    for (std::size_t i; (i = next.fetch_add(1)) < which.size();) {
      ReadFile read = read_library_file(files[which[i]], request, to_pass_on, &kept);
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

namespace {

constexpr std::size_t digits_of_a_hash = 64;

/// The hash of a file's bytes, and of all by which its materials and its other exports are named.
std::string named_in(const LibraryFile& file) {
  const auto found = read_file(file.path, largest_source);
  if (!found) return {};  // if it is in this binary, it changes with the build alone
  ContentHash bytes, named;
  bytes.take(found->bytes);
  SourceSet sources;
  Diagnostics ignored;
  LibraryIndex index;
  index.add(file.module, file.path, parse(sources, sources.add(file.path, found->bytes), ignored));
  for (const IndexedMaterial& each : index.materials()) {
    named.take(each.module).take(each.name).take(each.title).take(each.kind);
    named.take("replaces");
    for (const std::string& text : each.replaces) named.take(text);
    named.take("called");
    for (const std::string& text : each.called) named.take(text);
    for (const auto& [language, called] : each.called_in) {
      named.take(language);
      for (const std::string& text : called) named.take(text);
    }
  }
  // A name that no material has is told with what else has it.
  for (const ExportedName& each : index.exports()) named.take(each.what).take(each.name);
  return bytes.digits() + named.digits();
}

/// What an index noted of a file's names, if its bytes are as they were; otherwise empty.
std::string_view noted_names(const KnownFile* known, const LibraryFile& file, const std::string& hash) {
  constexpr std::string_view before = "[\"";
  if (!known || known->module != file.module || hash.size() != digits_of_a_hash) return {};
  std::string_view text = known->rests_on;
  if (!text.starts_with(before)) return {};
  text = text.substr(before.size(), 2 * digits_of_a_hash);
  return text.size() == 2 * digits_of_a_hash && text.starts_with(hash) ? text : std::string_view();
}

}  // namespace

FileHashes hashes_of(const std::vector<LibraryFile>& files, const std::vector<std::string>& names,
                     const std::function<const KnownFile*(std::size_t which)>& known) {
  FileHashes hashes{std::vector<std::string>(files.size()), std::vector<std::string>(files.size()), {}};
  in_parallel(files.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      hashes.each[i] = hash_of_file(files[i].path);
      hashes.named[i] = noted_names(known(i), files[i], hashes.each[i]);
      if (hashes.named[i].empty()) hashes.named[i] = named_in(files[i]);
    }
  });
  ContentHash hash;
  for (std::size_t i = 0; i < files.size(); ++i)
    hash.take(names[i]).take(std::string_view(hashes.named[i]).substr(std::min(digits_of_a_hash, hashes.named[i].size())));
  hashes.others = hash.digits();
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

std::string rests_on_text(const std::vector<std::pair<std::string, std::string>>& rests_on, const std::string& named) {
  using Json = nlohmann::json;
  Json all = Json::array({named});
  for (const auto& [path, hash] : rests_on) all.push_back(Json::array({path, hash}));
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_unchanged(const KnownFile& known, const std::string& module, const std::string& name, const std::string& hash,
                  const std::string& others, HashesOnce& hashes,
                  const std::function<std::string(const std::string& name)>& path_of) {
  if (known.module != module || (!known.others.empty() && known.others != others)) return false;
  const auto rests_on = nlohmann::json::parse(known.rests_on, nullptr, false);
  if (!rests_on.is_array() || rests_on.size() < 2 || !rests_on[0].is_string()) return false;
  return std::all_of(rests_on.begin() + 1, rests_on.end(), [&](const nlohmann::json& each) {
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
