// The scan against a comparison of every pair by `Comparer::compare`.
#include "library/index/nearest.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compiler/modules/load_modules.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::nearest_test {
namespace {

const Declarations& declarations() { return common_modules()->declarations; }
const Comparer& comparer() {
  static const Comparer known(declarations(), default_device);
  return known;
}

/// Cues of any size, half of them unknown, some much alike.
Cues any_cues(std::mt19937& random) {
  Cues cues{.material = {}, .device = default_device, .values = {}};
  std::uniform_real_distribution<double> share(0, 1);
  for (const CueFacts& facts : cue_table()) {
    if (share(random) < 0.85 && facts.kind != CueKind::amplitude) continue;
    if (share(random) < 0.2) continue;
    const double size = std::exp(6 * share(random) - 4);
    const double rounded = std::round(size * 20) / 20;  // so that some are equal
    cues[facts.kind] = share(random) < 0.1 ? -rounded : rounded;
  }
  return cues;
}

Entry felt_entry(const std::string& name, const Cues& cues) {
  Entry entry;
  entry.name = name, entry.module = "m." + name;
  entry.felt.cues = cues;
  return entry;
}

std::vector<FeltRow> any_rows(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<FeltRow> rows;
  for (std::size_t i = 0; i < count; ++i) {
    Entry entry = felt_entry("n" + std::to_string((i * 7919) % count), any_cues(random));
    // Levels and sizes: none, known, or unknown.
    for (const char* percept : {"roughness", "stickiness"}) {
      if (random() % 3 == 0) continue;
      EntryPercept& each = entry.felt.percepts.emplace_back();
      each.name = percept;
      if (random() % 4 != 0) each.reads = static_cast<double>(random() % 101) / 100;
      each.size = 3 * each.reads.value_or(0);
    }
    rows.push_back(felt_row(entry, static_cast<std::uint32_t>(2 * i + 1)));
  }
  return rows;
}

Cues cues_in(const FeltRow& row) {
  Cues cues{.material = row.name, .device = default_device, .values = {}};
  for (const auto& [name, value] : row.felt)
    for (const CueFacts& facts : cue_table())
      if (name == std::string("cue ") + facts.name) cues[facts.kind] = value;
  return cues;
}

/// The rank by the comparison that `wale compare` prints.
double slow_rank(const Cues& a, const Cues& b) {
  const Comparison comparison = comparer().compare(a, b);
  double low = 0, unknown = 0;
  for (const CueDifference& each : comparison.cues) {
    low = std::max(low, each.noticeable.value_or(0));
    unknown += !each.noticeable;
  }
  return low + unknown;
}

struct Expected {
  double rank;
  std::string name;
};

void expect_nearest(const std::vector<FeltRow>& rows, const Probe& probe, std::vector<Expected> expected,
                    std::size_t most) {
  std::ranges::sort(expected, [](const Expected& a, const Expected& b) {
    return std::tie(a.rank, a.name) < std::tie(b.rank, b.name);
  });
  const FeltColumns columns = FeltColumns::of(rows);
  const auto found = nearest(columns, probe, most);
  ASSERT_EQ(found.size(), std::min(most, expected.size()));
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(columns.name(found[i].row), expected[i].name) << i;
    EXPECT_EQ(found[i].distance.rank(), expected[i].rank) << i;
  }
}

TEST(Nearest, IsThatOfComparingAll) {
  const std::vector<FeltRow> rows = any_rows(5000, 1);
  for (const std::size_t which : {0u, 333u, 4999u})
    for (const std::size_t most : {1u, 10u, 200u}) {
      const Cues target = cues_in(rows[which]);
      std::vector<Expected> expected;
      for (const FeltRow& row : rows) expected.push_back({slow_rank(target, cues_in(row)), row.name});
      expect_nearest(rows, NearProbe(comparer(), target), std::move(expected), most);
    }
}

TEST(Nearest, IsItselfFirst) {
  const std::vector<FeltRow> rows = any_rows(100, 2);
  const FeltColumns columns = FeltColumns::of(rows);
  const auto found = nearest(columns, NearProbe(comparer(), cues_in(rows[42])), 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].distance.low, 0);
}

TEST(Nearest, KeepsWhatMayBeFound) {
  const std::vector<FeltRow> rows = any_rows(5000, 3);
  const FeltColumns columns = FeltColumns::of(rows);
  const NearProbe probe(comparer(), cues_in(rows[1]));
  const auto even = [](std::size_t row) { return row % 2 == 0; };
  for (const NearRow& each : nearest(columns, probe, 50, even)) EXPECT_EQ(each.row % 2, 0u);
  EXPECT_EQ(nearest(columns, probe, 50, even).size(), 50u);
  EXPECT_TRUE(nearest(columns, probe, 0).empty());
  EXPECT_TRUE(nearest(FeltColumns::of({}), probe, 5).empty());
}

// README.md: roughness 0.6 is 1.934 N of lateral amplitude, which is also the cue that the comparison has.
TEST(Nearest, ByALevelIsThatOfComparingAmplitudes) {
  const std::vector<FeltRow> rows = any_rows(5000, 4);
  const auto probe = LevelProbe::make({{"roughness", 0.6, 0.6}}, declarations(), default_device);
  ASSERT_TRUE(probe) << in_words(probe.error());
  const auto alone = [](double amplitude) {
    Cues cues{.material = {}, .device = default_device, .values = {}};
    if (amplitude > 0) cues[CueKind::amplitude] = amplitude;
    return cues;
  };
  std::vector<double> expected;
  for (const FeltRow& row : rows) {
    std::map<std::string, float> felt(row.felt.begin(), row.felt.end());
    const bool is_unknown = felt.contains("level roughness") && std::isnan(felt["level roughness"]);
    expected.push_back(is_unknown ? 1 : slow_rank(alone(1.934), alone(felt["size roughness"])));
  }
  std::ranges::sort(expected);
  const auto found = nearest(FeltColumns::of(rows), **probe, 2000);
  ASSERT_EQ(found.size(), 2000u);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i].distance.rank(), expected[i], 0.01) << i;
}

TEST(Nearest, BySeveralLevelsTakesTheLargestDistance) {
  const std::vector<FeltRow> rows = any_rows(300, 9);
  const auto make = [](std::vector<SoughtLevel> levels) {
    auto probe = LevelProbe::make(levels, declarations(), default_device);
    EXPECT_TRUE(probe) << in_words(probe.error());
    return *std::move(probe);
  };
  const auto rough = make({{"roughness", 0.6, 0.6}}), sticky = make({{"stickiness", 0.2, 0.2}});
  const auto both = make({{"roughness", 0.6, 0.6}, {"stickiness", 0.2, 0.2}});
  const FeltColumns columns = FeltColumns::of(rows);
  Cues scratch;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto a = rough->distance(columns, row, scratch), b = sticky->distance(columns, row, scratch);
    EXPECT_EQ(both->distance(columns, row, scratch)->low, std::max(a->low, b->low));
    EXPECT_EQ(both->distance(columns, row, scratch)->unknown, a->unknown + b->unknown);
    const Probe::Told told = both->tell(columns, row);
    EXPECT_EQ(told.unknown.size(), a->unknown + b->unknown);
    EXPECT_LE(told.low, told.high);
    EXPECT_TRUE(std::isfinite(told.high)) << "a level lies between none and all";
  }
}

TEST(Nearest, OfARangeReadsWithinIt) {
  const std::vector<FeltRow> rows = any_rows(5000, 5);
  const auto probe = LevelProbe::make({{"smoothness", 0.4, 0.6}}, declarations(), default_device);
  ASSERT_TRUE(probe);
  std::vector<Expected> expected;
  for (const FeltRow& row : rows)
    for (const auto& [name, value] : row.felt)
      if (name == "level roughness" && value >= 1 - 0.6 && value <= 1 - 0.4) expected.push_back({0, row.name});
  EXPECT_GT(expected.size(), 100u);
  expect_nearest(rows, **probe, std::move(expected), 10000);
}

TEST(Nearest, BetweenTwoIsNearerToBoth) {
  const std::vector<FeltRow> rows = any_rows(5000, 6);
  const Cues one = cues_in(rows[10]), other = cues_in(rows[20]);
  const double apart = comparer().interval(one, other).low;
  std::vector<Expected> expected;
  for (const FeltRow& row : rows) {
    const Cues here = cues_in(row);
    if (comparer().interval(one, here).low < apart && comparer().interval(other, here).low < apart)
      expected.push_back({std::max(slow_rank(one, here), slow_rank(other, here)), row.name});
  }
  expect_nearest(rows, BetweenProbe(comparer(), one, other), std::move(expected), 50);
}

TEST(Told, NamesWhatIsUnknown) {
  Cues a{.material = {}, .device = default_device, .values = {}}, b = a;
  a[CueKind::amplitude] = b[CueKind::amplitude] = 1;
  a[CueKind::period] = 2e-3;
  b[CueKind::grain] = 2e-3;
  const FeltColumns columns = FeltColumns::of({felt_row(felt_entry("b", b), 7)});
  const Probe::Told told = NearProbe(comparer(), a).tell(columns, 0);
  EXPECT_EQ(told.low, 0);
  EXPECT_TRUE(std::isinf(told.high));
  EXPECT_EQ(told.unknown, (std::vector<std::string>{"period", "grain"}));
}

// A thing without a wall has no face that could be hard or soft; a thing without a texture is smooth.
TEST(LevelProbe, KnowsNothingOfWhatIsAbsentWhereThePerceptSaysSo) {
  Cues cues{.material = {}, .device = default_device, .values = {}};
  cues[CueKind::amplitude] = 1;
  const FeltColumns columns = FeltColumns::of({felt_row(felt_entry("cloth", cues), 7)});
  Cues scratch;
  const auto make = [](const char* percept, double low, double high) {
    auto probe = LevelProbe::make({{percept, low, high}}, declarations(), default_device);
    EXPECT_TRUE(probe) << in_words(probe.error());
    return *std::move(probe);
  };
  const auto soft = make("softness", 0.8, 0.8), slippery = make("slipperiness", 0.9, 0.9);
  const auto unknown = soft->distance(columns, 0, scratch), known = slippery->distance(columns, 0, scratch);
  ASSERT_TRUE(unknown && known);
  EXPECT_EQ(unknown->unknown, 1u);
  EXPECT_EQ(unknown->low, 0);
  EXPECT_EQ(soft->tell(columns, 0).unknown, std::vector<std::string>{"softness"});
  EXPECT_GT(soft->tell(columns, 0).high, 0);
  EXPECT_EQ(known->unknown, 0u);
  EXPECT_FALSE(make("softness", 0.8, 1)->distance(columns, 0, scratch)) << "unknown is in no range";
  EXPECT_TRUE(make("slipperiness", 0.8, 1)->distance(columns, 0, scratch)) << "none of it is in a range that has none";
}

TEST(LevelProbe, RefusesWhatIsNoPercept) {
  const auto probe = LevelProbe::make({{"roughnes", 0.6, 0.6}}, declarations(), default_device);
  ASSERT_FALSE(probe);
  EXPECT_EQ(probe.error().code, Code::unknown_name);
  EXPECT_NE(probe.error().mend.find("roughness"), std::string::npos);
}

TEST(FeltColumns, AreTheSameFromAFile) {
  const std::vector<FeltRow> rows = any_rows(300, 7);
  const TemporaryFolder folder;
  const FeltColumns made = FeltColumns::of(rows, 12);
  ASSERT_TRUE(made.write(folder / "columns"));
  const auto mapped = FeltColumns::map(folder / "columns");
  ASSERT_TRUE(mapped) << in_words(mapped.error());
  EXPECT_EQ(mapped->generation(), 12u);
  ASSERT_EQ(mapped->size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FeltRow row = mapped->row(i);
    EXPECT_EQ(row.material, rows[i].material);
    EXPECT_EQ(row.name, rows[i].name);
    EXPECT_EQ(row.module, rows[i].module);
    std::map<std::string, float> expected(rows[i].felt.begin(), rows[i].felt.end());
    std::map<std::string, float> found(row.felt.begin(), row.felt.end());
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [name, value] : expected)
      EXPECT_TRUE(found.at(name) == value || (std::isnan(value) && std::isnan(found.at(name)))) << name;
    EXPECT_EQ(mapped->row_of(row.material), i);
    EXPECT_FALSE(mapped->row_of(row.material + 1));
  }
}

TEST(FeltColumns, RefuseDamagedFiles) {
  const TemporaryFolder folder;
  ASSERT_TRUE(FeltColumns::of(any_rows(20, 8)).write(folder / "columns"));
  std::ifstream in(folder / "columns", std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  const auto refused = [&](const std::string& bytes) {
    folder.write("damaged", bytes);
    return !FeltColumns::map(folder / "damaged");
  };
  EXPECT_FALSE(refused(whole));
  EXPECT_TRUE(refused(""));
  EXPECT_TRUE(refused("SQLite format 3"));
  EXPECT_TRUE(refused(std::string(4096, '\xff')));
  for (std::size_t size = 0; size < whole.size(); size += 37) EXPECT_TRUE(refused(whole.substr(0, size))) << size;
  // A changed byte is refused, or only another value: no read goes astray.
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    folder.write("damaged", changed);
    const auto columns = FeltColumns::map(folder / "damaged");
    for (std::size_t row = 0; columns && row < columns->size(); ++row)
      EXPECT_EQ(columns->row(row).felt.size(), columns->values(row).size());
  }
}

}  // namespace
}  // namespace wale::nearest_test
