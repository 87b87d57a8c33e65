#include "library/store/kept_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>

#include "compiler/text/resolver.hpp"
#include "library/index/content_hash.hpp"
#include "library/store/seek.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// The index of the shipped files alone, which those of all folders begin with.
std::string shipped_index(const FileRequest& request) {
  FileRequest shipped;
  shipped.device = request.device;
  return kept_index(shipped, {});
}

/// Begins the index of a library that has none yet, or one of another Wale, with what is known of the shipped files: they
/// are the same in every folder, and it takes far longer to read them than to copy what was read. What goes wrong here
/// goes wrong, or does not matter, where the index is brought up to date.
Result<> begin_with_shipped(const std::string& place, const FileRequest& request, const std::vector<LibraryFile>& files,
                            const StoreProgress& progress) {
  const std::string source = shipped_index(request);
  std::error_code trouble;
  if (source.empty() || place == source) return {};
  if (fs::exists(place, trouble)) {
    const auto known = LibraryStore::open(place, false);
    if (known && (*known)->is_of_this_wale()) return {};
  }
  std::vector<LibraryFile> shipped;
  std::ranges::copy_if(files, std::back_inserter(shipped), [&](const LibraryFile& each) { return !fs::exists(each.path, trouble); });
  if (shipped.empty()) return {};
  auto store = LibraryStore::open(source, true);
  if (!store) return {};
  if (const auto read = (*store)->bring_up_to_date(shipped, request, progress); !read)
    return read.error().code == Code::stopped ? Result<>(read.error()) : Result<>();
  const std::string fresh = place + ".begun";
  fs::remove(fresh, trouble);
  if ((*store)->copy_to(fresh)) fs::rename(fresh, place, trouble);
  fs::remove(fresh, trouble);
  return {};
}

}  // namespace

std::string cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (cache && *cache)
    folder = fs::path(cache) / "wale";
  else if (home && *home)
    folder = fs::path(home) / ".cache" / "wale";
  else
    return {};
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  return folder.string();
}

std::string kept_index(const FileRequest& request, const std::vector<LibraryFile>& files) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return {};
  std::error_code trouble;
  // One for each library. Files that are only in this binary are the same everywhere; others have relative names.
  ContentHash hash;
  hash.take(request.device);
  for (const std::string& root : request.roots) hash.take(fs::absolute(root, trouble).string());
  const bool has_files = std::ranges::any_of(files, [&](const LibraryFile& each) { return fs::exists(each.path, trouble); });
  if (has_files) hash.take(fs::current_path(trouble).string());
  return (folder / fmt::format("library-{}.index", hash.digits().substr(0, 16))).string();
}

Result<> refresh_kept(IndexHere& here, const FileRequest& request, const std::vector<LibraryFile>& files,
                      const StoreProgress& progress) {
  const std::string place = kept_index(request, files);
  if (place.empty())
    return Error{.code = Code::unwritable_file, .sentence = "neither XDG_CACHE_HOME nor HOME names a folder for it"};
  if (!here.store || here.place != place) {
    here.store.reset();
    if (auto begun = begin_with_shipped(place, request, files, progress); !begun) return begun;
    auto opened = LibraryStore::open(place, true);
    if (!opened) return opened.error();
    here.store = *std::move(opened), here.place = place;
  }
  auto report = here.store->bring_up_to_date(files, request, progress);
  if (!report) {
    here.store.reset();
    return report.error();
  }
  here.report = *std::move(report);
  return {};
}

Result<> open_index(IndexHere& here, const std::string& place, const FileRequest& request,
                    const std::vector<std::string>& meant, const IndexTold& told) {
  if (!place.empty()) {
    if (here.store && here.place == place) return {};
    auto opened = LibraryStore::open(place, false, cache_folder());
    if (!opened) return opened.error();
    here = IndexHere{.place = place, .store = *std::move(opened)};
    if (!here.store->is_of_this_wale())
      told.warn({.code = Code::newer_file,
                 .sentence = fmt::format("{} is of another build of Wale, whose maps may give other levels",
                                         visible_text(without_password(place))),
                 .mend = "`wale library index` brings it up to date"});
    return {};
  }
  const auto resolver = file_resolver(request.roots);
  auto catalogue = library_index(*resolver, "here");
  for (const std::string& text : meant)
    if (auto known = can_be_felt(*catalogue, request, text); !known) return known;
  const bool is_same = here.catalogue == catalogue && here.device == request.device;
  if (is_same && here.in_memory) return {};
  if (!is_same) here = IndexHere{.catalogue = catalogue, .device = request.device};
  const std::vector<LibraryFile> files = library_files_in(*catalogue);
  auto kept = refresh_kept(here, request, files, told.progress);
  if (kept || kept.error().code == Code::stopped) return kept;
  told.warn({.code = Code::unwritable_file,
             .sentence = "no index can be kept, so the whole library is read, which takes seconds to minutes: " +
                         visible_text(kept.error().sentence)});
  auto entries = read_library(files, request, told.progress);
  if (!entries) return entries.error();
  here.in_memory = index_of(*std::move(entries), request.device);
  return {};
}

}  // namespace wale
