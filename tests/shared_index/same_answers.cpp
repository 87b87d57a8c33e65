// A shared index answers as one in a file does, question by question, to the last bit of a score and a distance.
#include <cmath>
#include <random>

#include "compiler/modules/load_modules.hpp"
#include "library/index/find.hpp"
#include "library/index/nearest.hpp"
#include "tests/shared_index/server.hpp"

namespace wale::shared_index::same_answers_test {
namespace {

/// Materials of several structures with words in several languages, some of which share words, titles and kinds.
std::string generated(int i, std::mt19937& random) {
  const auto number = [&](double low, double high) {
    return std::to_string(low + (high - low) * static_cast<double>(random() % 1000) / 999);
  };
  const std::vector<std::string> kinds = {"trial.woven", "trial.knit", "trial", "stone.riven", "fluid"};
  const std::vector<std::string> words = {"ribbed", "soft", "rough", "fine", "cold", "null", "rib", "wide", "grob", "samt"};
  const std::vector<std::string> forces = {
      "lateral(cos(2 pi * x / " + number(1.5, 6) + " mm))",
      "lateral(cos(2 pi * x / " + number(2, 5) + " mm) * cos(2 pi * y / " + number(2, 5) + " mm))",
      "-" + number(0.5, 6) + " N s/m * velocity",
      "vector(-" + number(20, 90) + " N/m * hand.x, 0 N)",
      "lateral(cos(2 pi * x / 3 mm) * grating(y, period: " + number(2, 6) + " mm)) - " + number(0.2, 2) + " N s/m * velocity"};
  const std::size_t which = random() % forces.size();
  const bool asks = which < 2 || which == 4;  // a texture
  const std::string name = "m" + std::to_string(i);
  const auto word = [&] { return words[random() % words.size()]; };
  return "wale 1\n/// A " + word() + " " + word() + " thing, number " + std::to_string(i) + ".\nmaterial " + name +
         " {\n  representative {\n    title \"" + word() + " " + word() + "\"\n    called \"" + word() + " " + name +
         "\"\n    called de \"Größe " + word() + "\"\n    called ja \"布地\"\n    kind " + kinds[random() % kinds.size()] +
         "\n  }\n" + (asks ? "  perceptual { roughness " + number(0.1, 0.95) + " estimated }\n" : "") + "  physical { force = " +
         (forces[which]) + " }\n}\n";
}

/// What was found, with all that orders it.
std::string told(const Result<FoundEntries>& found) {
  if (!found) return "error " + in_words(found.error());
  std::string text = std::to_string(found->all) + ":";
  for (const FoundEntry& each : found->entries) {
    char numbers[160];
    std::snprintf(numbers, sizeof(numbers), " %a", each.score);
    text += "\n" + each.entry.module + "." + each.entry.name + " " + each.entry.content + numbers + " " + each.why.text;
    if (!each.apart) continue;
    std::snprintf(numbers, sizeof(numbers), " %a %a ", each.apart->low, each.apart->high);
    text += numbers + each.apart->plainest;
    for (const std::string& cue : each.apart->unknown) text += " " + cue;
  }
  return text;
}

using SameAnswers = Server;

TEST_F(SameAnswers, ToTwoHundredQuestions) {
  std::mt19937 random(1995);
  write_library("shelf");
  constexpr int count = 48;
  for (int i = 0; i < count; ++i) write("shelf/part" + std::to_string(i % 5) + "/m" + std::to_string(i) + ".wale", generated(i, random));
  const auto in_file = opened(folder_ / "an.index", true), shared = opened(address(), true);
  const StoreReport one = updated(*in_file, files_of("shelf")), other = updated(*shared, files_of("shelf"));
  ASSERT_EQ(one.materials, static_cast<std::size_t>(count));
  ASSERT_EQ(other.materials, static_cast<std::size_t>(count));
  ASSERT_TRUE(one.troubled.empty()) << one.troubled.front().why;
  const MaterialIndex& a = in_file->index();
  const MaterialIndex& b = shared->index();
  EXPECT_EQ(a.device(), b.device());
  EXPECT_EQ(a.words().size().length, b.words().size().length);

  const Declarations& declarations = common_modules()->declarations;
  const Comparer comparer(declarations, default_device);
  int questions = 0, answered = 0;
  const auto same = [&](const std::string& question, const std::string& first, const std::string& second) {
    EXPECT_EQ(first, second) << question;
    ++questions, answered += first.find('\n') != std::string::npos;
  };
  const auto any = [&] { return "m" + std::to_string(random() % count); };
  const auto cues_of_any = [&](const MaterialIndex& index, const std::string& name) {
    const auto meant = meant_entry(index, name);
    EXPECT_TRUE(meant) << in_words(meant.error());
    const auto entry = index.entry(*meant);
    return entry && entry->felt.cues ? entry->felt.cues : std::nullopt;
  };
  const auto both = [&](const std::string& question, const MaterialQuery& sought) {
    same(question, told(find_entries(a, sought)), told(find_entries(b, sought)));
  };
  const std::vector<std::string> texts = {"ribbed", "rib",       "soft rough", "größe",    "GROSSE samt", "布",    "null",  "m1",
                                          "thing",  "number 12", "r",          "nothing here", "fine cold wide", "m_", "%",  "'; DROP TABLE words",
                                          "\xff",   "woven",     "trial",      "\\",       "\"rib\"",     "",     "the a", "wide wide wide"};
  for (int i = 0; i < 72; ++i) {
    MaterialQuery sought{.texts = {texts[static_cast<std::size_t>(i) % texts.size()]}, .kind = i % 3 == 2 ? "trial" : "", .without = {}, .most = 20};
    if (i >= 48) sought.texts.push_back(texts[random() % texts.size()]);
    both("words " + sought.texts.front(), sought);
  }
  for (int i = 0; i < 48; ++i) {
    const std::string name = any();
    const auto cues = cues_of_any(a, name), cues_there = cues_of_any(b, name);
    ASSERT_EQ(cues.has_value(), cues_there.has_value());
    if (!cues) continue;
    EXPECT_EQ(cues->values, cues_there->values);
    const NearProbe probe(comparer, *cues);
    both("near " + name, {.texts = i % 4 == 0 ? std::vector<std::string>{"soft"} : std::vector<std::string>{},
                          .kind = i % 5 == 0 ? "trial" : "", .feel = &probe, .without = {}, .most = 1 + random() % 20});
  }
  for (int i = 0; i < 40; ++i) {
    const double low = static_cast<double>(random() % 100) / 100, wide = i % 2 == 0 ? 0 : 0.3;
    const auto probe = LevelProbe::make({{i % 3 == 0 ? "viscosity" : "roughness", low, std::min(low + wide, 1.0)}}, declarations, default_device);
    ASSERT_TRUE(probe) << in_words(probe.error());
    both("level " + std::to_string(low), {.texts = {}, .kind = {}, .feel = probe->get(), .without = {}, .most = 1 + random() % 30});
  }
  for (int i = 0; i < 40; ++i) {
    const auto first = cues_of_any(a, any()), second = cues_of_any(a, any());
    if (!first || !second) continue;
    const BetweenProbe probe(comparer, *first, *second);
    both("between", {.texts = {}, .kind = {}, .feel = &probe, .without = {}, .most = 10});
  }
  const auto meaning = [](const MaterialIndex& index, const std::string& text) {
    const auto meant = meant_entry(index, text);
    if (!meant) return in_words(meant.error());
    const auto entry = index.entry(*meant);
    return "\n" + (entry ? entry->module + "." + entry->name : in_words(entry.error()));
  };
  for (const std::string& text : {std::string("m7"), std::string("part1.m1"), std::string("ribbed m3"), std::string("Größe samt"),
                                  std::string("m99"), std::string("trial.knit"), std::string("fluid"), std::string("part1.m1.m1"),
                                  std::string("soft M4"), std::string("'")})
    same("meant " + text, meaning(a, text), meaning(b, text));
  EXPECT_GE(questions, 200);
  EXPECT_GE(answered, 130) << "most questions find something";
}

/// A reader keeps the columns, and fetches only what has changed. Whatever it has kept, it answers as one that has nothing.
TEST_F(SameAnswers, WithoutWhatDoesNotCompile) {
  std::mt19937 random(7);
  write_library("shelf");
  for (int i = 0; i < 3; ++i) write("shelf/m" + std::to_string(i) + ".wale", generated(i, random));
  write("shelf/broken.wale", "wale 1\nmaterial broken { physical { force = nothing_such(x) } }\n");
  const auto shared = opened(address(), true);
  ASSERT_EQ(updated(*shared, files_of("shelf")).materials, 4u);
  // As an earlier build of Wale has left it.
  ASSERT_TRUE(open(database_)->run("UPDATE wale.materials SET felt = '' WHERE name = 'broken'"));
  const auto anew = opened(address(), true);
  for (const LibraryStore* each : {shared.get(), anew.get()}) {
    const auto probe = LevelProbe::make({{"roughness", 0, 0}}, common_modules()->declarations, default_device);
    ASSERT_TRUE(probe) << in_words(probe.error());
    const auto found = find_entries(each->index(), {.texts = {}, .kind = {}, .feel = probe->get(), .most = 20});
    ASSERT_TRUE(found) << in_words(found.error());
    EXPECT_EQ(found->entries.size(), 3u);
    for (const FoundEntry& entry : found->entries) EXPECT_NE(entry.entry.name, "broken");
  }
}

TEST_F(SameAnswers, FromKeptColumnsOfAnyState) {
  write_library("shelf");
  for (int i = 0; i < 6; ++i)
    write("shelf/m" + std::to_string(i) + ".wale", "wale 1\n" + ribs("m" + std::to_string(i), 0.3 + 0.1 * i, 2 + 0.2 * i, "Ribs."));
  const auto names = [&](LibraryStore& store) {
    std::string all;
    const FeltColumns& columns = store.index().columns();
    for (std::size_t row = 0; row < columns.size(); ++row) {
      all += std::to_string(columns.material(row)) + " " + std::string(columns.name(row)) + ":";
      for (const auto& [quantity, value] : columns.row(row).felt) all += " " + quantity + "=" + std::to_string(value);
      all += "\n";
    }
    return all;
  };
  const auto expect_same = [&](const std::string& when) {
    EXPECT_EQ(names(*opened(address(), false, folder_.path().string())), names(*opened(address(), false))) << when;
  };
  const auto curator = opened(address(), true);
  expect_same("empty");
  updated(*curator, files_of("shelf"));
  expect_same("six");
  expect_same("six, kept");
  write("shelf/m2.wale", "wale 1\n" + ribs("m2", 0.9, 4, "Other ribs.") + ribs("m2b", 0.8, 4, "More ribs."));
  std::filesystem::remove(folder_ / "shelf/m3.wale");
  EXPECT_EQ(updated(*curator, files_of("shelf"), {.name = {}, .is_whole = true, .forgets = true}).gone, 1u);
  expect_same("one changed, one new, one gone");
  std::filesystem::remove(folder_ / "shelf/m5.wale");
  EXPECT_EQ(updated(*curator, files_of("shelf"), {.name = {}, .is_whole = true, .forgets = true}).gone, 1u);
  expect_same("another gone");
  EXPECT_EQ(opened(address(), false)->index().columns().size(), 5u);
  // The database was brought back from an old copy, and others have written since: the kept state is none of it.
  ASSERT_TRUE(open(database_)->run_all("DELETE FROM wale.states; UPDATE wale.materials SET name = 'other' WHERE name = 'm0'"));
  ASSERT_TRUE(open(database_)->run_all("UPDATE wale.present SET stamp = 5"));
  expect_same("restored");
}

}  // namespace
}  // namespace wale::shared_index::same_answers_test
