#include "library/store/seek.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "compiler/diagnostics/told.hpp"
#include "compiler/modules/load_modules.hpp"
#include "library/index/words.hpp"
#include "library/licence/licence.hpp"
#include "library/licence/passing_on.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// How many of the words a material has, or words that begin so.
std::size_t count_of(const Entry& entry, const std::vector<std::string>& words) {
  const WordCounts counted = count_words(entry);
  const auto has = [&](const std::string& word) {
    return std::ranges::any_of(counted.weights, [&](const auto& each) { return each.first.starts_with(word); });
  };
  return static_cast<std::size_t>(std::ranges::count_if(words, has));
}

/// The first error of a file's text, with its place and the further ones; nothing if the text has none.
std::optional<Error> error_in(OpenedFile& opened) {
  opened.diagnostics.sort();
  std::optional<Error> error;
  std::vector<Error> others;
  for (const Diagnostic& each : opened.diagnostics.all())
    if (!error && severity_of(each.code) == Severity::error)
      error = told(each, opened.sources);
    else
      others.push_back(told(each, opened.sources));
  if (error) error->others = std::move(others);
  return error;
}

/// The numbers of a material of a file that the index has too.
std::vector<std::uint32_t> of_file(const MaterialIndex& index, const Entry& own, const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<std::uint32_t> is;
  const FeltColumns& columns = index.columns();
  for (std::size_t row = 0; row < columns.size(); ++row) {
    if (columns.name(row) != own.name) continue;
    const auto known = index.entry(columns.material(row));
    if (!known) continue;
    std::error_code ignored;
    // A file that is not here, as one that is in this binary only, is the same if all that it rests on is.
    const bool is_same = fs::exists(known->file, ignored) ? fs::equivalent(known->file, path, ignored)
                                                          : known->content == own.content;
    if (is_same) is.push_back(columns.material(row));
  }
  return is;
}

Error unknown_feel(const std::string& text, const std::string& name, const std::string& why) {
  return {.code = Code::unknown_material,
          .sentence = fmt::format("it is not known what `{}` feels like: {}", visible_text(name), visible_text(why)),
          .mend = "take one that pushes",
          .place = {.name = text}};
}

constexpr std::string_view ending = ".wale";

bool names_file(const std::string& text) { return text.find(ending) != std::string::npos; }

/// The materials of a file of one's own, at least one. Errors: those of `read_entries`; the first one of its text; that it
/// declares no material.
Result<FileEntries> own_entries(FileRequest request, const std::string& text, const Feel& feel) {
  request.file = text;
  const std::string path = text.substr(0, text.find(ending) + ending.size());
  auto read = read_entries(request, std::filesystem::path(path).stem().string(), feel);
  if (!read) return read.error();
  if (read->entries.empty() || !read->entries.front().trouble.empty())
    if (auto error = error_in(read->opened)) return *std::move(error);
  if (read->entries.empty()) return unknown_feel(text, text, "the file declares no material");
  return read;
}

}  // namespace

Result<> can_be_felt(const LibraryIndex& catalogue, const FileRequest& request, const std::string& text) {
  if (!catalogue.meant_by(text).empty()) return {};
  std::vector<Entry> entries;
  for (const IndexedMaterial& each : catalogue.materials())
    if (each.origin != Origin::hidden) entries.push_back(entry_of(each));
  const auto meant = meant_entry(*index_of(std::move(entries), default_device), text);
  if (meant || meant.error().code != Code::unknown_name) return {};
  if (!names_file(text)) return meant.error();
  const auto read = own_entries(request, text, [](const Program&, const Declarations&) { return EntryFeel(); });
  return read ? Result<>() : Result<>(read.error());
}

Result<FeltMaterial> felt_material(const MaterialIndex& index, const FileRequest& request, const std::string& text) {
  FileRequest own = request;
  own.device = index.device();
  const auto felt = [&](Entry entry, std::vector<std::uint32_t> is) -> Result<FeltMaterial> {
    if (!entry.felt.cues)
      return unknown_feel(text, entry.name, entry.trouble.empty() ? "it only vibrates" : entry.trouble);
    return FeltMaterial{entry.name, entry.kind, entry.module, *std::move(entry.felt.cues), std::move(is)};
  };
  const auto meant = meant_entry(index, text);
  if (meant) {
    auto entry = index.entry(*meant);
    if (!entry) return entry.error();
    if (!entry->trouble.empty()) {
      own.file = entry->file + ":" + entry->name;
      if (auto read = read_entries(own, entry->module); read)
        if (auto error = error_in(read->opened)) return *std::move(error);
    }
    return felt(*std::move(entry), {*meant});
  }
  if (!names_file(text)) return meant.error();
  auto read = own_entries(own, text, felt_of);
  if (!read) return read.error();
  Entry& first = read->entries.front();
  std::vector<std::uint32_t> is = of_file(index, first, read->opened.name);
  return felt(std::move(first), std::move(is));
}

Result<FoundEntries> seek_by_feel(const MaterialIndex& index, const FileRequest& request, const Seeking& sought) {
  const auto declared = common_modules();
  const Comparer comparer(declared->declarations, index.device());
  std::vector<std::unique_ptr<Probe>> probes;
  const std::uint64_t usual = sought.by_feel() ? usually_near : index.columns().size();
  MaterialQuery query{.texts = sought.texts, .kind = sought.kind, .most = sought.most.value_or(usual)};
  if (!sought.near.empty()) {
    auto felt = felt_material(index, request, sought.near);
    if (!felt) return felt.error();
    probes.push_back(std::make_unique<NearProbe>(comparer, felt->cues));
    query.without = std::move(felt->is), query.without_kinds = kinds_left_out(felt->kind, felt->module);
  }
  if (!sought.levels.empty()) {
    auto probe = LevelProbe::make(sought.levels, declared->declarations, index.device());
    if (!probe) return probe.error();
    probes.push_back(*std::move(probe));
  }
  std::unique_ptr<Probe> probe;
  if (!probes.empty()) probe = std::move(probes.front());
  if (probes.size() > 1) probe = std::make_unique<BothProbe>(std::move(probe), std::move(probes.back()));
  query.feel = probe.get();
  return find_entries(index, query);
}

FoundByWords seek_by_words(const LibraryIndex& catalogue, const Seeking& sought) {
  FoundByWords all;
  all.as_they_stand = find_materials(catalogue, sought.texts, sought.kind);
  const auto most = sought.most.value_or(all.as_they_stand.size());
  if (all.as_they_stand.size() > most) all.as_they_stand.resize(most);
  const std::string phrase = fmt::format("{}", fmt::join(sought.texts, " "));
  const std::vector<std::string> words = words_of(phrase);
  if (!all.as_they_stand.empty() || words.size() < 2) return all;
  std::vector<Entry> entries;
  for (const IndexedMaterial& each : catalogue.materials())
    if (each.origin != Origin::hidden) entries.push_back(entry_of(each));
  const auto index = index_of(std::move(entries), default_device);
  auto found = find_entries(*index, {.texts = {phrase}, .kind = sought.kind, .most = index->columns().size()});
  if (!found) return all;  // an index in memory has no errors
  std::vector<std::pair<std::size_t, FoundEntry*>> ranked;
  std::size_t best = 0;
  for (FoundEntry& each : found->entries) {
    ranked.emplace_back(count_of(each.entry, words), &each);
    best = std::max(best, ranked.back().first);
  }
  const std::size_t enough = std::min(best, (words.size() + 1) / 2);
  std::erase_if(ranked, [&](const auto& each) { return each.first == 0 || each.first < enough; });
  std::ranges::stable_sort(ranked, std::greater<>(), [](const auto& each) { return each.first; });
  if (ranked.size() > sought.most.value_or(usually_near)) ranked.resize(sought.most.value_or(usually_near));
  for (const auto& [count, each] : ranked) all.most_words.push_back(std::move(*each));
  all.have_all = best == words.size();
  return all;
}

std::vector<std::string> stimuli_here() {
  std::vector<std::string> stimuli = shipped_project().stimuli;
  if (const std::string folder = project_over("here"); !folder.empty())
    if (const auto own = project_of_library(folder)) stimuli.insert(stimuli.end(), own->stimuli.begin(), own->stimuli.end());
  return stimuli;
}

bool is_of_these(const std::vector<std::string>& kinds, std::string_view kind, std::string_view module) {
  return std::ranges::any_of(kinds, [&](const std::string& each) {
    return is_of_sought_kind(kind, each) || is_of_sought_kind(module, each);
  });
}

std::vector<std::string> kinds_left_out(std::string_view kind, std::string_view module) {
  std::vector<std::string> stimuli = stimuli_here();
  if (is_of_these(stimuli, kind, module)) stimuli.clear();
  return stimuli;
}

Result<FoundBetween> seek_between(const MaterialIndex& index, const FileRequest& request, const std::string& one,
                                  const std::string& other, const std::string& kind, std::uint64_t most) {
  const auto first = felt_material(index, request, one);
  if (!first) return first.error();
  const auto second = felt_material(index, request, other);
  if (!second) return second.error();
  const auto declared = common_modules();
  const Comparer comparer(declared->declarations, index.device());
  const BetweenProbe probe(comparer, first->cues, second->cues);
  MaterialQuery query{.texts = {}, .kind = kind, .feel = &probe, .without = first->is, .most = most};
  query.without.insert(query.without.end(), second->is.begin(), second->is.end());
  query.without_kinds = kinds_left_out(first->kind, first->module);
  if (kinds_left_out(second->kind, second->module).empty()) query.without_kinds.clear();
  auto found = find_entries(index, query);
  if (!found) return found.error();
  FoundBetween between{.one = first->name, .other = second->name, .found = {}};
  for (FoundEntry& each : found->entries) {
    auto from_one = probe.one().tell(index.columns(), each.row), from_other = probe.other().tell(index.columns(), each.row);
    between.found.push_back({std::move(each), std::move(from_one), std::move(from_other)});
  }
  return between;
}

std::vector<std::string> kinds_in(const MaterialIndex& index) {
  const FeltColumns& columns = index.columns();
  std::set<std::string> kinds;
  for (std::size_t row = 0; row < columns.size(); ++row) {
    const std::string kind(columns.kind(row));
    for (std::size_t dot = kind.find('.'); dot != std::string::npos; dot = kind.find('.', dot + 1))
      kinds.insert(kind.substr(0, dot));
    if (!kind.empty()) kinds.insert(kind);
  }
  return {kinds.begin(), kinds.end()};
}

}  // namespace wale
