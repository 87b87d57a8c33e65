#include "library/store/stores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "library/index/content_hash.hpp"
#include "library/index/entry_json.hpp"
#include "library/index/words.hpp"
#include "library/store/read_library.hpp"
#include "library/store/sqlite.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t wale_application = 0x57616c65;  // "Wale"
constexpr std::int64_t newest_schema = 1;

/// `generation` counts the changes, so that the columns beside the index are known to be of this state.
constexpr const char* schema = R"(
BEGIN IMMEDIATE;
CREATE TABLE facts(name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE files(path TEXT PRIMARY KEY, module TEXT NOT NULL, rests_on TEXT NOT NULL, others TEXT NOT NULL);
CREATE TABLE materials(id INTEGER PRIMARY KEY AUTOINCREMENT, path TEXT NOT NULL, name TEXT NOT NULL, trouble TEXT NOT NULL, length INTEGER NOT NULL, entry TEXT NOT NULL);
CREATE INDEX materials_of_path ON materials(path);
CREATE INDEX troubled_materials ON materials(path) WHERE trouble <> '';
CREATE TABLE words(word TEXT, material INTEGER, weight INTEGER NOT NULL, length INTEGER NOT NULL, PRIMARY KEY(word, material)) WITHOUT ROWID;
CREATE INDEX words_of_material ON words(material);
CREATE TABLE meant(how INTEGER, text TEXT, material INTEGER, PRIMARY KEY(how, text, material)) WITHOUT ROWID;
CREATE INDEX meant_of_material ON meant(material);
PRAGMA application_id = 1466002533;
PRAGMA user_version = 1;
COMMIT;
)";
static_assert(wale_application == 1466002533);

class SqliteStore final : public LibraryStore, MaterialIndex, WordTable {
 public:
  SqliteStore(Database database, FeltColumns columns) : database_(std::move(database)), columns_(std::move(columns)) {}

  /// Looks whether it is an index, and makes a new file one.
  Result<> prepare(bool makes) {
    const std::int64_t application = database_.number("PRAGMA application_id");
    const std::int64_t version = database_.number("PRAGMA user_version");
    const bool is_empty = database_.number("SELECT count(*) FROM sqlite_schema") == 0;
    if (is_empty && makes) {
      if (const auto made = database_.execute(schema); !made) return made;
    } else if (application != wale_application) {
      return Error{.code = Code::damaged_file,
                   .sentence = is_empty ? "this file is empty, and no index" : "this is a database, but no index of Wale",
                   .mend = "name another file, or make one: `wale library index -o FILE`",
                   .place = {.name = database_.path()}};
    } else if (version > newest_schema) {
      return Error{.code = Code::newer_file,
                   .sentence = fmt::format("the index has version {}, and this Wale reads {}", version, newest_schema),
                   .mend = "make another one with this Wale: `wale library index -o FILE`",
                   .place = {.name = database_.path()}};
    }
    return read_columns();
  }

  Result<StoreReport> bring_up_to_date(const std::vector<LibraryFile>& files, const FileRequest& request,
                                       const StoreProgress& tell, const Shelf& shelf) override;
  const MaterialIndex& index() const override { return *this; }
  Result<> copy_to(const std::string& path) const override {
    // As one transaction, also while another program writes to this file.
    return database_.prepare("VACUUM INTO ?").bind(path).run();
  }
  bool is_of_this_wale() const override { return fact("build") == compiler_build(); }

 private:
  const WordTable& words() const override { return *this; }
  const FeltColumns& columns() const override { return columns_; }
  std::string device() const override { return fact("device"); }
  Result<Entry> entry(std::uint32_t material) const override;
  Result<std::vector<std::uint32_t>> meant_by(std::string_view text) const override;
  Size size() const override {
    return {static_cast<std::uint64_t>(database_.number("SELECT count(*) FROM materials")),
            static_cast<std::uint64_t>(database_.number("SELECT coalesce(sum(length), 0) FROM materials"))};
  }
  Result<> each_hit(const std::string& beginning, const Visit& visit) const override;

  std::string fact(std::string_view name) const {
    auto asked = database_.prepare("SELECT value FROM facts WHERE name = ?");
    asked.bind(name);
    return asked.step() ? std::string(asked.text(0)) : std::string();
  }
  Result<> set_fact(std::string_view name, std::string_view value) const {
    return database_.prepare("INSERT OR REPLACE INTO facts VALUES(?, ?)").bind(name).bind(value).run();
  }

  std::string columns_path() const { return database_.path() + ".felt"; }
  std::uint64_t generation() const { return std::strtoull(fact("generation").c_str(), nullptr, 10); }
  Result<> read_columns();
  Result<> add_rows(FeltColumnsBuilder& builder, std::int64_t behind) const;
  Result<> finish_columns(FeltColumnsBuilder& builder, std::uint64_t generation);
  Result<> forget(const std::string& path, std::size_t& materials, std::set<std::uint32_t>& gone) const;
  Result<> keep(const LibraryFile& file, const ReadFile& read, const std::string& named, const std::string& others) const;

  Database database_;
  FeltColumns columns_;
};

Result<Entry> entry_of_text(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  return entry_of_json(json);
}

Result<> SqliteStore::read_columns() {
  const std::uint64_t now = generation();
  if (auto mapped = FeltColumns::map(columns_path()); mapped && mapped->generation() == now) {
    columns_ = *std::move(mapped);
    return {};
  }
  FeltColumnsBuilder builder;
  if (const auto added = add_rows(builder, 0); !added) return added;
  return finish_columns(builder, now);
}

/// Adds the materials with numbers behind this one.
Result<> SqliteStore::add_rows(FeltColumnsBuilder& builder, std::int64_t behind) const {
  auto all = database_.prepare("SELECT id, entry FROM materials WHERE id > ? ORDER BY id");
  all.bind(behind);
  while (all.step()) {
    const auto entry = entry_of_text(all.text(1));
    if (!entry) return entry.error();
    builder.add(felt_row(*entry, static_cast<std::uint32_t>(all.number(0))));
  }
  return all.trouble();
}

Result<> SqliteStore::finish_columns(FeltColumnsBuilder& builder, std::uint64_t generation) {
  columns_ = builder.finish(generation);
  (void)columns_.write(columns_path());  // where it cannot be written, it is made again each time
  return {};
}

Result<Entry> SqliteStore::entry(std::uint32_t material) const {
  auto asked = database_.prepare("SELECT entry FROM materials WHERE id = ?");
  asked.bind(std::int64_t{material});
  if (asked.step()) return entry_of_text(asked.text(0));
  if (const auto came = asked.trouble(); !came) return came.error();
  return Error{.code = Code::damaged_file,
               .sentence = "the columns beside the index have a material that it has not",
               .mend = fmt::format("remove {}, which is made again", columns_path()),
               .place = {.name = database_.path()}};
}

Result<std::vector<std::uint32_t>> SqliteStore::meant_by(std::string_view text) const {
  std::vector<std::uint32_t> found;
  if (text.empty()) return found;
  for (const MeantBy by : {MeantBy::name, MeantBy::replaces, MeantBy::called, MeantBy::kind, MeantBy::module}) {
    const std::string sought = meant_text(by, text);
    auto asked = database_.prepare("SELECT material FROM meant WHERE how = ? AND text = ? ORDER BY material");
    asked.bind(static_cast<std::int64_t>(by)).bind(sought);
    while (asked.step()) found.push_back(static_cast<std::uint32_t>(asked.number(0)));
    if (const auto came = asked.trouble(); !came) return came.error();
    if (!found.empty()) break;
  }
  return found;
}

Result<> SqliteStore::each_hit(const std::string& beginning, const Visit& visit) const {
  const std::string end = beginning + "\xff";  // behind all texts that begin so, byte by byte
  auto asked = database_.prepare("SELECT word, material, weight, length FROM words WHERE word >= ? AND word < ?");
  asked.bind(beginning).bind(end);
  while (asked.step())
    visit(asked.text(0), {static_cast<std::uint32_t>(asked.number(1)), static_cast<std::uint32_t>(asked.number(2)),
                          static_cast<std::uint32_t>(asked.number(3))});
  return asked.trouble();
}

Result<> SqliteStore::forget(const std::string& path, std::size_t& materials, std::set<std::uint32_t>& gone) const {
  auto asked = database_.prepare("SELECT id FROM materials WHERE path = ?");
  asked.bind(path);
  std::vector<std::int64_t> ids;
  while (asked.step()) ids.push_back(asked.number(0)), gone.insert(static_cast<std::uint32_t>(ids.back()));
  materials += ids.size();
  for (const char* sql : {"DELETE FROM words WHERE material = ?", "DELETE FROM meant WHERE material = ?",
                          "DELETE FROM materials WHERE id = ?"})
    for (const std::int64_t id : ids)
      if (const auto done = database_.prepare(sql).bind(id).run(); !done) return done;
  return database_.prepare("DELETE FROM files WHERE path = ?").bind(path).run();
}

Result<> SqliteStore::keep(const LibraryFile& file, const ReadFile& read, const std::string& named,
                           const std::string& others) const {
  const std::string rests_on = rests_on_text(read.rests_on, named);
  if (const auto kept = database_.prepare("INSERT INTO files VALUES(?, ?, ?, ?)")
                            .bind(file.path)
                            .bind(file.module)
                            .bind(rests_on)
                            .bind(read.uses_names ? others : std::string_view())
                            .run();
      !kept)
    return kept;
  auto add_material = database_.prepare("INSERT INTO materials(path, name, trouble, length, entry) VALUES(?, ?, ?, ?, ?)");
  auto add_word = database_.prepare("INSERT INTO words VALUES(?, ?, ?, ?)");
  auto add_meant = database_.prepare("INSERT INTO meant VALUES(?, ?, ?)");
  for (const Entry& entry : read.entries) {
    const WordCounts counted = count_words(entry);
    const std::string text = entry_json(entry).dump(-1, ' ', false, Json::error_handler_t::replace);
    if (const auto added = add_material.bind(file.path)
                                 .bind(entry.name)
                                 .bind(entry.trouble)
                                 .bind(std::int64_t{counted.length})
                                 .bind(text)
                                 .run();
        !added)
      return added;
    const std::int64_t id = database_.number("SELECT last_insert_rowid()");
    for (const auto& [word, weight] : counted.weights)
      if (const auto added =
              add_word.bind(word).bind(id).bind(std::int64_t{weight}).bind(std::int64_t{counted.length}).run();
          !added)
        return added;
    for (const auto& [by, meant] : meant_texts(entry))
      if (const auto added = add_meant.bind(static_cast<std::int64_t>(by)).bind(meant).bind(id).run(); !added)
        return added;
  }
  return {};
}

Result<StoreReport> SqliteStore::bring_up_to_date(const std::vector<LibraryFile>& files, const FileRequest& request,
                                                  const StoreProgress& tell, const Shelf&) {
  StoreReport report;
  report.files = files.size();
  std::vector<std::string> names;
  for (const LibraryFile& each : files) names.push_back(each.path);
  // What was read by another compiler, with other maps, or for another device, is read again.
  const bool is_of_this = fact("build") == compiler_build() && fact("device") == request.device;
  std::map<std::string, KnownFile> known;
  auto all = database_.prepare("SELECT path, module, rests_on, others FROM files");
  while (all.step())
    known[std::string(all.text(0))] = {std::string(all.text(1)), std::string(all.text(2)), std::string(all.text(3))};
  if (const auto came = all.trouble(); !came) return came.error();
  std::vector<const KnownFile*> known_of(files.size());
  for (std::size_t i = 0; i < files.size() && is_of_this; ++i)
    if (const auto found = known.find(files[i].path); found != known.end()) known_of[i] = &found->second;
  const FileHashes hashes = hashes_of(files, names, [&](std::size_t which) { return known_of[which]; });

  HashesOnce hashes_once;
  std::vector<char> changed(files.size(), 1);
  in_parallel(files.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (known_of[i])
        changed[i] = !is_unchanged(*known_of[i], files[i].module, files[i].path, hashes.each[i], hashes.others, hashes_once,
                                   [](const std::string& path) { return path; });
  });
  std::set<std::string> paths;
  std::vector<std::size_t> to_read;
  for (std::size_t i = 0; i < files.size(); ++i) {
    paths.insert(files[i].path);
    if (changed[i]) to_read.push_back(i);
  }
  std::vector<std::string> gone;
  for (const auto& [path, each] : known)
    if (!paths.contains(path)) gone.push_back(path);

  // A number is given once, so new materials stand behind all that the columns have.
  std::set<std::uint32_t> gone_rows;
  std::uint64_t before = 0;
  std::int64_t last_before = 0;
  const auto update = [&]() -> Result<> {
    before = generation(), last_before = database_.number("SELECT coalesce(max(id), 0) FROM materials");
    if (const auto set = set_fact("generation", std::to_string(generation() + 1)); !set) return set;
    if (const auto set = set_fact("build", compiler_build()); !set) return set;
    if (const auto set = set_fact("device", request.device); !set) return set;
    for (const std::string& path : gone)
      if (const auto forgotten = forget(path, report.gone, gone_rows); !forgotten) return forgotten;
    if (!is_of_this)  // those that are read below are known to be old if this is broken off
      if (const auto old = database_.execute("UPDATE files SET rests_on = '', others = ''"); !old) return old;
    std::size_t replaced = 0, count = 0;
    return read_library_files(files, to_read, request, false, tell, [&](std::size_t which, ReadFile read) -> Result<> {
      if (const auto forgotten = forget(files[which].path, replaced, gone_rows); !forgotten) return forgotten;
      if (const auto kept = keep(files[which], read, hashes.named[which], hashes.others); !kept) return kept;
      report.read += read.entries.size();
      constexpr std::size_t files_at_once = 32;
      return ++count % files_at_once == 0 ? database_.execute("COMMIT; BEGIN IMMEDIATE") : Result<>();
    });
  };
  if (!to_read.empty() || !gone.empty() || !is_of_this) {
    // A change that a killed process leaves unfinished has another generation than the columns.
    if (const auto begun = database_.execute("BEGIN IMMEDIATE"); !begun) return begun.error();
    if (const auto updated = update(); !updated) {
      (void)database_.execute(updated.error().code == Code::stopped ? "COMMIT" : "ROLLBACK");
      return updated.error();
    }
    if (const auto committed = database_.execute("COMMIT"); !committed) return committed.error();
    // Unless another process changed it too.
    if (const std::uint64_t now = generation(); columns_.generation() == before && now == before + 1) {
      FeltColumnsBuilder builder;
      const auto numbers = builder.numbers_for(columns_);
      for (std::size_t row = 0; row < columns_.size(); ++row)
        if (!gone_rows.contains(columns_.material(row))) builder.add(columns_, row, numbers);
      if (const auto added = add_rows(builder, last_before); !added) return added.error();
      if (const auto finished = finish_columns(builder, now); !finished) return finished.error();
    }
  }
  if (const auto read = read_columns(); !read) return read.error();
  report.materials = columns_.size();
  auto troubled = database_.prepare(
      "SELECT name, path, trouble FROM materials WHERE trouble <> '' ORDER BY path, id");
  while (troubled.step())
    report.troubled.push_back(
        {std::string(troubled.text(0)), std::string(troubled.text(1)), std::string(troubled.text(2))});
  if (const auto came = troubled.trouble(); !came) return came.error();
  return report;
}

}  // namespace

Result<std::unique_ptr<LibraryStore>> open_sqlite_store(const std::string& path, bool makes) {
  auto database = Database::open(path, makes);
  if (!database) return database.error();
  auto store = std::make_unique<SqliteStore>(*std::move(database), FeltColumns::of({}));
  if (const auto ready = store->prepare(makes); !ready) return ready.error();
  return Result<std::unique_ptr<LibraryStore>>(std::move(store));
}

}  // namespace wale
