// Where a library has materials, and what changed between two versions of one: `coverage_of`, `changes_between`, sheets.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/modules/load_modules.hpp"
#include "library/survey/changes.hpp"
#include "library/survey/contact_sheet.hpp"
#include "library/survey/coverage.hpp"
#include "library/survey/survey.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::surveying_test {
namespace {

/// An entry that was not compiled, with these levels read.
Entry entry_with(const std::string& name, const std::vector<std::pair<std::string, double>>& levels, double around = 0.05) {
  Entry entry;
  entry.name = name, entry.kind = "fabric.woven", entry.program.resize(1), entry.device = default_device;
  for (const auto& [percept, level] : levels) {
    EntryPercept& each = entry.felt.percepts.emplace_back();
    each.name = percept, each.reads = level, each.means = {level - around, level + around};
  }
  return entry;
}

Entry with_period(const std::string& name, double period) {
  Entry entry = entry_with(name, {});
  Cues& cues = entry.felt.cues.emplace();
  cues.material = name, cues.device = default_device;
  cues[CueKind::amplitude] = 1.0, cues[CueKind::period] = period;
  return entry;
}

TEST(Coverage, NamesTheRangesThatNoIntervalReaches) {
  const Coverage coverage = coverage_of(
      {entry_with("a", {{"roughness", 0.3}}), entry_with("b", {{"roughness", 0.2}}), entry_with("c", {{"roughness", 0.9}}),
       entry_with("d", {})},
      {"hardness", "roughness"});
  EXPECT_EQ(coverage.materials, 4u);
  EXPECT_EQ(coverage.without, 1u);
  EXPECT_EQ(coverage.unfelt, std::vector<std::string>{"hardness"});
  ASSERT_EQ(coverage.percepts.size(), 1u);
  const CoveredPercept& roughness = coverage.percepts[0];
  EXPECT_EQ(roughness.levels[0].material, "b");
  // Covered are 0.15 .. 0.35 and 0.85 .. 0.95; the last twentieth is too narrow to be named.
  ASSERT_EQ(roughness.empty.size(), 2u);
  EXPECT_NEAR(roughness.empty[0].low, 0.35, 1e-12);
  EXPECT_NEAR(roughness.empty[0].high, 0.85, 1e-12);
  EXPECT_NEAR(roughness.empty[1].low, 0, 1e-12);
  EXPECT_NEAR(roughness.empty[1].high, 0.15, 1e-12);
  EXPECT_NE(coverage_text(coverage).find("none from 0.35 to 0.85, from 0.00 to 0.15\n"), std::string::npos);
}

TEST(Coverage, FindsTheLargestEmptyRectangleOfTwoPercepts) {
  // Both points are below roughness 0.5, so the right half is empty, and nothing larger.
  const Coverage coverage = coverage_of({entry_with("a", {{"roughness", 0.45}, {"hardness", 0.24}}, 0.02),
                                         entry_with("b", {{"roughness", 0.45}, {"hardness", 0.74}}, 0.02),
                                         entry_with("c", {{"roughness", 0.05}, {"hardness", 0.5}}, 0.02),
                                         entry_with("d", {{"hardness", 0.99}})},
                                        {});
  ASSERT_EQ(coverage.pairs.size(), 1u);
  const CoveredPair& pair = coverage.pairs[0];
  EXPECT_EQ(pair.materials, 3u) << "d has no roughness";
  EXPECT_EQ(coverage.percepts[pair.a].percept, "hardness");
  EXPECT_DOUBLE_EQ(pair.empty_b.low, 0.5);
  EXPECT_DOUBLE_EQ(pair.empty_b.high, 1);
  EXPECT_DOUBLE_EQ(pair.empty_a.low, 0);
  EXPECT_DOUBLE_EQ(pair.empty_a.high, 1);
}

TEST(Coverage, OfNothingAndOfHostileNames) {
  EXPECT_EQ(nlohmann::json::parse(coverage_json(coverage_of({}, {"roughness"}))).at("unfelt"), nlohmann::json({"roughness"}));
  const Coverage odd = coverage_of({entry_with("\x1b[2J\xff", {{"roughness", 7.0}})}, {});
  EXPECT_EQ(odd.percepts[0].levels[0].reads, 1) << "above the scale counts as its end";
  EXPECT_TRUE(nlohmann::json::accept(coverage_json(odd)));
}

class Changes : public testing::Test {
 protected:
  std::shared_ptr<const CommonModules> common_ = common_modules();
  Comparer comparer_{common_->declarations, default_device};
};

TEST_F(Changes, AreCountedInDifferencesThatPeopleNotice) {
  std::vector<Entry> before = {with_period("kept", 2e-3), with_period("changed", 2e-3), with_period("gone", 2e-3),
                               with_period("old_name", 2e-3)};
  std::vector<Entry> after = {with_period("kept", 2e-3), with_period("changed", 6e-3), with_period("fresh", 2e-3),
                              with_period("new_name", 2e-3)};
  after[3].replaces = {"old_name"};
  const LibraryChanges changes = changes_between(before, after, comparer_);
  EXPECT_EQ(changes.same, 1u);
  EXPECT_EQ(changes.removed, std::vector<std::string>{"gone"});
  EXPECT_EQ(changes.added, std::vector<std::string>{"fresh"}) << "what takes the place of another is counted once";
  ASSERT_EQ(changes.superseded.size(), 1u);
  EXPECT_EQ(changes.superseded[0].new_name, "new_name");
  ASSERT_EQ(changes.changed.size(), 1u);
  ASSERT_EQ(changes.changed[0].comparison.cues.size(), 1u);
  const CueDifference& cue = changes.changed[0].comparison.cues[0];
  EXPECT_EQ(cue.kind, CueKind::period);
  // ln(3) / ln(1 + w), w the Weber fraction that is declared for the period.
  ASSERT_TRUE(cue.threshold);
  EXPECT_NEAR(*cue.noticeable, std::log(3.0) / std::log(1 + cue.threshold->weber), 1e-6);
  EXPECT_FALSE(changes.keeps_promises());
  EXPECT_TRUE(nlohmann::json::accept(changes_json(changes)));
}

TEST_F(Changes, KeepPromisesWhereNamesKeepTheirMeaning) {
  std::vector<Entry> before = {with_period("kept", 2e-3), with_period("old_name", 2e-3)};
  std::vector<Entry> after = {with_period("kept", 2.01e-3), with_period("new_name", 9e-3)};
  after[0].title = "Another title", after[1].replaces = {"old_name"};
  const LibraryChanges changes = changes_between(before, after, comparer_);
  EXPECT_TRUE(changes.keeps_promises());
  ASSERT_EQ(changes.changed.size(), 1u);
  EXPECT_EQ(changes.changed[0].words, std::vector<std::string>{"title"});
  EXPECT_TRUE(changes_between({}, {}, comparer_).keeps_promises());
}

TEST_F(Changes, BreakPromisesWhereANameHasSeveralHeirs) {
  std::vector<Entry> after = {with_period("one", 2e-3), with_period("two", 9e-3)};
  for (Entry& each : after) each.replaces = {"old_name"};
  const LibraryChanges changes = changes_between({with_period("old_name", 2e-3)}, after, comparer_);
  ASSERT_EQ(changes.ambiguous.size(), 1u);
  EXPECT_EQ(changes.ambiguous[0].old_name, "old_name");
  EXPECT_EQ(changes.ambiguous[0].heirs, (std::vector<std::string>{"one", "two"}));
  EXPECT_TRUE(changes.superseded.empty() && changes.added.empty() && changes.removed.empty());
  EXPECT_FALSE(changes.keeps_promises());
  EXPECT_NE(changes_text(changes).find("old_name is replaced by several, so that its name means none: one, two\n"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(changes_json(changes)).at("ambiguous").at("old_name").size(), 2u);
}

TEST_F(Changes, BreakPromisesWhereTheNewVersionCannotBeBuilt) {
  const auto unbuilt = [](const std::string& name) {
    Entry entry;
    entry.name = name, entry.trouble = "an error", entry.device = default_device;
    return entry;
  };
  Entry heir = unbuilt("new_name");
  heir.replaces = {"kept"};
  const std::vector<Entry> before = {with_period("kept", 2e-3)};
  EXPECT_FALSE(changes_between(before, {unbuilt("kept")}, comparer_).keeps_promises());
  EXPECT_FALSE(changes_between(before, {heir}, comparer_).keeps_promises()) << "under a new name";
  EXPECT_FALSE(changes_between({unbuilt("kept")}, {unbuilt("kept")}, comparer_).keeps_promises());
  EXPECT_TRUE(changes_between({unbuilt("kept")}, before, comparer_).keeps_promises()) << "it was mended";
}

TEST(Survey, NamesTextsInWhichNoMaterialCanBeRead) {
  const TemporaryFolder folder;
  folder.write("good.wale", "wale 1\n\nmaterial good {\n  physical { force = lateral(grating(x, period: 3 mm), amplitude: 1 N) }\n}\n");
  folder.write("garbage.wale", "garbage");
  folder.write("number.wale", "wale 1\n\nmaterial 2e_b {\n  physical { force = 1 N }\n}\n");
  folder.write("functions.wale", "wale 1\n\nexport function half(a: length) = a / 2\n");
  const auto surveyed = survey({folder.path().string()}, {}, SurveyDepth::programs);
  ASSERT_TRUE(surveyed);
  EXPECT_EQ(surveyed->entries.size(), 1u);
  ASSERT_EQ(surveyed->unread.size(), 2u);
  EXPECT_TRUE(surveyed->unread[0].place.name.ends_with("garbage.wale")) << surveyed->unread[0].place.name;
  EXPECT_TRUE(surveyed->unread[1].place.name.ends_with("number.wale")) << surveyed->unread[1].place.name;
}

TEST(Sheet, LaysKindsOutInPagesOfTwentyFour) {
  std::vector<Entry> entries;
  for (int i = 0; i < 30; ++i) entries.push_back(entry_with("m" + std::to_string(100 + i), {}));
  for (int i = 0; i < 5; ++i) {
    entries.push_back(entry_with("s" + std::to_string(i), {}));
    entries.back().kind = "stone";
  }
  const auto pages = sheet_pages(entries);
  ASSERT_EQ(pages.size(), 2u);
  ASSERT_EQ(pages[0].kinds.size(), 1u);
  EXPECT_EQ(pages[0].kinds[0].entries.size(), 24u);
  ASSERT_EQ(pages[1].kinds.size(), 2u);
  EXPECT_EQ(pages[1].kinds[0].entries.front()->name, "m124");
  EXPECT_EQ(pages[1].kinds[1].kind, "stone");
  EXPECT_EQ(page_name("out/sheet.png", 2, 2), "out/sheet_02.png");
  EXPECT_EQ(page_name("sheet.png", 1, 1), "sheet.png");
  EXPECT_TRUE(sheet_pages({}).empty());
}

TEST(Sheet, HasAPictureOfWhatCanBeBuiltAndAReasonOfWhatCannot) {
  const TemporaryFolder folder;
  folder.write("a.wale", "wale 1\n\nmaterial good {\n  physical { force = lateral(grating(x, period: 3 mm), amplitude: 1 N) }\n}\n");
  folder.write("b.wale", "wale 1\n\nmaterial bad {\n  physical { force = }\n}\n");
  const auto surveyed = survey({folder.path().string()}, {}, SurveyDepth::programs);
  ASSERT_TRUE(surveyed);
  ASSERT_EQ(surveyed->entries.size(), 2u);
  EXPECT_NE(surveyed->entries[1].trouble, "");
  const auto pages = sheet_pages(surveyed->entries);
  ASSERT_EQ(pages.size(), 1u);
  const auto common = common_modules();
  const auto page = draw_sheet(pages[0], "all", common->declarations);
  ASSERT_TRUE(page);
  const Drawing drawing = (*page)->pixels();
  // The first cell by name is `bad`: paper inside; the second has a relief, which is darker than paper.
  const auto darkest = [&](int left, int right) {
    int least = 255;
    for (int y = 150; y < 200; ++y)
      for (int x = left; x < right; ++x)
        least = std::min<int>(least, drawing.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(drawing.width) + static_cast<std::size_t>(x))]);
    return least;
  };
  EXPECT_GT(darkest(300, 400), 200) << "beside the words";
  EXPECT_LT(darkest(440, 550), 200);
}

}  // namespace
}  // namespace wale::surveying_test
