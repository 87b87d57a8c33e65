// The tokeniser, against words split by hand.
#include "library/index/words.hpp"

#include <gtest/gtest.h>

namespace wale::words_test {
namespace {

using Words = std::vector<std::string>;

TEST(Words, AreRunsOfLettersAndNumbersInLowerCase) {
  EXPECT_EQ(words_of("Wide-wale corduroy, 2.5 mm"), (Words{"wide", "wale", "corduroy", "2", "5", "mm"}));
  EXPECT_EQ(words_of("deep_wale"), (Words{"deep", "wale"}));
  EXPECT_EQ(words_of(""), Words{});
  EXPECT_EQ(words_of(" \t.,;-_\n"), Words{});
}

TEST(Words, FoldCaseAndMarksOfAllScripts) {
  EXPECT_EQ(words_of("Gr\u00f6ber CR\u00caPE"), (Words{"grober", "crepe"}));
  EXPECT_EQ(words_of("Gro\u0308ber"), Words{"grober"});              // the same in two characters
  EXPECT_EQ(words_of("Stra\u00dfe STRASSE"), (Words{"strasse", "strasse"}));
  EXPECT_EQ(words_of("\u0428\u0401\u041b\u041a"), Words{"\u0448\u0435\u043b\u043a"});  // silk in Russian; its yo loses the dots
  EXPECT_EQ(words_of("\u03a3\u039f\u03a3 \u03c3\u03bf\u03c2"), (Words{"\u03c3\u03bf\u03c3", "\u03c3\u03bf\u03c3"}));  // final sigma
  EXPECT_EQ(words_of("\ufb01ne"), Words{"fine"});          // a ligature
  EXPECT_EQ(words_of("\uff11\uff12"), Words{"12"});        // full-width digits
  EXPECT_EQ(words_of("soft\u00adest"), Words{"softest"});  // a soft hyphen is no character
}

TEST(Words, OfScriptsWithoutBlanksAreTheirCharacters) {
  EXPECT_EQ(words_of("\u7d79\u5e03 2mm"), (Words{"\u7d79", "\u5e03", "2mm"}));
  EXPECT_EQ(words_of("a\u7d79b"), (Words{"a", "\u7d79", "b"}));
}

TEST(Words, EndAtBytesThatAreNoText) {
  EXPECT_EQ(words_of("ri\xffpped"), (Words{"ri", "pped"}));
  EXPECT_EQ(words_of(std::string_view("a\0b", 3)), (Words{"a", "b"}));
  EXPECT_EQ(words_of("\xf0\x9f"), Words{});
}

TEST(Words, CountUpToALength) {
  const std::string longest(32, 'x');
  EXPECT_EQ(words_of(longest + "yyy z"), (Words{longest, "z"}));
  const std::string wide = words_of(std::string(1000, 'q')).front();
  EXPECT_EQ(wide.size(), 32u);
}

Entry cord() {
  Entry entry;
  entry.name = "wide_cord", entry.title = "Cord", entry.kind = "fabric.woven";
  entry.names = {{"en", "ribbed cotton"}, {"de", "Cord"}};
  entry.documentation = "Cord of cotton.";
  return entry;
}

TEST(WordCounts, WeighByPlace) {
  const WordCounts counted = count_words(cord());
  // By hand: cord 8 (name) + 6 (title) + 6 (de) + 1 (documentation); cotton 6 + 1.
  EXPECT_EQ(counted.weights, (std::vector<std::pair<std::string, std::uint32_t>>{{"cord", 21},
                                                                                 {"cotton", 7},
                                                                                 {"fabric", 4},
                                                                                 {"of", 1},
                                                                                 {"ribbed", 6},
                                                                                 {"wide", 8},
                                                                                 {"woven", 4}}));
  EXPECT_EQ(counted.length, 51u);
}

TEST(WhyFound, TellsThePlace) {
  EXPECT_EQ(why_found(cord(), {"ribbed", "cotton"}).text, "ribbed cotton");
  EXPECT_EQ(why_found(cord(), {"ribbed", "cotton"}).place, FoundIn::called);
  EXPECT_EQ(why_found(cord(), {"cord"}).text, "Cord");
  EXPECT_EQ(why_found(cord(), {"fab"}).place, FoundIn::kind);
  EXPECT_EQ(why_found(cord(), {"of"}).place, FoundIn::documentation);
  EXPECT_EQ(why_found(cord(), {"nothing"}).text, "wide_cord");
}

}  // namespace
}  // namespace wale::words_test
