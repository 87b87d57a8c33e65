// `wale find`: materials of libraries by words.
#include <gtest/gtest.h>

#include <array>

#include "tests/command_line/running.hpp"

namespace wale::command_line::finding_test {
namespace {

/// A library in a temporary folder.
struct Shelf {
  Shelf() {
    folder.write("glass/marbles.wale",
                 "wale 1\n/// In a tray.\nmaterial marbles {\n  representative {\n    title \"Glass marbles\"\n"
                 "    kind glass.loose\n    feels \"like ball bearings\", \"pleasant\"\n  }\n"
                 "  perceptual { roughness 0.4 }\n}\n");
  }
  Outcome find(std::vector<std::string> words) const {
    words.insert(words.begin(), {"find", "--library", folder / "."});
    return wale(words);
  }
  TemporaryFolder folder;
};

TEST(Find, ShowsTheFileAndTheMatchingText) {
  const Outcome outcome = Shelf().find({"--kind", "glass", "ball bearings"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::ranges::count(outcome.out, '\n'), 1);
  for (const char* part :
       {"marbles ", "Glass marbles", "glass.loose", "glass/marbles.wale", "feels \"like ball bearings\""})
    EXPECT_TRUE(contains(outcome.out, part)) << part << outcome.out;
}

TEST(Find, KnowsOtherLanguagesAndWhatAMaterialReplaces) {
  const TemporaryFolder folder;
  folder.write("cord.wale",
               "wale 1\nmaterial cord {\n  representative { called de \"Manchester\"; called fr \"velours de mine\"\n"
               "    replaces old_cord }\n  perceptual { roughness 0.4 }\n}\n");
  for (const auto& [sought, by, text] :
       {std::array{"manchester", "called", "Manchester"}, {"velours de mine", "called", "velours de mine"},
        {"old_cord", "replaces", "old_cord"}}) {
    const auto found = wale({"find", "--library", folder / ".", sought, "--json"}).json();
    ASSERT_EQ(found.size(), 1u) << sought;
    EXPECT_EQ(found[0].at("name"), "cord");
    EXPECT_EQ(found[0].at("found_by"), by);
    EXPECT_EQ(found[0].at("found_in"), text);
    EXPECT_EQ(wale({"describe", "--library", folder / ".", sought, "--json"}).json().at("material"), "cord") << sought;
  }
}

TEST(Find, SearchesTheShippedLibraryToo) {
  const Outcome outcome = Shelf().find({"--kind", "fabric", "corduroy", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  bool has_corduroy = false;
  for (const auto& each : outcome.json()) {
    EXPECT_TRUE(each["kind"].get<std::string>().starts_with("fabric"));
    has_corduroy = has_corduroy || (each["name"] == "corduroy" && each["module"] == "fabric.corduroy" &&
                                    each["file"] == "library/fabric/corduroy.wale" && each["found_by"] == "name");
  }
  EXPECT_TRUE(has_corduroy);
}

TEST(Find, FailsWithoutAMatchAndProposesWords) {
  const Shelf shelf;
  const Outcome misspelt = shelf.find({"marbels"});
  EXPECT_EQ(misspelt.status, 1);
  EXPECT_EQ(misspelt.out, "");
  EXPECT_TRUE(contains(misspelt.err, "did you mean \"marbles\"?")) << misspelt.err;
  EXPECT_TRUE(contains(shelf.find({"--kind", "glas"}).err, "did you mean `glass`?"));
  const Outcome either = shelf.find({"marbles", "corduroy"});
  EXPECT_EQ(either.status, 0);
  EXPECT_TRUE(contains(either.out, "corduroy"));
  EXPECT_TRUE(contains(either.out, "none has all of these words")) << either.out;
  const Outcome json = shelf.find({"marbels", "--json"});
  EXPECT_EQ(json.status, 1);
  EXPECT_EQ(json.out, "[]\n");
}

TEST(Find, TellsOfAWordOfAPercept) {
  const Shelf shelf;
  const Outcome weighty = shelf.find({"weighty"});
  EXPECT_EQ(weighty.status, 1);
  EXPECT_TRUE(contains(weighty.err, "`weighty` is a word of the percept `heaviness`")) << weighty.err;
  const Outcome bumpy = shelf.find({"bumpy"});
  EXPECT_TRUE(contains(bumpy.err, "`bumpy` is a word of the percept `bumpiness`")) << bumpy.err;
  EXPECT_TRUE(contains(bumpy.err, " ask for")) << bumpy.err;
}

}  // namespace
}  // namespace wale::command_line::finding_test
