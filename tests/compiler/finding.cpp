// Finding materials of a library by their names, titles, words, kinds and documentation.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compiler/modules/find_materials.hpp"
#include "compiler/parse/parse.hpp"

namespace wale::finding_test {
namespace {

LibraryIndex library() {
  LibraryIndex index;
  SourceSet sources;
  Diagnostics diagnostics;  // warnings about missing percepts do not matter here
  const auto add = [&](const std::string& module, const std::string& text) {
    index.add(module, module + ".wale", parse(sources, sources.add(module + ".wale", "wale 1\n" + text), diagnostics));
  };
  add("cloth.thick", R"(
/// What sofas are covered with.
material old_cord {
  representative {
    title "Corduroy, worn"
    kind fabric.woven
    called "cord", "Ribbed Cotton"
    feels "pleasant", "like ball-bearings"
  }
}
material accord { representative { title "Accord"; kind fabrication } }
)");
  add("cloth.fine", R"(
material cord { representative { title "Fine cord"; kind fabric.woven.fine; feels "pleasant" } }
material plain { }
)");
  return index;
}

/// The names of the materials found and the text that matched, in their order.
std::vector<std::string> found(const std::vector<std::string>& texts, const std::string& kind = "") {
  const LibraryIndex index = library();
  std::vector<std::string> names;
  for (const FoundMaterial& each : find_materials(index, texts, kind))
    names.push_back(each.material->name + " by " + std::string(in_words(each.by)) + " " + each.text);
  return names;
}

using Names = std::vector<std::string>;

TEST(Finding, IsByTheBeginningsOfWords) {
  EXPECT_EQ(found({"cord"}), (Names{"cord by name cord", "old_cord by called cord"}));
  EXPECT_EQ(found({"cordu"}), (Names{"old_cord by title Corduroy, worn"}));
  EXPECT_EQ(found({"bear"}), (Names{"old_cord by feels like ball-bearings"}));
  EXPECT_EQ(found({"ord"}), Names{});
}

TEST(Finding, IgnoresCapitalsAndSeparators) {
  for (const char* text : {"ribbed cotton", "RIBBED COTTON", "ribbed-cotton", " ribbed  cotton "})
    EXPECT_EQ(found({text}), (Names{"old_cord by called Ribbed Cotton"})) << text;
  EXPECT_EQ(found({"old cord"}), (Names{"old_cord by name old_cord"}));
  EXPECT_EQ(found({"fabric woven fine"}), (Names{"cord by kind fabric.woven.fine"}));
}

TEST(Finding, NeedsAllOfSeveralTextsAndNamesTheWeakestMatch) {
  EXPECT_EQ(found({"cord", "pleasant"}), (Names{"cord by feels pleasant", "old_cord by feels pleasant"}));
  EXPECT_EQ(found({"pleasant", "sofas"}), (Names{"old_cord by documentation What sofas are covered with."}));
  EXPECT_EQ(found({"fine", "sofas"}), Names{});
}

TEST(Finding, OfAKindIncludesItsSubkinds) {
  EXPECT_EQ(found({}, "fabric"), (Names{"cord by name cord", "old_cord by name old_cord"}));
  EXPECT_EQ(found({}, "fabric.woven.fine"), (Names{"cord by name cord"}));
  EXPECT_EQ(found({}, "fab"), Names{});
  EXPECT_EQ(found({}),
            (Names{"cord by name cord", "plain by name plain", "accord by name accord", "old_cord by name old_cord"}))
      << "by module, then by name";
}

TEST(Finding, ListsKindsAndWordsThatCanBeFound) {
  EXPECT_EQ(kinds_in(library()), (Names{"fabric", "fabric.woven", "fabric.woven.fine", "fabrication"}));
  const Names words = findable_words(library());
  for (const char* word : {"pleasant", "ribbed", "bearings", "cord", "fabric"})
    EXPECT_TRUE(std::ranges::binary_search(words, word)) << word;
}

TEST(Finding, OfSeparatorsAloneFindsNothing) {
  for (const char* text : {"", " ", "_", "."}) EXPECT_EQ(found({text}), Names{}) << '"' << text << '"';
}

}  // namespace
}  // namespace wale::finding_test
