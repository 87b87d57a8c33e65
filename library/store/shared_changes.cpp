#include "library/store/shared_changes.hpp"

#include <fmt/format.h>

#include <bit>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/text/resolver.hpp"
#include "library/index/content_hash.hpp"
#include "library/index/entry_json.hpp"
#include "library/index/words.hpp"
#include "library/licence/passing_on.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

std::string absolute_path(const std::string& path) {
  std::error_code ignored;
  return fs::absolute(path, ignored).lexically_normal().string();
}

/// The way from a folder to a path below it; empty if it is not below.
std::string way_from(const std::string& folder, const std::string& path) {
  const std::string way = fs::path(absolute_path(path)).lexically_relative(absolute_path(folder)).generic_string();
  return way.empty() || way.starts_with("..") ? std::string() : way;
}

/// The state that a transaction makes.
struct NewState {
  std::string number, stamp;
};

/// Begins a new state. Its row is locked until the transaction ends, so that one writes after another, and the states that
/// readers see are in the order of their numbers.
Result<NewState> begin_state(const SharedDatabase& database, const std::string& device) {
  const auto state = database.ask(
      "UPDATE wale.present SET state = state + 1, "
      "stamp = ('x' || pg_catalog.md5(pg_catalog.gen_random_uuid()::text))::bit(64)::bigint, "
      "device = CASE device WHEN '' THEN $1 ELSE device END RETURNING state, stamp, device",
      {device});
  if (!state) return state.error();
  if (state->size() != 1)
    return Error{.code = Code::damaged_file,
                 .sentence = "the shared index has lost its state",
                 .mend = "its owner drops the schema `wale` and makes it again",
                 .place = {.name = database.name()}};
  if (state->text(0, 2) != device) return of_other_device(database, std::string(state->text(0, 2)), device);
  return NewState{std::string(state->text(0, 0)), std::string(state->text(0, 1))};
}

Result<> end_state(const SharedDatabase& database, const NewState& state, std::int64_t materials, std::int64_t length) {
  if (const auto counted = database.run("UPDATE wale.present SET materials = materials + $1, length = length + $2",
                                        {std::to_string(materials), std::to_string(length)});
      !counted)
    return counted;
  return database.run("INSERT INTO wale.states(stamp, state) VALUES($1, $2)", {state.stamp, state.number});
}

/// What a transaction adds to the sums of the index.
struct Added {
  std::int64_t materials = 0, length = 0;
};

/// Puts the words and names of a material beside it.
Result<> put_words(const SharedDatabase& database, const std::string& id, const Entry& entry, const WordCounts& counted) {
  std::vector<std::string> words;
  std::vector<std::int64_t> weights, hows;
  for (const auto& [word, weight] : counted.weights) words.push_back(word), weights.push_back(weight);
  if (const auto put = database.run("INSERT INTO wale.words(word, material, weight, length) "
                                    "SELECT word, $1::integer, weight, $2::integer "
                                    "FROM ROWS FROM (pg_catalog.unnest($3::text[]), pg_catalog.unnest($4::integer[])) "
                                    "AS each(word, weight)",
                                    {id, std::to_string(counted.length), array_of_texts(words), array_of_numbers(weights)});
      !put)
    return put;
  std::vector<std::string> keys;
  for (const auto& [by, text] : meant_texts(entry)) hows.push_back(static_cast<std::int64_t>(by)), keys.push_back(meant_key(text));
  return database.run("INSERT INTO wale.meant(how, key, material) SELECT how, key, $1::integer "
                      "FROM ROWS FROM (pg_catalog.unnest($2::smallint[]), pg_catalog.unnest($3::bytea[])) AS each(how, key)",
                      {id, array_of_numbers(hows), array_of_keys(keys)});
}

Result<> put_file(const SharedDatabase& database, const SharedChange& change, const NewState& state, Added& added) {
  const std::string file = "\\x" + change.file.key();
  if (const auto put = database.run(
          "INSERT INTO wale.files(key, shelf, way, module, rests_on, others, build) VALUES($1, $2, $3, $4, $5, $6, $7) "
          "ON CONFLICT (key) DO UPDATE SET module = excluded.module, rests_on = excluded.rests_on, "
          "others = excluded.others, build = excluded.build",
          {file, change.file.shelf, change.file.way, change.known.module, change.known.rests_on, change.known.others,
           compiler_build()});
      !put)
    return put;
  // Materials that stay keep their numbers, so that readers need not be told that one is gone.
  std::map<std::string, int> again;
  std::vector<std::string> keys;
  for (const Entry& entry : change.entries)
    keys.push_back(ContentHash().take(file).take(entry.name).take(std::to_string(again[entry.name]++)).digits());
  const auto gone = database.ask(
      "WITH taken AS (DELETE FROM wale.materials WHERE file = $1 AND key <> ALL ($2::bytea[]) RETURNING id, length), "
      "told AS (INSERT INTO wale.gone(material, state) SELECT id, $3::bigint FROM taken) "
      "SELECT count(*), coalesce(sum(length), 0) FROM taken",
      {file, array_of_keys(keys), state.number});
  if (!gone) return gone.error();
  added.materials -= gone->number(0, 0), added.length -= gone->number(0, 1);
  const auto had = database.ask("SELECT count(*), coalesce(sum(length), 0) FROM wale.materials WHERE file = $1", {file});
  if (!had) return had.error();
  added.materials -= had->number(0, 0), added.length -= had->number(0, 1);
  if (had->number(0, 0) > 0)
    for (const char* sql : {"DELETE FROM wale.words WHERE material IN (SELECT id FROM wale.materials WHERE file = $1)",
                            "DELETE FROM wale.meant WHERE material IN (SELECT id FROM wale.materials WHERE file = $1)"})
      if (const auto taken = database.run(sql, {file}); !taken) return taken;
  for (std::size_t i = 0; i < change.entries.size(); ++i) {
    const Entry& entry = change.entries[i];
    const WordCounts counted = count_words(entry);
    const auto id = database.ask(
        "INSERT INTO wale.materials(key, file, name, module, kind, trouble, length, felt, entry, state) "
        "VALUES($1, $2, $3, $4, $5, $6, $7, $8, $9, $10) ON CONFLICT (key) DO UPDATE SET file = excluded.file, "
        "name = excluded.name, module = excluded.module, kind = excluded.kind, trouble = excluded.trouble, "
        "length = excluded.length, felt = excluded.felt, entry = excluded.entry, state = excluded.state RETURNING id",
        {"\\x" + keys[i], file, entry.name, entry.module, entry.kind, entry.trouble, std::to_string(counted.length),
         "\\x" + felt_digits(felt_row(entry, 0).felt),
         entry_json(entry).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace), state.number});
    if (!id) return id.error();
    added.materials += 1, added.length += counted.length;
    if (const auto put = put_words(database, std::string(id->text(0, 0)), entry, counted); !put) return put;
  }
  return {};
}

}  // namespace

std::string SharedFile::key() const { return ContentHash().take(shelf).take(way).digits(); }

Error of_other_device(const SharedDatabase& database, const std::string& device, const std::string& asked) {
  return {.code = Code::other_device,
          .sentence = fmt::format("the shared index is for the device `{}`, and these programs are for `{}`", device, asked),
          .mend = fmt::format("name that device, `--device {}`, or another database", device),
          .place = {.name = database.name()}};
}

Result<std::vector<SharedFile>> shared_files(const std::vector<LibraryFile>& files, const std::string& shelf) {
  std::vector<SharedFile> all;
  std::error_code ignored;
  for (const LibraryFile& file : files) {
    const bool is_shipped_alone = !fs::exists(file.path, ignored);
    // Shipped files have paths from the source tree.
    const std::string root = is_shipped_alone ? "library" : project_over(file.path);
    if (root.empty())
      return Error{.code = Code::unfit_file,
                   .sentence = "a shared index takes files of a library, and this one is in none",
                   .mend = "put a file `wale.project` into the folder of the library, with the line `licence \"CC0-1.0\"`",
                   .place = {.name = file.path}};
    const std::string named = is_shipped_alone || shelf.empty() ? fs::path(root).filename().string() : shelf;
    all.push_back({named, way_from(root, file.path), root});
  }
  return all;
}

std::string shared_rests_on(const SharedFile& file, const std::vector<std::pair<std::string, std::string>>& rests_on,
                            const std::string& named) {
  std::vector<std::pair<std::string, std::string>> shared;
  for (const auto& [path, hash] : rests_on) {
    if (std::string way = way_from(file.root, path); !way.empty())
      shared.emplace_back(std::move(way), hash);
    else if (!hash.empty())
      return {};
  }
  return rests_on_text(shared, named);
}

Result<> put_into_shared(const SharedDatabase& database, const std::vector<SharedChange>& changes,
                         const std::string& device) {
  return database.in_transaction([&]() -> Result<> {
    const auto state = begin_state(database, device);
    if (!state) return state.error();
    Added added;
    for (const SharedChange& each : changes)
      if (const auto put = put_file(database, each, *state, added); !put) return put;
    return end_state(database, *state, added.materials, added.length);
  });
}

Result<std::size_t> take_out_of_shared(const SharedDatabase& database, const std::vector<std::string>& keys,
                                       const std::string& device) {
  std::size_t count = 0;
  const auto taken = database.in_transaction([&]() -> Result<> {
    const auto state = begin_state(database, device);
    if (!state) return state.error();
    const std::string all = array_of_keys(keys);
    const auto gone = database.ask(
        "WITH taken AS (DELETE FROM wale.materials WHERE file = ANY ($1::bytea[]) RETURNING id, length), "
        "told AS (INSERT INTO wale.gone(material, state) SELECT id, $2::bigint FROM taken) "
        "SELECT count(*), coalesce(sum(length), 0) FROM taken",
        {all, state->number});
    if (!gone) return gone.error();
    count = static_cast<std::size_t>(gone->number(0, 0));
    if (const auto files = database.run("DELETE FROM wale.files WHERE key = ANY ($1::bytea[])", {all}); !files) return files;
    return end_state(database, *state, -gone->number(0, 0), -gone->number(0, 1));
  });
  return taken ? Result<std::size_t>(count) : Result<std::size_t>(taken.error());
}

std::string array_of_keys(const std::vector<std::string>& keys) {
  std::vector<std::string> texts;
  for (const std::string& key : keys) texts.push_back("\\x" + key);
  return array_of_texts(texts);
}

std::string meant_key(std::string_view text) { return ContentHash().take(text).digits(); }

std::string felt_digits(const std::vector<std::pair<std::string, float>>& felt) {
  std::string digits;
  const auto put = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) fmt::format_to(std::back_inserter(digits), "{:02x}", value >> (8 * i) & 0xff);
  };
  for (const auto& [name, value] : felt) {
    if (name.size() > 0xffff) continue;  // no percept is called so
    put(static_cast<std::uint32_t>(name.size()), 2);
    for (const char c : name) put(static_cast<unsigned char>(c), 1);
    put(std::bit_cast<std::uint32_t>(value), 4);
  }
  return digits;
}

std::vector<std::pair<std::string, float>> felt_of_digits(std::string_view digits) {
  std::string bytes;
  const auto digit = [](char c) { return c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10; };
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(digit(digits[i]) << 4 | digit(digits[i + 1]));
  std::size_t at = 0;
  const auto take = [&](int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at++])} << (8 * i);
    return value;
  };
  std::vector<std::pair<std::string, float>> felt;
  while (bytes.size() - at >= 2) {
    const std::size_t length = take(2);
    if (bytes.size() - at < length + 4) break;
    std::string name = bytes.substr(at, length);
    at += length;
    felt.emplace_back(std::move(name), std::bit_cast<float>(take(4)));
  }
  return felt;
}

}  // namespace wale
