// BM25 against a slow reference that counts in the texts themselves, with the logarithm of the C library.
#include "library/index/search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "compiler/parse/parse.hpp"
#include "library/index/find.hpp"
#include "library/store/seek.hpp"

namespace wale::search_test {
namespace {

TEST(LogInSteps, IsTheBinaryLogarithm) {
  EXPECT_EQ(log2_in_steps(1), 0);
  EXPECT_EQ(log2_in_steps(8), 3);
  for (double x = 1; x < 1e7; x *= 1.37) {
    EXPECT_LE(log2_in_steps(x), std::log2(x) + 1e-9) << x;
    EXPECT_GT(log2_in_steps(x), std::log2(x) - 1.0 / 65536 - 1e-9) << x;
  }
}

// README.md: if no material has these words as they stand, the best for them, quoted or not.
TEST(Words, FindThoseThatHaveMostOfThem) {
  LibraryIndex catalogue;
  SourceSet sources;
  Diagnostics diagnostics;
  const std::string text =
      "wale 1\nmaterial cord { representative { title \"Ribbed cotton\" kind fabric.woven } }\n"
      "material towel { representative { title \"Rough cotton\" kind fabric.pile } }\n"
      "material belt { representative { title \"Trousers belt\" kind leather.strap } }\n";
  catalogue.add("trial", "trial.wale", parse(sources, sources.add("trial.wale", text), diagnostics));
  ASSERT_EQ(catalogue.materials().size(), 3u);
  const auto found = [&](std::vector<std::string> texts) {
    const FoundByWords all = seek_by_words(catalogue, {.texts = std::move(texts), .kind = {}, .near = {}, .levels = {}, .most = {}});
    std::vector<std::string> names;
    for (const FoundMaterial& each : all.as_they_stand) names.push_back(each.material->name);
    for (const FoundEntry& each : all.most_words) names.push_back(each.entry.name);
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(found({"ribbed cotton"}), Names{"cord"});
  EXPECT_EQ(found({"cotton ribbed"}), Names{"cord"});
  EXPECT_EQ(found({"rough ribbed cotton"}).size(), 2u);
  EXPECT_EQ(found({"rough ribbed cotton"}), found({"rough", "ribbed", "cotton"}));
  EXPECT_EQ(found({"rough", "cotton", "trousers"}), Names{"towel"}) << "two of three words before one of them";
  EXPECT_EQ(found({"velvet", "trousers", "blue", "wide"}), Names{"belt"}) << "none has half of them: the most";
  EXPECT_EQ(found({"velvet"}), Names{});
  EXPECT_EQ(found({"velvet", "silk"}), Names{});
}

/// Materials of a few words each, which often occur in several.
std::vector<Entry> some_entries(std::size_t count) {
  const std::vector<std::string> words{"rib", "ribbed", "ribs", "cotton", "cord", "corduroy", "silk", "wool", "fine", "wide"};
  std::mt19937 random(1995);
  const auto any = [&] { return words[random() % words.size()]; };
  std::vector<Entry> entries(count);
  for (std::size_t i = 0; i < count; ++i) {
    entries[i].name = any() + "_" + std::to_string(random() % 50);
    entries[i].module = "m" + std::to_string(i);
    entries[i].kind = i % 3 == 0 ? "fabric.woven" : "wood";
    entries[i].title = any() + " " + any();
    for (std::size_t n = random() % 30; n > 0; --n) entries[i].documentation += any() + " ";
  }
  return entries;
}

/// By the formula of the docstring, from scratch for each pair of material and word.
double reference_score(const std::vector<Entry>& entries, std::size_t which, const std::vector<std::string>& sought) {
  const auto weight_in = [&](const Entry& entry, const std::string& word) {
    double sum = 0;
    const auto in = [&](const std::string& text, double weight) {
      for (const std::string& each : words_of(text))
        if (each.compare(0, word.size(), word) == 0) sum += each == word ? 2 * weight : weight;
    };
    in(entry.name, 8), in(entry.title, 6), in(entry.kind, 4), in(entry.documentation, 1);
    return sum;
  };
  const auto length_of = [&](const Entry& entry) {
    return 8.0 * words_of(entry.name).size() + 6.0 * words_of(entry.title).size() + 4.0 * words_of(entry.kind).size() +
           words_of(entry.documentation).size();
  };
  double total = 0, score = 0;
  for (const Entry& entry : entries) total += length_of(entry);
  const double count = static_cast<double>(entries.size());
  for (const std::string& word : sought) {
    double having = 0;
    for (const Entry& entry : entries) having += weight_in(entry, word) > 0;
    const double w = weight_in(entries[which], word);
    if (w == 0) continue;
    const double norm = 1 - 0.75 + 0.75 * length_of(entries[which]) / (total / count);
    score += std::log2(1 + (count - having + 0.5) / (having + 0.5)) * w * (1.2 + 1) / (w + 1.2 * norm);
  }
  return score;
}

TEST(Search, ScoresAsTheReference) {
  const std::vector<Entry> entries = some_entries(300);
  const auto index = index_of(entries, "sandpaper");
  for (const std::vector<std::string>& sought : std::vector<std::vector<std::string>>{
           {"rib"}, {"cotton"}, {"cord", "wide"}, {"ribbed", "silk", "fine"}, {"fabric"}}) {
    const auto found = search(index->words(), sought);
    ASSERT_TRUE(found);
    ASSERT_FALSE(found->empty());
    for (const ScoredMaterial& each : *found) {
      // The idf is rounded down to 2^-16 for each word.
      EXPECT_NEAR(each.score, reference_score(entries, each.material, sought), 3e-5 * 2.2 * sought.size());
    }
  }
}

TEST(Search, FindsThoseWithAllWordsOrElseThoseWithSome) {
  std::vector<Entry> entries(3);
  entries[0].name = "ribbed_cotton", entries[1].name = "ribbed_silk", entries[2].name = "smooth_wool";
  const auto index = index_of(entries, "sandpaper");
  const auto found = [&](const std::vector<std::string>& words) {
    std::set<std::uint32_t> all;
    const auto scored = search(index->words(), words);
    for (const ScoredMaterial& each : *scored) all.insert(each.material);
    return all;
  };
  EXPECT_EQ(found({"ribbed"}), (std::set<std::uint32_t>{0, 1}));
  EXPECT_EQ(found({"ribbed", "cotton"}), (std::set<std::uint32_t>{0}));
  EXPECT_EQ(found({"rib", "silk", "rib"}), (std::set<std::uint32_t>{1}));
  EXPECT_EQ(found({"silk", "wool"}), (std::set<std::uint32_t>{1, 2}));
  EXPECT_EQ(found({"ibbed"}), std::set<std::uint32_t>{});
  EXPECT_EQ(found({}), std::set<std::uint32_t>{});
  EXPECT_TRUE(search(index_of({}, "sandpaper")->words(), {"rib"})->empty());
}

TEST(FindEntries, AreInTheOrderOfScoresAndNames) {
  const std::vector<Entry> entries = some_entries(200);
  const auto index = index_of(entries, "sandpaper");
  const auto found = find_entries(*index, {.texts = {"rib cord"}, .most = 1000});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->all, found->entries.size());
  for (std::size_t i = 1; i < found->entries.size(); ++i) {
    const FoundEntry &a = found->entries[i - 1], &b = found->entries[i];
    EXPECT_TRUE(a.score > b.score || (a.score == b.score && std::tie(a.entry.name, a.entry.module) <
                                                                std::tie(b.entry.name, b.entry.module)));
  }
  const auto few = find_entries(*index, {.texts = {"rib cord"}, .most = 3});
  ASSERT_EQ(few->entries.size(), 3u);
  EXPECT_EQ(few->all, found->all);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(few->entries[i].entry.module, found->entries[i].entry.module);
}

TEST(FindEntries, KeepAKindAndEachOfSeveralTexts) {
  const std::vector<Entry> entries = some_entries(200);
  const auto index = index_of(entries, "sandpaper");
  const auto found = find_entries(*index, {.texts = {"wool", "silk"}, .kind = "fabric", .most = 1000});
  ASSERT_TRUE(found);
  std::size_t expected = 0;
  const auto has = [](const Entry& entry, const std::string& word) {
    return (entry.name + " " + entry.title + " " + entry.documentation).find(word) != std::string::npos;
  };
  for (const Entry& entry : entries) expected += entry.kind == "fabric.woven" && has(entry, "wool") && has(entry, "silk");
  EXPECT_GT(expected, 0u);
  EXPECT_EQ(found->entries.size(), expected);
  EXPECT_EQ(find_entries(*index, {.kind = "fab"})->all, 0u);
  EXPECT_EQ(find_entries(*index, {.most = 7})->all, 200u);
  EXPECT_EQ(find_entries(*index, {.most = 7})->entries.size(), 7u);
}

TEST(MeantEntry, IsByNameThenByWhatItReplacesThenByOtherNames) {
  std::vector<Entry> entries(3);
  entries[0].name = "cord", entries[0].module = "fabric.cord", entries[0].replaces = {"old_cord"};
  entries[1].name = "silk", entries[1].module = "fabric.silk", entries[1].names = {{"fr", "Cr\u00eape de Chine"}};
  entries[2].name = "velvet", entries[2].module = "fabric.silk", entries[2].names = {{"de", "cord"}};
  const auto index = index_of(entries, "sandpaper");
  const auto meant = [&](std::string_view text) { return entries[*meant_entry(*index, text)].name; };
  EXPECT_EQ(meant("cord"), "cord");
  EXPECT_EQ(meant("old_cord"), "cord");
  EXPECT_EQ(meant("crepe de chine"), "silk");
  EXPECT_EQ(meant("Cord"), "velvet");  // as `meant_by` of the library: a name is as written
  EXPECT_EQ(meant("fabric.silk.velvet"), "velvet");
  EXPECT_EQ(meant_entry(*index, "fabric.silk").error().code, Code::ambiguous_material);
  EXPECT_EQ(meant_entry(*index, "velvat").error().code, Code::unknown_name);
  EXPECT_EQ(meant_entry(*index, "").error().code, Code::unknown_name);
  EXPECT_NE(meant_entry(*index, "velvat").error().mend.find("velvet"), std::string::npos);
}

}  // namespace
}  // namespace wale::search_test
