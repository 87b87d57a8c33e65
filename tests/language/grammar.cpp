// The parser accepts exactly the texts that schema/wale.grammar derives.

#include "tests/language/grammar.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/diagnostics/render.hpp"
#include "compiler/parse/lex.hpp"
#include "tests/language/reading.hpp"
#include "tests/language/shipped.hpp"

namespace {

using wale::shipped_file;
using wale::shipped_files;

const Grammar& grammar() {
  static const Grammar result(shipped_file("schema/wale.grammar"));
  return result;
}

/// The parser's first diagnostic; empty when there is none.
std::string complaint(const std::string& text) {
  const Reading reading(text);
  return reading.diagnostics.all().empty() ? ""
                                           : render_text(reading.diagnostics.all().front(), reading.sources, false);
}

/// Whether a block stands twice. The parser reports it, though it is no error of syntax.
bool has_block_twice(const std::string& text) {
  const Reading reading(text);
  return std::any_of(reading.diagnostics.all().begin(), reading.diagnostics.all().end(),
                     [](const auto& each) { return each.code == wale::Code::declared_twice; });
}

TEST(TheGrammar, DerivesAllShippedFiles) {
  const auto files = shipped_files();
  ASSERT_GE(files.size(), 10u);
  for (const auto& [name, text] : files) EXPECT_TRUE(grammar().recognises(text)) << name;
}

TEST(TheGrammar, DerivesTheExamplesOfTheReference) {
  const std::string page = shipped_file("schema/LANGUAGE.md");
  int blocks = 0;
  for (std::size_t at = 0; (at = page.find("```wale\n", at)) != std::string::npos; ++blocks) {
    const std::size_t begin = at + 8, end = page.find("```", begin);
    EXPECT_TRUE(grammar().recognises(page.substr(begin, end - begin))) << page.substr(begin, end - begin);
    at = end;
  }
  EXPECT_GE(blocks, 4);
}

TEST(TheGrammar, DerivesNoneOfTheseMistakes) {
  for (const char* wrong :
       {"", "let a = 1", "wale 2", "wale\n1", "wale 1\nlet a =", "wale 1\nlet a.b = 1", "wale 1\nlet a = b < c < d",
        "wale 1\nlet a = 2 sin(x)", "wale 1\nlet a = 2 x^2.5", "wale 1\nlet a = f(b: 1, 2)", "wale 1\nlet if = 1",
        "wale 1\nlevels a { b < 3 }", "wale 1\nlet a = 1 let b = 2", "wale 1\nmaterial a {",
        "wale 1\nlevels a { b = 3 }", "wale 1\nmaterial a { perceptual { essential roughness } }"}) {
    EXPECT_FALSE(grammar().recognises(wrong)) << wrong;
    EXPECT_NE(complaint(wrong), "") << wrong;
  }
}

/// Expects that grammar and parser agree about the text. Returns whether the grammar derives it.
bool agreed(const std::string& text) {
  if (has_block_twice(text)) return false;
  const bool derived = grammar().recognises(text);
  const std::string found = complaint(text);
  EXPECT_EQ(derived, found.empty()) << (derived ? "the grammar derives what the parser refuses:\n" + found + text
                                                : "the parser accepts what the grammar does not derive:\n" + text);
  return derived;
}

TEST(TheGrammar, AndTheParserAgreeAboutRandomSentences) {
  std::mt19937 random(7);
  constexpr int sentences = 1500;
  int derived = 0;
  for (int i = 0; i < sentences && !HasFailure(); ++i) {
    std::vector<std::string> comments;
    derived += agreed(grammar().sentence(random, 20 + i % 200, i % 2 == 0 ? nullptr : &comments));
  }
  EXPECT_GT(derived, sentences / 2);
}

TEST(TheGrammar, AndTheParserAgreeAboutMistakes) {
  std::mt19937 random(8);
  std::vector<std::pair<std::string, std::string>> files = shipped_files();
  for (int i = 0; i < 40; ++i) files.emplace_back("sentence", grammar().sentence(random, 150));
  constexpr int rounds = 4000;
  int derived = 0;
  for (int round = 0; round < rounds && !HasFailure(); ++round) {
    const std::string& text = files[random() % files.size()].second;
    wale::SourceSet sources;
    wale::Diagnostics diagnostics;
    const wale::Tokens tokens = lex(sources, sources.add("text", text), diagnostics);
    struct Spelled {
      std::string text;
      bool starts_line;
    };
    std::vector<Spelled> spelled;
    for (const wale::Token& token : tokens.tokens)
      spelled.push_back({text.substr(token.begin, token.end - token.begin), token.starts_line});
    if (spelled.size() < 4) continue;
    for (unsigned changes = 1 + random() % 2; changes > 0; --changes) {
      const std::size_t at = 2 + random() % (spelled.size() - 3), other = random() % spelled.size();
      switch (random() % 4) {
        case 0: spelled[at].text.clear(); break;  // its newline stays
        case 1: spelled.insert(spelled.begin() + static_cast<long>(at), Spelled(spelled[at])); break;
        case 2: std::swap(spelled[at].text, spelled[other].text); break;
        default: spelled[at].starts_line = !spelled[at].starts_line; break;
      }
    }
    std::string changed;
    for (const Spelled& each : spelled) changed += (each.starts_line ? "\n" : " ") + each.text;
    derived += agreed(changed);
  }
  EXPECT_GT(derived, rounds / 20);
  EXPECT_LT(derived, rounds / 2);
}

}  // namespace
