#include "library/command/index_here.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/readable.hpp"
#include "library/index/content_hash.hpp"
#include "library/index/find.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

namespace fs = std::filesystem;

FileRequest request_of(const IndexChoice& choice) {
  FileRequest request;
  request.device = choice.device, request.sandbox = choice.sandbox;
  request.roots = library_folders(choice.folders, std::getenv("WALE_LIBRARY"));
  return request;
}

}  // namespace

void offer_index(CLI::App& verb, IndexChoice& choice) {
  must_say(verb.add_option("--index", choice.file,
                           "look in this index as it stands, a file or postgresql://USER@HOST/DATABASE, which `wale library "
                           "index` makes (default: one in the user's cache, which is brought up to date)")
               ->type_name("FILE"),
           "the name of an index", "`wale library index -o FILE` makes one");
  offer_library(verb, choice.folders, "a folder whose materials are looked at too, as in my/materials; may be repeated");
  offer_sandbox(verb, choice.sandbox);
}

StoreProgress shown_progress() {
  if (isatty(STDERR_FILENO) != 1) return {};
  const auto told = std::make_shared<std::atomic<std::size_t>>(0);
  return [told](std::size_t done, std::size_t all) {
    if ((done % 16 == 0 || done == all) && done > told->exchange(done))
      print_as_is(stderr, fmt::format("\r{} of {} files\033[K{}", done, all, done == all ? "\r\033[K" : ""));
  };
}

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

std::string kept_index(const IndexChoice& choice, const std::vector<LibraryFile>& files) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return {};
  std::error_code trouble;
  // One for each library. Files that are only in this binary are the same everywhere; others have relative names.
  ContentHash hash;
  hash.take(choice.device);
  for (const std::string& root : library_folders(choice.folders, std::getenv("WALE_LIBRARY")))
    hash.take(fs::absolute(root, trouble).string());
  const bool has_files = std::ranges::any_of(files, [&](const LibraryFile& each) { return fs::exists(each.path, trouble); });
  if (has_files) hash.take(fs::current_path(trouble).string());
  return (folder / fmt::format("library-{}.index", hash.digits().substr(0, 16))).string();
}

Result<IndexHere> index_here(const IndexChoice& choice) {
  IndexHere here;
  if (!choice.file.empty()) {
    auto opened = LibraryStore::open(choice.file, false, cache_folder());
    if (!opened) return opened.error();
    here.store = *std::move(opened);
    if (!here.store->is_of_this_wale())
      print_error("wale: warning: {} is of another build of Wale, whose maps may give other levels; `wale library index` "
                  "brings it up to date\n",
                  visible_text(without_password(choice.file)));
    return here;
  }
  const FileRequest request = request_of(choice);
  const auto resolver = file_resolver(request.roots);
  const auto catalogue = library_index(*resolver, "here");
  const std::vector<LibraryFile> files = library_files_in(*catalogue);
  std::optional<Error> why;
  if (const std::string path = kept_index(choice, files); path.empty()) {
    why = Error{.code = Code::unwritable_file, .sentence = "neither XDG_CACHE_HOME nor HOME names a folder for it"};
  } else if (auto opened = LibraryStore::open(path, true); !opened) {
    why = opened.error();
  } else if (auto report = (*opened)->bring_up_to_date(files, request, shown_progress()); !report) {
    why = report.error();
  } else {
    here.store = *std::move(opened), here.report = *std::move(report);
    return here;
  }
  print_error("wale: no index can be kept, so the whole library is read, which takes some seconds: {}\n",
              visible_text(why->sentence));
  here.in_memory = index_of(read_library(files, request, shown_progress()), choice.device);
  return here;
}

Result<FeltMaterial> felt_material(const MaterialIndex& index, const IndexChoice& choice, const std::string& text) {
  const auto unknown = [&](const std::string& name, const std::string& why) {
    return Error{.code = Code::unknown_material,
                 .sentence = fmt::format("it is not known what `{}` feels like: {}", visible_text(name), visible_text(why)),
                 .mend = "take one that pushes",
                 .place = {.name = text}};
  };
  const auto felt = [&](Entry entry, std::vector<std::uint32_t> is) -> Result<FeltMaterial> {
    if (!entry.felt.cues)
      return unknown(entry.name, entry.trouble.empty() ? "it only vibrates" : entry.trouble);
    return FeltMaterial{entry.name, *std::move(entry.felt.cues), std::move(is)};
  };
  const auto meant = meant_entry(index, text);
  if (meant) {
    auto entry = index.entry(*meant);
    if (!entry) return entry.error();
    return felt(*std::move(entry), {*meant});
  }
  const std::string path = text.substr(0, text.find(".wale") == std::string::npos ? 0 : text.find(".wale") + 5);
  if (path.empty()) return meant.error();
  FileRequest request = request_of(choice);
  request.device = index.device(), request.file = text;
  auto read = read_entries(request, fs::path(path).stem().string());
  if (!read) return read.error();
  if (read->entries.empty()) return unknown(text, "the file declares no material");
  return felt(std::move(read->entries.front()), {});
}

std::string distance_text(const Probe::Told& told) {
  const auto number = [](double value) { return readable("{:.1f}", value); };
  const auto plural = [](double value) { return std::abs(value - 1) < 0.05 ? "difference" : "differences"; };
  std::string by = told.plainest.empty() ? "" : fmt::format(" ({})", told.plainest);
  if (told.unknown.empty()) return fmt::format("{} {}{}", number(told.low), plural(told.low), by);
  const std::string most = std::isfinite(told.high) ? fmt::format("{} to {}", number(told.low), number(told.high))
                                                    : fmt::format("at least {}", number(told.low));
  return fmt::format("{} differences{}; unknown: {}", most, by, fmt::join(told.unknown, ", "));
}

nlohmann::ordered_json distance_json(const Probe::Told& told) {
  nlohmann::ordered_json json = {{"low", told.low}, {"high", nullptr}};
  if (std::isfinite(told.high)) json["high"] = told.high;
  json["unknown"] = told.unknown, json["plainest"] = told.plainest;
  return json;
}

}  // namespace wale::command
