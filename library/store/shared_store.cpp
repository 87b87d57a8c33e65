#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "library/index/content_hash.hpp"
#include "library/index/entry_json.hpp"
#include "library/licence/passing_on.hpp"
#include "library/store/shared_changes.hpp"
#include "library/store/shared_schema.hpp"
#include "library/store/stores.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

class SharedStore final : public LibraryStore, MaterialIndex, WordTable {
 public:
  SharedStore(SharedDatabase database, const std::string& cache)
      : database_(std::move(database)), columns_(FeltColumns::of({})) {
    if (!cache.empty())
      columns_path_ = (std::filesystem::path(cache) /
                       fmt::format("shared-{}.felt", ContentHash().take(database_.name()).digits().substr(0, 16)))
                          .string();
  }

  Result<> prepare(bool makes) {
    if (const auto ready = prepare_shared_schema(database_, makes); !ready) return ready;
    return look();
  }

  Result<StoreReport> bring_up_to_date(const std::vector<LibraryFile>& files, const FileRequest& request,
                                       const StoreProgress& tell, const Shelf& shelf) override;
  bool is_of_this_wale() const override {
    const auto other = database_.ask("SELECT FROM wale.files WHERE build <> $1 LIMIT 1", {compiler_build()});
    return other && other->size() == 0;
  }
  const MaterialIndex& index() const override { return *this; }

 private:
  const WordTable& words() const override { return *this; }
  const FeltColumns& columns() const override { return columns_; }
  std::string device() const override { return device_.empty() ? std::string(default_device) : device_; }
  Result<Entry> entry(std::uint32_t material) const override;
  Result<std::vector<std::uint32_t>> meant_by(std::string_view text) const override;
  Size size() const override { return size_; }
  Result<> each_hit(const std::string& beginning, const Visit& visit) const override;

  Result<> look();
  Result<> read_columns(std::uint64_t stamp);
  Result<std::vector<FeltRow>> rows_since(std::int64_t state) const;
  Result<> tell_troubles(const std::set<std::string>& shelves, StoreReport& report) const;

  SharedDatabase database_;
  std::string columns_path_;  ///< empty if none are kept
  FeltColumns columns_;
  Size size_;
  std::string device_;
};

/// From here on all answers are about one state of the index, whatever others do.
Result<> SharedStore::look() {
  if (const auto begun = database_.run("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY"); !begun) return begun;
  const auto present = database_.ask("SELECT stamp, device, materials, length FROM wale.present");
  if (!present) return present.error();
  if (present->size() != 1)
    return Error{.code = Code::damaged_file,
                 .sentence = "the shared index has lost its state",
                 .mend = "its owner drops the schema `wale` and makes it again",
                 .place = {.name = database_.name()}};
  device_ = present->text(0, 1);
  size_ = {static_cast<std::uint64_t>(present->number(0, 2)), static_cast<std::uint64_t>(present->number(0, 3))};
  return read_columns(static_cast<std::uint64_t>(present->number(0, 0)));
}

/// The rows that have changed since a state, in the order of their numbers.
Result<std::vector<FeltRow>> SharedStore::rows_since(std::int64_t state) const {
  constexpr std::size_t rows_at_once = 20'000;  // some 20 MB
  std::vector<FeltRow> rows;
  for (std::string last = "0";;) {
    const auto some = database_.ask(
        "SELECT id, name, module, kind, pg_catalog.encode(felt, 'hex'), trouble <> '' FROM wale.materials "
        "WHERE id > $1 AND state > $2 ORDER BY id LIMIT $3",
        {last, std::to_string(state), std::to_string(rows_at_once)});
    if (!some) return some.error();
    for (std::size_t i = 0; i < some->size(); ++i) {
      rows.push_back({static_cast<std::uint32_t>(some->number(i, 0)), std::string(some->text(i, 1)),
                      std::string(some->text(i, 2)), std::string(some->text(i, 3)), felt_of_digits(some->text(i, 4))});
      // Earlier builds of Wale wrote nothing there for what they could not build.
      if (some->text(i, 5) == "t") rows.back().felt = {{std::string(unbuilt_quantity), 1.0f}};
    }
    if (some->size() < rows_at_once) return rows;
    last = some->text(some->size() - 1, 0);
  }
}

/// Takes the kept columns if they are of this state; otherwise fetches what has changed since theirs, or else all.
Result<> SharedStore::read_columns(std::uint64_t stamp) {
  std::optional<FeltColumns> kept;
  std::int64_t state = -1;
  if (auto mapped = columns_path_.empty() ? Result<FeltColumns>(Error{}) : FeltColumns::map(columns_path_)) {
    if (mapped->generation() == stamp) {
      columns_ = *std::move(mapped);
      return {};
    }
    const auto known = database_.ask("SELECT state FROM wale.states WHERE stamp = $1",
                                     {std::to_string(static_cast<std::int64_t>(mapped->generation()))});
    if (!known) return known.error();
    if (known->size() == 1) state = known->number(0, 0), kept = *std::move(mapped);
  }
  const auto fresh = rows_since(state);
  if (!fresh) return fresh.error();
  FeltColumnsBuilder builder;
  auto next = fresh->begin();
  if (kept) {
    const auto gone_rows = database_.ask("SELECT material FROM wale.gone WHERE state > $1", {std::to_string(state)});
    if (!gone_rows) return gone_rows.error();
    std::set<std::uint32_t> gone;
    for (std::size_t i = 0; i < gone_rows->size(); ++i) gone.insert(static_cast<std::uint32_t>(gone_rows->number(i, 0)));
    const auto numbers = builder.numbers_for(*kept);
    for (std::size_t row = 0; row < kept->size(); ++row) {
      const std::uint32_t material = kept->material(row);
      while (next != fresh->end() && next->material < material) builder.add(*next++);
      if (next != fresh->end() && next->material == material)
        builder.add(*next++);
      else if (!gone.contains(material))
        builder.add(*kept, row, numbers);
    }
  }
  while (next != fresh->end()) builder.add(*next++);
  columns_ = builder.finish(stamp);
  if (!columns_path_.empty()) (void)columns_.write(columns_path_);  // where it cannot be written, it is fetched each time
  return {};
}

Result<Entry> SharedStore::entry(std::uint32_t material) const {
  const auto found = database_.ask("SELECT entry FROM wale.materials WHERE id = $1", {std::to_string(material)});
  if (!found) return found.error();
  if (found->size() == 1) return entry_of_json(nlohmann::ordered_json::parse(found->text(0, 0), nullptr, false));
  return Error{.code = Code::damaged_file,
               .sentence = "the kept columns of the shared index have a material that it has not",
               .mend = columns_path_.empty() ? "try again" : fmt::format("remove {}, which is fetched again", columns_path_),
               .place = {.name = database_.name()}};
}

Result<std::vector<std::uint32_t>> SharedStore::meant_by(std::string_view text) const {
  std::vector<std::uint32_t> found;
  if (text.empty()) return found;
  for (const MeantBy by : {MeantBy::name, MeantBy::replaces, MeantBy::called, MeantBy::kind, MeantBy::module}) {
    const auto rows = database_.ask("SELECT material FROM wale.meant WHERE how = $1 AND key = $2 ORDER BY material",
                                    {std::to_string(static_cast<int>(by)), "\\x" + meant_key(meant_text(by, text))});
    if (!rows) return rows.error();
    for (std::size_t i = 0; i < rows->size(); ++i) found.push_back(static_cast<std::uint32_t>(rows->number(i, 0)));
    if (!found.empty()) break;
  }
  return found;
}

Result<> SharedStore::each_hit(const std::string& beginning, const Visit& visit) const {
  // Behind all words that begin so: no word has the last character of Unicode.
  const auto rows = database_.ask("SELECT word, material, weight, length FROM wale.words WHERE word >= $1 AND word < $2",
                                  {beginning, beginning + "\xf4\x8f\xbf\xbf"});
  if (!rows) return rows.error();
  for (std::size_t i = 0; i < rows->size(); ++i)
    visit(rows->text(i, 0), {static_cast<std::uint32_t>(rows->number(i, 1)), static_cast<std::uint32_t>(rows->number(i, 2)),
                             static_cast<std::uint32_t>(rows->number(i, 3))});
  return {};
}

/// Tells which materials of these shelves cannot be felt.
Result<> SharedStore::tell_troubles(const std::set<std::string>& shelves, StoreReport& report) const {
  const auto troubled = database_.ask(
      "SELECT each.name, file.shelf || '/' || file.way, each.trouble FROM wale.materials AS each "
      "JOIN wale.files AS file ON file.key = each.file WHERE each.trouble <> '' AND file.shelf = ANY ($1::text[]) "
      "ORDER BY file.shelf COLLATE pg_catalog.\"C\", file.way COLLATE pg_catalog.\"C\", each.id",
      {array_of_texts({shelves.begin(), shelves.end()})});
  if (!troubled) return troubled.error();
  for (std::size_t i = 0; i < troubled->size(); ++i)
    report.troubled.push_back({std::string(troubled->text(i, 0)), std::string(troubled->text(i, 1)),
                               std::string(troubled->text(i, 2))});
  return {};
}

Result<StoreReport> SharedStore::bring_up_to_date(const std::vector<LibraryFile>& files, const FileRequest& request,
                                                  const StoreProgress& tell, const Shelf& shelf) {
  StoreReport report;
  report.files = files.size();
  if (!device_.empty() && device_ != request.device) return of_other_device(database_, device_, request.device);
  const auto places = shared_files(files, shelf.name);
  if (!places) return places.error();
  std::set<std::string> shelves;
  std::vector<std::string> names, keys;
  for (const SharedFile& each : *places)
    shelves.insert(each.shelf), names.push_back(each.path()), keys.push_back(each.key());

  if (const auto ended = database_.run("COMMIT"); !ended) return ended.error();  // of what was looked at
  const auto all = database_.ask(
      "SELECT pg_catalog.encode(key, 'hex'), module, rests_on, others, build FROM wale.files WHERE shelf = ANY ($1::text[])",
      {array_of_texts({shelves.begin(), shelves.end()})});
  if (!all) return all.error();
  std::map<std::string, KnownFile> known;
  std::set<std::string> gone;
  for (std::size_t i = 0; i < all->size(); ++i) {
    gone.emplace(all->text(i, 0));
    // What another build has read is read again.
    if (all->text(i, 4) == compiler_build())
      known[std::string(all->text(i, 0))] = {std::string(all->text(i, 1)), std::string(all->text(i, 2)),
                                             std::string(all->text(i, 3))};
  }
  for (const std::string& key : keys) gone.erase(key);
  std::vector<const KnownFile*> known_of(files.size());
  for (std::size_t i = 0; i < files.size(); ++i)
    if (const auto found = known.find(keys[i]); found != known.end()) known_of[i] = &found->second;
  const FileHashes hashes = hashes_of(files, names, [&](std::size_t which) { return known_of[which]; });
  HashesOnce hashes_once;
  std::vector<char> changed(files.size(), 1);
  in_parallel(files.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SharedFile& place = (*places)[i];
      if (known_of[i])
        changed[i] = !is_unchanged(*known_of[i], files[i].module, place.way, hashes.each[i], hashes.others, hashes_once,
                                   [&](const std::string& way) { return (std::filesystem::path(place.root) / way).string(); });
    }
  });
  std::vector<std::size_t> to_read;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (changed[i]) to_read.push_back(i);

  std::vector<SharedChange> waiting;
  const auto put = [&]() -> Result<> {
    const auto done = waiting.empty() ? Result<>() : put_into_shared(database_, waiting, request.device);
    waiting.clear();
    return done;
  };
  const auto read = read_library_files(files, to_read, request, true, tell, [&](std::size_t which, ReadFile each) -> Result<> {
    SharedChange change{(*places)[which], {files[which].module, shared_rests_on((*places)[which], each.rests_on, hashes.named[which]),
                                           each.uses_names ? hashes.others : std::string()}, {}};
    report.read += each.entries.size();
    for (Entry& entry : each.entries) {
      const bool is_unread = entry.content.empty();  // its file is no text, which states no licence
      std::string why = is_unread ? entry.trouble : each.imports_keep_back;
      if (why.empty()) why = why_kept_back(entry.licence);
      entry.file = names[which];
      if (why.empty()) {
        change.entries.push_back(std::move(entry));
        continue;
      }
      report.kept_back.push_back({entry.name, names[which], why});
      change.known.rests_on.clear();  // it is told the next time too
    }
    waiting.push_back(std::move(change));
    constexpr std::size_t files_at_once = 32;
    return waiting.size() < files_at_once ? Result<>() : put();
  });
  if (!read && read.error().code != Code::stopped) return read.error();
  if (const auto done = put(); !done) return done.error();
  if (!read) return read.error();
  if (shelf.is_whole && !gone.empty()) {
    const std::vector<std::string> lost(gone.begin(), gone.end());
    if (shelf.forgets) {
      const auto taken = take_out_of_shared(database_, lost, request.device);
      if (!taken) return taken.error();
      report.gone = *taken;
    } else {
      const auto there = database_.ask("SELECT count(*) FROM wale.materials WHERE file = ANY ($1::bytea[])",
                                       {array_of_keys(lost)});
      if (!there) return there.error();
      report.only_there = static_cast<std::size_t>(there->number(0, 0));
    }
  }
  if (const auto looked = look(); !looked) return looked.error();
  report.materials = columns_.size();
  if (const auto told = tell_troubles(shelves, report); !told) return told.error();
  std::ranges::sort(report.kept_back, {}, [](const StoreReport::Troubled& each) { return std::tie(each.file, each.material); });
  return report;
}

}  // namespace

Result<std::unique_ptr<LibraryStore>> open_shared_store(const std::string& address, bool makes, const std::string& cache) {
  auto database = SharedDatabase::open(address);
  if (!database) return database.error();
  auto store = std::make_unique<SharedStore>(*std::move(database), cache);
  if (const auto ready = store->prepare(makes); !ready) return ready.error();
  return Result<std::unique_ptr<LibraryStore>>(std::move(store));
}

}  // namespace wale
