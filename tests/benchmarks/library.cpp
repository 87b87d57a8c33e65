// How long it takes to find among many materials: rows are made from the entries of an index, each size of a cue times a
// random factor, and words from those of the entries. tests/benchmarks/library makes the index and prints what it measures.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "compiler/modules/load_modules.hpp"
#include "library/index/find.hpp"
#include "library/index/nearest.hpp"
#include "library/store/library_store.hpp"

namespace {

using namespace wale;

double milliseconds_of(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

void tell(const std::string& what, std::vector<double> times) {
  std::ranges::sort(times);
  std::printf("%-46s %8.2f ms in the median, %8.2f at most\n", what.c_str(), times[times.size() / 2], times.back());
}

/// A row like an entry, but with other sizes; some cues are as they were, and some are not there.
FeltRow another(const FeltRow& row, std::uint32_t material, std::mt19937& random) {
  std::normal_distribution<float> spread(0, 0.4f);
  FeltRow made = row;
  made.material = material, made.name += "_" + std::to_string(material);
  for (auto& [quantity, value] : made.felt)
    if (random() % 3 != 0) value *= std::exp(spread(random));
  std::erase_if(made.felt, [&](const auto&) { return random() % 20 == 0; });
  return made;
}

void measure_nearest(const std::vector<Entry>& entries, std::size_t count) {
  std::mt19937 random(20);
  std::vector<FeltRow> shipped;
  for (const Entry& entry : entries) shipped.push_back(felt_row(entry, 0));
  FeltColumnsBuilder builder;
  for (std::uint32_t i = 0; i < count; ++i) builder.add(another(shipped[random() % shipped.size()], i, random));
  const FeltColumns columns = builder.finish(1);
  const Comparer comparer(common_modules()->declarations, default_device);
  std::vector<double> near, levels, between;
  for (int round = 0; round < 40; ++round) {
    const auto any = [&]() -> const Cues& {
      for (;;)
        if (const Entry& entry = entries[random() % entries.size()]; entry.felt.cues) return *entry.felt.cues;
    };
    const NearProbe one(comparer, any());
    near.push_back(milliseconds_of([&] { (void)nearest(columns, one, 20); }));
    const BetweenProbe two(comparer, any(), any());
    between.push_back(milliseconds_of([&] { (void)nearest(columns, two, 20); }));
    const auto probe = LevelProbe::make({{"roughness", 0.2 + 0.01 * round, 0.2 + 0.01 * round}, {"stickiness", 0.1, 0.6}},
                                        common_modules()->declarations, default_device);
    levels.push_back(milliseconds_of([&] { (void)nearest(columns, **probe, 20); }));
  }
  const std::string among = " among " + std::to_string(count);
  tell("20 nearest" + among, near);
  tell("20 between two" + among, between);
  tell("20 by two levels" + among, levels);
}

void measure_words(const std::vector<Entry>& entries, std::size_t count) {
  std::mt19937 random(21);
  std::vector<Entry> many;
  for (std::size_t i = 0; i < count; ++i) {
    Entry& made = many.emplace_back(entries[random() % entries.size()]);
    made.name += "_" + std::to_string(i);
    // Words of its own beside those that many have.
    made.documentation += " n" + std::to_string(random() % count) + " k" + std::to_string(random() % 1000);
    made.felt = {}, made.program.clear(), made.parameters.clear();
  }
  const auto index = index_of(std::move(many), default_device);
  std::vector<double> times;
  for (int round = 0; round < 40; ++round) {
    const Entry& entry = entries[random() % entries.size()];
    const std::string text = entry.title + (round % 2 == 0 ? "" : " k" + std::to_string(random() % 1000));
    times.push_back(milliseconds_of([&] { (void)find_entries(*index, {.texts = {text}, .kind = {}, .without = {}, .most = 20}); }));
  }
  tell("a title in words among " + std::to_string(count), times);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return std::fputs("usage: bench_library INDEX\n", stderr), 2;
  const auto store = LibraryStore::open(words[1], false);
  if (!store) return std::fprintf(stderr, "%s\n", in_words(store.error()).c_str()), 1;
  std::vector<Entry> entries;
  const MaterialIndex& index = (*store)->index();
  for (std::size_t row = 0; row < index.columns().size(); ++row)
    if (auto entry = index.entry(index.columns().material(row))) entries.push_back(*std::move(entry));
  if (entries.empty()) return std::fputs("the index has no material\n", stderr), 1;
  measure_nearest(entries, 100'000);
  measure_nearest(entries, 1'000'000);
  measure_words(entries, 100'000);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  std::printf("memory at most %ld MB\n", used.ru_maxrss / 1024);
}
