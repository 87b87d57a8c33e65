#include "library/survey/survey.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <optional>

#include "library/index/library_files.hpp"
#include "library/review/contribution.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {

Result<Survey> survey(const std::vector<std::string>& paths, const FileRequest& request, SurveyDepth depth) {
  auto found = contribution_of(paths.empty() ? std::vector<std::string>{"."} : paths);
  if (!found && paths.empty() && found.error().code == Code::unknown_material) {
    Contribution shipped;
    const auto files = library_files_in(std::vector<std::string>());
    if (!files) return files.error();
    for (const LibraryFile& each : *files) shipped.files.push_back(each.path);
    found = std::move(shipped);
  }
  if (!found) return found.error();
  struct OfFile {
    std::vector<Entry> entries;
    std::optional<Error> unread;
    std::vector<std::string> looked_for;
  };
  std::vector<OfFile> read(found->files.size());
  std::atomic<std::size_t> next{0};
  in_parallel(read.size(), [&](std::size_t, std::size_t) {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < read.size();) {
      FileRequest one = request;
      one.file = found->files[i];
      const std::string module = std::filesystem::path(one.file).stem().string();
      auto entries = read_entries(one, module,
                                  depth == SurveyDepth::feel
                                      ? Feel(felt_of)
                                      : [](const Program&, const Declarations&) { return EntryFeel(); });
      if (entries) {
        read[i].entries = std::move(entries->entries), read[i].looked_for = std::move(entries->looked_for);
        read[i].unread = std::move(entries->unparsed);
      } else {
        read[i].unread = entries.error();
      }
    }
  });
  Survey all;
  all.read = found->files;
  for (OfFile& each : read) {
    std::error_code missing;
    for (std::string& path : each.looked_for)
      if (std::filesystem::exists(path, missing)) all.read.push_back(std::move(path));
    std::ranges::move(each.entries, std::back_inserter(all.entries));
    if (!each.unread) continue;
    if (each.unread->place.name.empty()) each.unread->place.name = found->files[static_cast<std::size_t>(&each - read.data())];
    all.unread.push_back(*std::move(each.unread));
  }
  for (const UnfitFile& each : found->unfit)
    all.unread.push_back({.code = Code::unfit_file,
                          .sentence = each.why,
                          .mend = "leave it out, or put a plain file in its place",
                          .place = {.name = each.path}});
  return all;
}

}  // namespace wale
