#include <gtest/gtest.h>

#include "compiler/parse/lex.hpp"

namespace wale::lexing_test {
namespace {

struct Cut {
  Tokens tokens;
  Diagnostics diagnostics;

  explicit Cut(std::string text) {
    SourceSet sources;
    tokens = lex(sources, sources.add("test.wale", std::move(text)), diagnostics);
  }
  std::vector<TokenKind> kinds() const {
    std::vector<TokenKind> result;
    for (const Token& each : tokens.tokens) result.push_back(each.kind);
    return result;
  }
};

using enum TokenKind;
using Kinds = std::vector<TokenKind>;

TEST(Lexing, EveryTokenOfTheTable) {
  EXPECT_EQ(Cut("( ) [ ] { } , ; : = .. + - * / ^ < <= > >= ± +- ' %").kinds(), (Kinds{left_parenthesis,
                                                                                       right_parenthesis,
                                                                                       left_bracket,
                                                                                       right_bracket,
                                                                                       left_brace,
                                                                                       right_brace,
                                                                                       comma,
                                                                                       semicolon,
                                                                                       colon,
                                                                                       equals,
                                                                                       range,
                                                                                       plus,
                                                                                       minus,
                                                                                       star,
                                                                                       slash,
                                                                                       caret,
                                                                                       less,
                                                                                       less_equal,
                                                                                       greater,
                                                                                       greater_equal,
                                                                                       plus_minus,
                                                                                       plus_minus,
                                                                                       prime,
                                                                                       percent,
                                                                                       end}));
  EXPECT_EQ(Cut("if then else in on from and or not").kinds(),
            (Kinds{word_if, word_then, word_else, word_in, word_on, word_from, word_and, word_or, word_not, end}));
}

TEST(Lexing, NumbersAndNamesNeedNoSpaceBetween) {
  const Cut cut("5mm 1mm..5mm 2e3 2e 1..5 1e-3");
  EXPECT_EQ(cut.kinds(), (Kinds{number, name, number, name, range, number, name, number, number, name, number, range,
                                number, number, end}));
  EXPECT_EQ(cut.tokens.numbers, (std::vector<double>{5, 1, 5, 2000, 2, 1, 5, 0.001}));
}

TEST(Lexing, DottedNamesAreOneToken) {
  EXPECT_EQ(Cut("fabric.denim").kinds(), (Kinds{name, end}));
  EXPECT_EQ(Cut("low..high").kinds(), (Kinds{name, range, name, end}));
}

TEST(Lexing, TextsAreUnescaped) {
  const Cut cut(R"("a \"b\" \\ c\nd" "µm")");
  ASSERT_EQ(cut.kinds(), (Kinds{text, text, end}));
  EXPECT_EQ(cut.tokens.texts, (std::vector<std::string_view>{"a \"b\" \\ c\nd", "µm"}));
  EXPECT_FALSE(cut.diagnostics.has_errors());
}

TEST(Lexing, DocumentationKeepsItsLastLetter) {
  EXPECT_EQ(Cut("/// voil\u00e0  \t\r\nx").tokens.documentation.at(0), "voil\u00e0");  // whose last byte is 0xA0
}

TEST(Lexing, CommentsAreWhiteSpaceAndDocumentationIsKept) {
  const Cut cut("a // b\n/* c\n d */ e\n/// one\n/// two\nf //// no\ng");
  EXPECT_EQ(cut.kinds(), (Kinds{name, name, name, name, end}));
  ASSERT_EQ(cut.tokens.documentation.size(), 1u);
  EXPECT_EQ(cut.tokens.documentation.at(2), "one\ntwo");
  EXPECT_TRUE(cut.tokens.tokens[1].starts_line);
}

TEST(Lexing, AMarkAtTheHeadAndUnicodeSpacesAreWhiteSpace) {
  EXPECT_EQ(Cut("\xEF\xBB\xBFwale\u00A01\u2009mm\r\n").kinds(), (Kinds{name, number, name, end}));
}

TEST(Lexing, BracketsKnowTheirPartners) {
  const Cut cut("{ ( a } ( )");  // the first parenthesis is closed by nothing: the brace ends it
  EXPECT_EQ(cut.tokens.tokens[0].value, 3u);
  EXPECT_EQ(cut.tokens.tokens[1].value, 0u);
  EXPECT_EQ(cut.tokens.tokens[4].value, 5u);
}

TEST(Lexing, LookalikesAreReadAsTheCharacterThatIsMeant) {
  const struct {
    const char *text, *mend;
    Kinds kinds;
  } cases[] = {
      {"a × b", "write `*`", {name, star, name, end}},
      {"a − b", "write `-`", {name, minus, name, end}},
      {"a – b", "write `-`", {name, minus, name, end}},
      {"a ÷ b", "write `/`", {name, slash, name, end}},
      {"a ≤ b", "write `<=`", {name, less_equal, name, end}},
      {"a ** b", "write `^` for a power", {name, caret, name, end}},
      {"1 … 2", "write `..`", {number, range, number, end}},
      {"1 .... 2", "write `..`", {number, range, number, end}},
      {"v’ = 1", "write `'`", {name, prime, equals, number, end}},
      {"“a”", "write texts in straight quotes: `\"`", {text, end}},
      {"„a“", "write texts in straight quotes: `\"`", {text, end}},
      {"5 µm", "write `um`", {number, name, end}},  // U+00B5, the micro sign
      {"5 μm", "write `um`", {number, name, end}},  // U+03BC, the Greek letter
      {"90°", "write `deg`", {number, name, end}},
      {"m²", "write `^2`", {name, caret, number, end}},
      {".5", "write `0.5`", {number, end}},
      {"5. ", "write `5` or `5.0`", {number, end}},
      {"0x1F", "write `31`", {number, end}},
  };
  for (const auto& each : cases) {
    const Cut cut(each.text);
    EXPECT_EQ(cut.kinds(), each.kinds) << each.text;
    ASSERT_EQ(cut.diagnostics.all().size(), 1u) << each.text;
    EXPECT_EQ(cut.diagnostics.all()[0].code, Code::unexpected_character) << each.text;
    EXPECT_EQ(cut.diagnostics.all()[0].help, each.mend) << each.text;
  }
}

TEST(Lexing, AForeignNameIsReportedOnceHoweverOftenItIsUsed) {
  const Cut cut("größe größe größe");
  EXPECT_EQ(cut.kinds(), (Kinds{name, name, name, end}));
  EXPECT_EQ(cut.diagnostics.all().size(), 1u);
}

TEST(Lexing, ARunOfOneUnknownCharacterIsOneError) {
  const Cut cut("@@@@ #");
  EXPECT_EQ(cut.kinds(), (Kinds{unreadable, unreadable, end}));
  EXPECT_EQ(cut.diagnostics.all().size(), 2u);
}

TEST(Lexing, NumbersBeyondTheMachineAreRefused) {
  for (const char* text : {"1e999", "1e-999"}) {
    const Cut cut(text);
    ASSERT_EQ(cut.diagnostics.all().size(), 1u);
    EXPECT_EQ(cut.diagnostics.all()[0].code, Code::number_out_of_range);
  }
  EXPECT_FALSE(Cut("0 0.0 0e5 1e308 1e-300").diagnostics.has_errors());
}

TEST(Lexing, InvalidTextGivesOneError) {
  const struct {
    std::string text;
    std::uint32_t at;
    Code code;
  } cases[] = {
      {std::string("wale 1\n\0", 8), 7, Code::invalid_encoding},
      {"wale 1 \xB5m \xB5m", 7, Code::invalid_encoding},
      {"\xC0\x80", 0, Code::invalid_encoding},        // overlong
      {"a \xED\xA0\x80", 2, Code::invalid_encoding},  // a surrogate
      {"a \xE2\x82", 2, Code::invalid_encoding},      // cut off
      {std::string(largest_source + 1, '\xFF'), 0, Code::too_long},
  };
  for (const auto& each : cases) {
    const Cut cut(each.text);
    EXPECT_EQ(cut.kinds(), (Kinds{end}));
    ASSERT_EQ(cut.diagnostics.all().size(), 1u);
    EXPECT_EQ(cut.diagnostics.all()[0].code, each.code);
    EXPECT_EQ(cut.diagnostics.all()[0].span.begin, each.at);
  }
}

}  // namespace
}  // namespace wale::lexing_test
