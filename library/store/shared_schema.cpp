#include "library/store/shared_schema.hpp"

#include <fmt/format.h>

#include <array>

#include "library/store/shared_roles.hpp"

namespace wale {
namespace {

/// Each step makes the tables of one version from those of the version before. Steps never change; new ones are added.
///
/// Long texts have no place in an index of PostgreSQL, so files, materials and what people call them are known by the
/// SHA-256 of their texts. Words are short. Each statement of this program orders texts byte by byte, as SQLite does.
constexpr std::array steps = {
    // 1: what an index in a file has too.
    R"(
CREATE SCHEMA wale;
REVOKE ALL ON SCHEMA wale FROM PUBLIC;
CREATE TABLE wale.facts(name text PRIMARY KEY, value text NOT NULL);
INSERT INTO wale.facts VALUES('version', '1');
CREATE TABLE wale.files(key bytea PRIMARY KEY, shelf text NOT NULL, way text NOT NULL, module text NOT NULL,
  rests_on text NOT NULL, others text NOT NULL, build text NOT NULL);
CREATE INDEX files_of_shelf ON wale.files USING hash(shelf);
CREATE TABLE wale.materials(id integer GENERATED ALWAYS AS IDENTITY PRIMARY KEY, key bytea NOT NULL UNIQUE,
  file bytea NOT NULL REFERENCES wale.files ON DELETE CASCADE, name text NOT NULL, module text NOT NULL,
  kind text NOT NULL, trouble text NOT NULL, length integer NOT NULL, felt bytea NOT NULL, entry text NOT NULL);
CREATE INDEX materials_of_file ON wale.materials(file);
CREATE INDEX troubled_materials ON wale.materials(id) WHERE trouble <> '';
CREATE TABLE wale.words(word text COLLATE "C", material integer REFERENCES wale.materials ON DELETE CASCADE,
  weight integer NOT NULL, length integer NOT NULL, PRIMARY KEY(word, material));
CREATE INDEX words_of_material ON wale.words(material);
CREATE TABLE wale.meant(how smallint, key bytea, material integer REFERENCES wale.materials ON DELETE CASCADE,
  PRIMARY KEY(how, key, material));
CREATE INDEX meant_of_material ON wale.meant(material);
CREATE TABLE wale.present(one boolean PRIMARY KEY DEFAULT true CHECK(one), device text NOT NULL DEFAULT '',
  materials bigint NOT NULL DEFAULT 0, length bigint NOT NULL DEFAULT 0);
INSERT INTO wale.present DEFAULT VALUES;
)",
    // 2: states, so that a reader fetches only what has changed since it last looked. A stamp names a state in any database,
    // also in one that was restored from a copy.
    R"(
ALTER TABLE wale.present ADD COLUMN state bigint NOT NULL DEFAULT 0, ADD COLUMN stamp bigint NOT NULL DEFAULT 0;
ALTER TABLE wale.materials ADD COLUMN state bigint NOT NULL DEFAULT 0;
CREATE INDEX materials_of_state ON wale.materials(state);
CREATE TABLE wale.states(stamp bigint PRIMARY KEY, state bigint NOT NULL);
CREATE TABLE wale.gone(material integer PRIMARY KEY, state bigint NOT NULL);
CREATE INDEX gone_of_state ON wale.gone(state);
)"};
constexpr std::int64_t newest_version = steps.size();

/// One lock for all who make or change the tables of one database; "Wale". Who waits for others, also for readers, tries
/// again after some seconds, so that those who come later are not held up behind it.
constexpr const char* lock_tables = "SET LOCAL lock_timeout = '5s'; SELECT pg_catalog.pg_advisory_xact_lock(1466002533)";

/// 0 where there are no tables.
Result<std::int64_t> version_of(const SharedDatabase& database) {
  const auto there = database.ask("SELECT count(*) FROM pg_catalog.pg_tables WHERE schemaname = 'wale' AND tablename = 'facts'");
  if (!there) return there.error();
  if (there->number(0, 0) == 0) return std::int64_t{0};
  const auto version = database.ask("SELECT value FROM wale.facts WHERE name = 'version'");
  if (!version) return version.error();
  return version->size() == 1 ? version->number(0, 0) : std::int64_t{0};
}

Error newer(const SharedDatabase& database, std::int64_t version) {
  return {.code = Code::newer_file,
          .sentence = fmt::format("the shared index has version {}, and this Wale reads {}", version, newest_version),
          .mend = "use a newer Wale",
          .place = {.name = database.name()}};
}

Error older(const SharedDatabase& database, std::int64_t version) {
  if (version == 0)
    return {.code = Code::damaged_file,
            .sentence = "this database has no index of Wale",
            .mend = "make one: `wale library index --index postgresql://…`",
            .place = {.name = database.name()}};
  return {.code = Code::damaged_file,
          .sentence = fmt::format("the shared index has version {}, and this Wale reads {}", version, newest_version),
          .mend = "its owner brings it up to date: `wale library index --index postgresql://…`",
          .place = {.name = database.name()}};
}

}  // namespace

Result<> prepare_shared_schema(const SharedDatabase& database, bool makes) {
  const auto version = version_of(database);
  if (!version) return version.error();
  if (*version > newest_version) return newer(database, *version);
  if (*version == newest_version) return {};
  if (!makes) return older(database, *version);
  const auto made = database.in_transaction([&]() -> Result<> {
    if (const auto locked = database.run_all(lock_tables); !locked) return locked;
    const auto now = version_of(database);  // another process may have been first
    if (!now) return now.error();
    if (*now > newest_version) return newer(database, *now);
    for (std::int64_t step = *now; step < newest_version; ++step)
      if (const auto done = database.run_all(steps[static_cast<std::size_t>(step)]); !done) return done;
    if (*now == newest_version) return {};
    if (const auto told = database.run("UPDATE wale.facts SET value = $1 WHERE name = 'version'",
                                       {std::to_string(newest_version)});
        !told)
      return told;
    return database.run_all(grants_of_shared_index());
  });
  if (!made && database.was_forbidden() && *version > 0) return older(database, *version);
  return made;
}

}  // namespace wale
