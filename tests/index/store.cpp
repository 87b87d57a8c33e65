// The index in a database: it answers as an index in memory does, follows each change, and survives what is done to it.
#include "library/store/library_store.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "compiler/modules/load_modules.hpp"
#include "library/index/find.hpp"
#include "library/index/probe.hpp"
#include "library/store/kept_index.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::store_test {
namespace {

namespace fs = std::filesystem;

std::string material(const std::string& name, double level, double period, const std::string& more = "") {
  return "/// Ribs of " + name + ".\nmaterial " + name + " {\n  representative {\n    title \"The " + name +
         "\"\n    called \"ribbed " + name + "\"\n    called de \"Gröber " + name +
         "\"\n    kind trial.woven\n  }\n  perceptual { roughness " + std::to_string(level) +
         " estimated }\n  physical {\n    height ribs = cos(2 pi * x / " + std::to_string(period) +
         " mm)\n    force = lateral(ribs)" + more + "\n  }\n}\n";
}

class Store : public testing::Test {
 protected:
  Store() { write("wale.project", "licence \"CC0-1.0\"\n"); }

  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  std::string path() const { return folder_ / "an.index"; }
  std::vector<LibraryFile> files() const { return *library_files_in(std::vector<std::string>{folder_ / "shelf"}); }

  /// Opens the index anew and brings it up to date.
  std::unique_ptr<LibraryStore> updated() {
    auto store = LibraryStore::open(path(), true);
    EXPECT_TRUE(store) << (store ? "" : in_words(store.error()));
    const auto report = (*store)->bring_up_to_date(files(), {});
    EXPECT_TRUE(report) << (report ? "" : in_words(report.error()));
    report_ = *report;
    return *std::move(store);
  }

  static std::vector<std::string> names(const Result<FoundEntries>& found) {
    std::vector<std::string> all;
    for (const FoundEntry& each : found->entries) all.push_back(each.entry.name);
    return all;
  }

  TemporaryFolder folder_;
  StoreReport report_;
};

TEST_F(Store, IsCopiedWithAllThatIsKnown) {
  write("shelf/one.wale", "wale 1\n" + material("one", 0.4, 2));
  write("shelf/two.wale", "wale 1\n" + material("two", 0.4, 3));
  const auto store = updated();
  ASSERT_TRUE(store->copy_to(folder_ / "copy.index"));
  EXPECT_FALSE(store->copy_to(folder_ / "copy.index")) << "nothing is written over";
  write("shelf/three.wale", "wale 1\n" + material("three", 0.4, 4));
  auto copy = LibraryStore::open(folder_ / "copy.index", false);
  ASSERT_TRUE(copy) << in_words(copy.error());
  EXPECT_TRUE((*copy)->is_of_this_wale());
  const auto report = (*copy)->bring_up_to_date(files(), {});
  ASSERT_TRUE(report) << in_words(report.error());
  EXPECT_EQ(report->read, 1u) << "what was known is not read again";
  EXPECT_EQ(report->materials, 3u);
}

TEST_F(Store, BeginsInAnotherFolderWithWhatIsKnownOfTheShippedOnes) {
  // The shipped library has hundreds of files; here two of them stand for it.
  const auto shipped = *library_files_in(std::vector<std::string>{});
  std::vector<LibraryFile> some;
  for (const LibraryFile& each : shipped)
    if (each.module == "fabric.denim" || each.module == "fluid.soda") some.push_back(each);
  ASSERT_EQ(some.size(), 2u);
  setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
  const fs::path before = fs::current_path();
  std::size_t read = 0;
  for (const char* place : {"a", "b"}) {
    write(std::string(place) + "/own.wale", "wale 1\n" + material(place, 0.4, 2));
    fs::current_path(folder_ / place);
    std::vector<LibraryFile> here = some;
    here.push_back({"own.wale", "own"});
    IndexHere index;
    const auto opened = refresh_kept(index, {}, here, {});
    ASSERT_TRUE(opened) << in_words(opened.error());
    EXPECT_EQ(index.report.materials, 3u);
    read = index.report.read;
  }
  fs::current_path(before);
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(read, 1u) << "the folder's own";
}

TEST_F(Store, ReadsOnlyWhatChangesAndWhatRestsOnIt) {
  write("shelf/parts.wale", "wale 1\nexport let rib = 2 mm\n" + material("part", 0.4, 2));
  write("shelf/uses.wale", "wale 1\nimport parts\n" + material("uses", 0.5, 3, "\n    show line(vector(-rib, 0 mm), vector(rib, 0 mm))"));
  write("shelf/alone.wale", "wale 1\n" + material("alone", 0.6, 2.5));
  write("shelf/names.wale", "wale 1\nmaterial mixed = 0.5 alone + 0.5 part {\n  representative { title \"Mixed\" }\n}\n");
  updated();
  EXPECT_EQ(report_.materials, 4u);
  EXPECT_EQ(report_.read, 4u);
  ASSERT_TRUE(report_.troubled.empty()) << report_.troubled[0].material << ": " << report_.troubled[0].why;
  updated();
  EXPECT_EQ(report_.read, 0u);
  // One that nothing rests on but what names it without an import.
  write("shelf/alone.wale", "wale 1\n" + material("alone", 0.7, 2.5));
  updated();
  EXPECT_EQ(report_.read, 2u) << "alone and mixed";
  // One that another imports.
  write("shelf/parts.wale", "wale 1\nexport let rib = 3 mm\n" + material("part", 0.4, 2));
  updated();
  EXPECT_EQ(report_.read, 3u) << "part, uses and mixed";
  fs::remove(folder_ / "shelf/names.wale");
  const auto store = updated();
  EXPECT_EQ(report_.gone, 1u);
  EXPECT_EQ(report_.materials, 3u);
  EXPECT_FALSE(meant_entry(store->index(), "mixed"));
}

TEST_F(Store, KeepsColumnsAsIfTheyWereMadeAnew) {
  for (int i = 0; i < 4; ++i)
    write("shelf/m" + std::to_string(i) + ".wale", "wale 1\n" + material("m" + std::to_string(i), 0.3 + 0.1 * i, 2 + 0.5 * i));
  updated();
  write("shelf/m1.wale", "wale 1\n" + material("m1", 0.8, 4) + material("more", 0.2, 2));
  write("shelf/new.wale", "wale 1\n" + material("new", 0.5, 6));
  fs::remove(folder_ / "shelf/m2.wale");
  const auto rows_of = [](const LibraryStore& store) {
    std::vector<FeltRow> rows;
    for (std::size_t i = 0; i < store.index().columns().size(); ++i) {
      rows.push_back(store.index().columns().row(i));
      std::ranges::sort(rows.back().felt);
    }
    return rows;
  };
  const std::vector<FeltRow> kept = rows_of(*updated());
  fs::remove(path() + ".felt");
  const std::vector<FeltRow> anew = rows_of(**LibraryStore::open(path(), false));
  ASSERT_EQ(kept.size(), 5u);
  ASSERT_EQ(anew.size(), kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].material, anew[i].material);
    EXPECT_EQ(kept[i].name, anew[i].name);
    EXPECT_EQ(kept[i].kind, anew[i].kind);
    EXPECT_EQ(kept[i].felt, anew[i].felt) << kept[i].name;
  }
}

TEST_F(Store, ReadsWhatNamesOthersAgainWhenNamesChange) {
  write("shelf/alone.wale", "wale 1\n" + material("alone", 0.6, 2.5));
  write("shelf/beside.wale", "wale 1\n" + material("beside", 0.5, 3));
  write("shelf/names.wale", "wale 1\nmaterial soft_one = alone {\n  representative { title \"Soft\" }\n}\n");
  updated();
  EXPECT_EQ(report_.read, 3u);
  // What a name means does not depend on how another material feels.
  write("shelf/beside.wale", "wale 1\n" + material("beside", 0.7, 3));
  updated();
  EXPECT_EQ(report_.read, 1u) << "beside";
  write("shelf/beside.wale", "wale 1\n" + material("beside_it", 0.7, 3));
  updated();
  EXPECT_EQ(report_.read, 2u) << "beside_it and soft_one: it might have been called `alone`";
  write("shelf/another.wale", "wale 1\n" + material("another", 0.3, 2));
  updated();
  EXPECT_EQ(report_.read, 2u) << "another and soft_one";
  fs::remove(folder_ / "shelf/another.wale");
  updated();
  EXPECT_EQ(report_.read, 1u) << "soft_one";
  updated();
  EXPECT_EQ(report_.read, 0u);
}

TEST_F(Store, AnswersAsAnIndexInMemoryDoes) {
  for (int i = 0; i < 12; ++i)
    write("shelf/m" + std::to_string(i) + ".wale",
          "wale 1\n" + material("m" + std::to_string(i), 0.25 + 0.05 * i, 1.5 + 0.2 * (i * 5 % 12)));
  const auto store = updated();
  const auto memory = index_of(*read_library(files(), {}), default_device);
  const Declarations& declarations = common_modules()->declarations;
  const Comparer comparer(declarations, default_device);
  for (const MaterialIndex* index : {&store->index(), static_cast<const MaterialIndex*>(memory.get())}) ASSERT_EQ(index->columns().size(), 12u);
  for (int i = 0; i < 12; ++i) {
    const std::string name = "m" + std::to_string(i);
    const auto in_store = meant_entry(store->index(), name), in_memory = meant_entry(*memory, name);
    ASSERT_TRUE(in_store && in_memory);
    const Entry entry = *store->index().entry(*in_store);
    EXPECT_EQ(entry.content, memory->entry(*in_memory)->content);
    EXPECT_EQ(entry.felt.percepts, memory->entry(*in_memory)->felt.percepts);
    EXPECT_EQ(entry.felt.cues->values, memory->entry(*in_memory)->felt.cues->values);
    EXPECT_EQ(entry.licence, "CC0-1.0");
    const NearProbe probe(comparer, *entry.felt.cues);
    const MaterialQuery near{.texts = {}, .kind = "trial", .feel = &probe, .without = {}, .most = 5};
    EXPECT_EQ(names(find_entries(store->index(), near)), names(find_entries(*memory, near)));
    EXPECT_EQ(names(find_entries(store->index(), near)).front(), name) << "nothing is nearer than itself";
  }
  for (const char* text : {"rib", "grober m3", "the", "m1", "nothing", "rib%", "m_"}) {
    const MaterialQuery words{.texts = {text}, .kind = {}, .without = {}, .most = 20};
    const auto one = find_entries(store->index(), words), other = find_entries(*memory, words);
    ASSERT_EQ(names(one), names(other)) << text;
    for (std::size_t i = 0; i < one->entries.size(); ++i) EXPECT_EQ(one->entries[i].score, other->entries[i].score);
  }
  EXPECT_TRUE(meant_entry(store->index(), "gröber M3")) << "capitals and marks do not matter";
}

TEST_F(Store, TellsWhatCannotBeFelt) {
  write("shelf/good.wale", "wale 1\n" + material("good", 0.5, 2));
  write("shelf/wrong.wale", "wale 1\nmaterial wrong { physical { force = nothing_such(x) } }\n");
  write("shelf/noise.wale", std::string("\xff\xfe\0\1 no text", 13));
  updated();
  EXPECT_EQ(report_.troubled.size(), 2u);
  const auto store = updated();
  EXPECT_EQ(report_.read, 0u);
  EXPECT_EQ(report_.troubled.size(), 2u) << "also when nothing has changed";
  EXPECT_EQ(store->index().columns().size(), 3u);
}

TEST_F(Store, NamesFilesInWhichNoMaterialCanBeRead) {
  write("shelf/good.wale", "wale 1\n" + material("good", 0.5, 2));
  write("shelf/garbage.wale", "garbage");
  write("shelf/number.wale", "wale 1\n\nmaterial 2e_b {\n  physical { force = 1 N }\n}\n");
  write("shelf/functions.wale", "wale 1\n\nexport function half(a: length) = a / 2\n");
  const auto store = updated();
  ASSERT_EQ(report_.troubled.size(), 2u) << "and a file without materials is none of them";
  EXPECT_EQ(fs::path(report_.troubled[0].file).filename(), "garbage.wale");
  EXPECT_EQ(fs::path(report_.troubled[1].file).filename(), "number.wale");
  for (const auto& each : report_.troubled) EXPECT_NE(each.why, "");
  EXPECT_TRUE(meant_entry(store->index(), "good"));
}

// Nothing is known of what such a material feels like, so it is no neighbour of anything and has no level.
TEST_F(Store, WhatDoesNotCompileIsNotFoundByFeel) {
  const std::string broken = "broken { physical { force = nothing_such(x) } }";
  write("shelf/a.wale", "wale 1\n" + material("a", 0.5, 2));
  write("shelf/b.wale", "wale 1\n" + material("b", 0.3, 3));
  write("shelf/broken.wale", "wale 1\n/// Ribs that are broken.\nmaterial " + broken + "\n");
  write("shelf/air.wale", "wale 1\nmaterial air { physical { force = vector(0 N, 0 N) } }\n");
  updated();
  const auto store = updated();  // with columns from their file
  const MaterialIndex& index = store->index();
  const Comparer comparer(common_modules()->declarations, index.device());
  const auto entry = index.entry(*meant_entry(index, "a"));
  ASSERT_TRUE(entry && entry->felt.cues);
  const NearProbe near(comparer, *entry->felt.cues);
  const auto level = [&](double low, double high) {
    return *LevelProbe::make({{"roughness", low, high}}, common_modules()->declarations, index.device());
  };
  const auto none = level(0, 0), range = level(0, 1);
  for (const Probe* probe : {static_cast<const Probe*>(&near), static_cast<const Probe*>(none.get()), static_cast<const Probe*>(range.get())}) {
    auto found = names(find_entries(index, {.texts = {}, .kind = {}, .feel = probe, .most = 20}));
    std::ranges::sort(found);
    EXPECT_EQ(found, (std::vector<std::string>{"a", "air", "b"})) << "what is built and pushes nothing is known";
  }
  const auto by_word = find_entries(index, {.texts = {"broken"}, .kind = {}, .most = 20});
  ASSERT_EQ(names(by_word), std::vector<std::string>{"broken"});
  EXPECT_NE(by_word->entries[0].entry.trouble, "");
}

TEST_F(Store, RefusesWhatIsNoIndex) {
  const auto refused = [](const std::string& path, bool makes) {
    const auto opened = LibraryStore::open(path, makes);
    return opened ? Code{} : opened.error().code;
  };
  EXPECT_EQ(refused(write("text", "this is no database, but a text of some length"), true), Code::damaged_file);
  EXPECT_EQ(refused(write("empty", ""), false), Code::damaged_file);
  EXPECT_EQ(refused(folder_ / "missing", false), Code::unreadable_file);
  EXPECT_EQ(refused(folder_ / "no/folder/an.index", true), Code::unreadable_file);
  EXPECT_EQ(refused(folder_.path().string(), true), Code::unreadable_file);
  write("shelf/good.wale", "wale 1\n" + material("good", 0.5, 2));
  updated();
  // Bytes in the middle of it.
  std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(0, std::ios::end);
  const auto size = static_cast<long>(file.tellp());
  ASSERT_GT(size, 8192);
  std::mt19937 random(5);
  for (long at = 4096; at < size; at += 97) file.seekp(at), file.put(static_cast<char>(random()));
  file.close();
  fs::remove(path() + ".felt");
  const auto opened = LibraryStore::open(path(), true);
  if (opened) {  // what it has of the damage, each answer tells
    const auto report = (*opened)->bring_up_to_date(files(), {});
    EXPECT_TRUE(report || report.error().code == Code::damaged_file);
  } else {
    EXPECT_EQ(opened.error().code, Code::damaged_file);
  }
}

/// The columns beside an index may be gone, of an older state, or no columns at all.
TEST_F(Store, MakesItsColumnsAgain) {
  write("shelf/good.wale", "wale 1\n" + material("good", 0.5, 2));
  updated();
  const std::string older = folder_ / "older.felt";
  fs::copy_file(path() + ".felt", older);
  write("shelf/other.wale", "wale 1\n" + material("other", 0.5, 2));
  updated();
  for (const std::string& put : {older, write("junk", "junk"), std::string()}) {
    fs::remove(path() + ".felt");
    if (!put.empty()) fs::copy_file(put, path() + ".felt");
    const auto store = LibraryStore::open(path(), false);
    ASSERT_TRUE(store);
    EXPECT_EQ((*store)->index().columns().size(), 2u) << put;
  }
}

TEST_F(Store, SurvivesAKilledProcess) {
  for (int i = 0; i < 8; ++i)
    write("shelf/m" + std::to_string(i) + ".wale", "wale 1\n" + material("m" + std::to_string(i), 0.4, 1.5 + 0.2 * i));
  std::mt19937 random(17);
  for (int round = 0; round < 6; ++round) {
    // Each round something has changed, and the process dies somewhere in the middle of it.
    write("shelf/m0.wale", "wale 1\n" + material("m0", 0.3 + 0.05 * round, 1.5));
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      auto store = LibraryStore::open(path(), true);
      if (store) (void)(*store)->bring_up_to_date(files(), {});
      _exit(0);
    }
    usleep(static_cast<useconds_t>(random() % 300'000));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  const auto store = updated();
  EXPECT_EQ(report_.materials, 8u);
  const Entry entry = *store->index().entry(*meant_entry(store->index(), "m0"));
  EXPECT_NEAR(*entry.felt.percept("roughness")->asked, 0.55, 1e-6);
}

}  // namespace
}  // namespace wale::store_test
