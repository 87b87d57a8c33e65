// Several curators write at once, and one is killed: nothing is lost, nothing is half there, and readers see whole materials.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <random>
#include <set>
#include <thread>

#include "library/index/find.hpp"
#include "library/index/words.hpp"
#include "library/store/shared_changes.hpp"
#include "tests/shared_index/server.hpp"

namespace wale::shared_index::curators_test {
namespace {

using Curators = Server;

/// Does `work` in another process.
pid_t in_process(const std::function<bool()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work() ? 0 : 1);
  return child;
}

bool ended_well(pid_t child) {
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

constexpr int curators = 4, files_each = 5, materials_each = 3;

std::string shelf_of(int curator) { return "shelf" + std::to_string(curator); }

/// A file of which each material says the round in which it was written. Nothing is compiled: what is tried is the database.
SharedChange change(int curator, int file, int round) {
  SharedChange made;
  made.file = {shelf_of(curator), "f" + std::to_string(file) + ".wale", ""};
  made.known = {"f" + std::to_string(file), "[]", ""};
  for (int i = 0; i < materials_each; ++i) {
    Entry& entry = made.entries.emplace_back();
    entry.name = "c" + std::to_string(curator) + "f" + std::to_string(file) + "m" + std::to_string(i);
    entry.module = made.known.module, entry.file = made.file.path(), entry.licence = "CC0-1.0";
    entry.documentation = "round" + std::to_string(round), entry.title = "Thing of " + shelf_of(curator);
    entry.content = std::to_string(round);
  }
  return made;
}

/// Empty if a reader sees only whole files now: all materials of one round, their words and names with them.
std::string why_not_whole(const std::string& address, const std::string& cache) {
  const auto store = LibraryStore::open(address, false, cache);
  if (!store) return in_words(store.error());
  const MaterialIndex& index = (*store)->index();
  const FeltColumns& columns = index.columns();
  if (columns.size() % materials_each != 0) return std::to_string(columns.size()) + " materials";
  if (index.words().size().materials != columns.size()) return "another number of materials is told";
  std::map<std::string, std::set<std::string>> rounds;
  std::map<std::string, int> counts;
  std::uint64_t length = 0;
  for (std::size_t row = 0; row < columns.size(); ++row) {
    const auto entry = index.entry(columns.material(row));
    if (!entry) return in_words(entry.error());
    rounds[entry->file].insert(entry->documentation);
    ++counts[entry->file];
    length += count_words(*entry).length;
    const auto found = find_entries(index, {.texts = {entry->name + " " + entry->documentation}, .kind = {}, .without = {}, .most = 2});
    if (!found || found->all != 1) return entry->name + " is not found by its words";
    if (!meant_entry(index, entry->name)) return entry->name + " is not meant by its name";
  }
  if (length != index.words().size().length) return "another length is told";
  for (const auto& [file, all] : rounds)
    if (all.size() != 1 || counts[file] != materials_each) return file + " is half there";
  return {};
}

TEST_F(Curators, FourWriteWhileOneIsKilled) {
  opened(address(), true);
  std::mt19937 random(20);
  for (int round = 1; round <= 8; ++round) {
    std::vector<pid_t> writers;
    for (int curator = 0; curator < curators; ++curator)
      writers.push_back(in_process([&] {
        const auto database = SharedDatabase::open(address());
        if (!database) return false;
        for (int file = 0; file < files_each; ++file)
          if (!put_into_shared(*database, {change(curator, file, round)}, default_device)) return false;
        return true;
      }));
    const pid_t reader = in_process([&] {
      for (int i = 0; i < 6; ++i)
        if (const std::string why = why_not_whole(address(), i % 2 == 0 ? folder_.path().string() : std::string()); !why.empty())
          return std::fprintf(stderr, "a reader sees: %s\n", why.c_str()), false;
      return true;
    });
    const std::size_t victim = random() % writers.size();
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 60'000));
    kill(writers[victim], SIGKILL);
    for (std::size_t i = 0; i < writers.size(); ++i) {
      const bool well = ended_well(writers[i]);
      EXPECT_TRUE(well || i == victim) << "curator " << i << " in round " << round;
    }
    EXPECT_TRUE(ended_well(reader)) << "round " << round;
    EXPECT_EQ(why_not_whole(address(), {}), "") << "after round " << round;
    // What the others have written is all there.
    const auto store = opened(address(), false);
    for (int curator = 0; curator < curators; ++curator)
      for (int file = 0; file < files_each && static_cast<std::size_t>(curator) != victim; ++file) {
        const auto meant = meant_entry(store->index(), change(curator, file, round).entries.front().name);
        ASSERT_TRUE(meant) << in_words(meant.error());
        EXPECT_EQ(store->index().entry(*meant)->documentation, "round" + std::to_string(round));
      }
    // The killed one does it again, and has all of its own.
    const auto again = SharedDatabase::open(address());
    for (int file = 0; file < files_each; ++file)
      ASSERT_TRUE(put_into_shared(*again, {change(static_cast<int>(victim), file, round)}, default_device));
    EXPECT_EQ(opened(address(), false)->index().columns().size(), static_cast<std::size_t>(curators * files_each * materials_each));
  }
  EXPECT_EQ(number("SELECT count(*) FROM wale.words WHERE NOT EXISTS (SELECT FROM wale.materials WHERE id = material)"), 0);
  EXPECT_EQ(number("SELECT count(*) FROM wale.gone"), 0) << "materials that stay keep their numbers";
}

/// Four who write the same file: it is that of one of them.
TEST_F(Curators, OfOneFileTheLastHasIt) {
  opened(address(), true);
  std::vector<pid_t> writers;
  for (int curator = 0; curator < curators; ++curator)
    writers.push_back(in_process([&] {
      const auto database = SharedDatabase::open(address());
      if (!database) return false;
      for (int round = 0; round < 10; ++round)
        if (!put_into_shared(*database, {change(0, 0, 10 * curator + round)}, default_device)) return false;
      return true;
    }));
  for (const pid_t each : writers) EXPECT_TRUE(ended_well(each));
  EXPECT_EQ(why_not_whole(address(), {}), "");
  EXPECT_EQ(opened(address(), false)->index().columns().size(), static_cast<std::size_t>(materials_each));
}

/// The whole way, from files of libraries that are compiled and read.
TEST_F(Curators, PublishTheirLibrariesWhileOneIsKilled) {
  opened(address(), true);
  std::mt19937 random(7);
  const auto write_round = [&](int curator, int round) {
    write_library(shelf_of(curator));
    for (int file = 0; file < 3; ++file)
      write(shelf_of(curator) + "/f" + std::to_string(file) + ".wale",
            "wale 1\n" + ribs("a" + std::to_string(curator) + std::to_string(file), 0.3 + 0.1 * file, 2 + 0.3 * round, "round" + std::to_string(round)) +
                ribs("b" + std::to_string(curator) + std::to_string(file), 0.4, 3, "round" + std::to_string(round)));
  };
  const auto publish = [&](int curator) {
    auto store = LibraryStore::open(address(), true);
    return store && (*store)->bring_up_to_date(files_of(shelf_of(curator)), {});
  };
  for (int round = 0; round < 2; ++round) {
    std::vector<pid_t> writers;
    for (int curator = 0; curator < curators; ++curator) write_round(curator, round);
    for (int curator = 0; curator < curators; ++curator) writers.push_back(in_process([&] { return publish(curator); }));
    const std::size_t victim = random() % writers.size();
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 700));
    kill(writers[victim], SIGKILL);
    for (std::size_t i = 0; i < writers.size(); ++i) {
      const bool well = ended_well(writers[i]);
      EXPECT_TRUE(well || i == victim);
    }
    EXPECT_TRUE(publish(static_cast<int>(victim)));
    const auto store = opened(address(), false);
    ASSERT_EQ(store->index().columns().size(), static_cast<std::size_t>(curators * 6));
    for (std::size_t row = 0; row < store->index().columns().size(); ++row)
      EXPECT_EQ(store->index().entry(store->index().columns().material(row))->documentation, "round" + std::to_string(round));
  }
  // Nothing has changed, so nothing is read again, by whomever.
  for (int curator = 0; curator < curators; ++curator)
    EXPECT_EQ(updated(*opened(address(), true), files_of(shelf_of(curator))).read, 0u);
}

}  // namespace
}  // namespace wale::shared_index::curators_test
