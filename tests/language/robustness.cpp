#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "compiler/diagnostics/render.hpp"
#include "compiler/parse/lex.hpp"
#include "tests/language/reading.hpp"
#include "tests/usb/allocations.hpp"

namespace {

namespace fs = std::filesystem;

/// `f(1,` needs the most: one list for every four bytes.
constexpr double most_allocations_per_byte = 1;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Every Wale file that the project ships.
std::vector<std::string> shipped() {
  std::vector<std::string> texts;
  for (const char* folder : {"schema", "calibration", "library"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / folder)) {
      if (entry.path().extension() == ".wale") texts.push_back(contents(entry.path()));
    }
  }
  return texts;
}

/// Reads, prints and renders the text. Expects no crash, an end, and sorted diagnostics within the limit.
void survive(const std::string& text) {
  const Reading reading(text);
  reading.printed();
  for (const auto& each : reading.diagnostics.all()) render_text(each, reading.sources, false);
  EXPECT_LE(reading.diagnostics.all().size(), wale::error_limit + 1);
  for (std::size_t i = 1; i < reading.diagnostics.all().size(); ++i) {
    EXPECT_LE(reading.diagnostics.all()[i - 1].span.begin, reading.diagnostics.all()[i].span.begin);
  }
}

TEST(Robustness, AllShippedFilesParse) {
  const auto texts = shipped();
  ASSERT_GE(texts.size(), 5u);
  for (const auto& text : texts) EXPECT_EQ(Reading(text).errors(), std::vector<std::string>{}) << text;
}

TEST(Robustness, RandomBytes) {
  std::mt19937 random(1);
  for (int round = 0; round < 500; ++round) {
    std::string text = round % 2 == 0 ? "wale 1\n" : "";
    for (unsigned length = random() % 300; length > 0; --length)
      text += static_cast<char>(random() % (round % 3 == 0 ? 256 : 128));
    survive(text);
  }
}

TEST(Robustness, RandomTokens) {
  const char* tokens[] = {"material", "physical", "perceptual", "param",  "let",     "force", "map", "from",
                          "if",       "then",     "else",       "in",     "on",      "{",     "}",   "(",
                          ")",        "[",        "]",          ",",      ";",       ":",     "=",   "..",
                          "+",        "-",        "*",          "/",      "^",       "<",     "±",   "'",
                          "%",        "\n",       "\n",         "x",      "k",       "2.5",   "mm",  "\"text\"",
                          "\"",       "/*",       "*/",         "// c\n", "/// d\n", "@",     "µm"};
  std::mt19937 random(2);
  for (int round = 0; round < 2000; ++round) {
    std::string text = "wale 1\nmaterial m { physical {\n";
    for (unsigned length = random() % 60; length > 0; --length)
      text += std::string(tokens[random() % std::size(tokens)]) + " ";
    survive(text);
  }
}

TEST(Robustness, MutatedFiles) {
  std::mt19937 random(3);
  const auto texts = shipped();
  for (int round = 0; round < 1000; ++round) {
    std::string text = texts[random() % texts.size()];
    for (unsigned changes = 1 + random() % 5; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0: text[at] = static_cast<char>(random() % 128); break;
        case 1: text.erase(at, 1 + random() % 10); break;
        case 2: text.insert(at, 1, "(){}=,;\n\"'"[random() % 10]); break;
        default: text.insert(at, text.substr(random() % text.size(), random() % 40)); break;
      }
      if (text.empty()) text = "x";
    }
    survive(text);
  }
}

TEST(Robustness, EveryPrefixOfAFile) {
  for (const auto& text : shipped()) {
    for (std::size_t length = 0; length < std::min<std::size_t>(text.size(), 1500); ++length)
      survive(text.substr(0, length));
  }
}

TEST(Robustness, NestingThousandsDeepIsRefused) {
  const auto repeated = [](const std::string& part, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += part;
    return result;
  };
  for (const char* opening : {"(", "-", "f(", "2^", "if ", "if a then ", "f(a, b: ", "(-", "[", "{"}) {
    const Reading reading("wale 1\nlet a = " + repeated(opening, 100000));
    ASSERT_EQ(reading.diagnostics.all().size(), 1u) << opening;
    const bool nests = opening[0] != '[' && opening[0] != '{';
    EXPECT_EQ(reading.diagnostics.all()[0].code, nests ? wale::Code::nested_too_deep : wale::Code::unexpected_token)
        << opening;
  }
  EXPECT_FALSE(Reading("wale 1\nlet a = " + repeated("(", 150) + "1" + repeated(")", 150)).diagnostics.has_errors());
  // The tree of a long sum is nested to the left although the text is not, so it has the same limit.
  EXPECT_FALSE(Reading("wale 1\nlet a = 1" + repeated(" + 1", 900)).diagnostics.has_errors());
  const Reading sum("wale 1\nlet a = 1" + repeated(" + 1", 100000));
  ASSERT_EQ(sum.diagnostics.all().size(), 1u);
  EXPECT_EQ(sum.diagnostics.all()[0].code, wale::Code::nested_too_deep);
}

TEST(Robustness, AHundredMegabytesAreRefused) {
  const Reading reading(std::string(100u << 20, 'x'));
  ASSERT_EQ(reading.diagnostics.all().size(), 1u);
  EXPECT_EQ(reading.diagnostics.all()[0].code, wale::Code::too_long);
  EXPECT_EQ(reading.diagnostics.all()[0].message, "this file has 100.0 MB; Wale reads up to 4 MB");
}

// Allocations are counted instead of time. A step that is quadratic in a file of 4 MB would need hours.
TEST(Robustness, WorkIsLinearInTheSizeOfTheLargestFiles) {
  for (const char* part :
       {"(", "}", "x ", "let a = 1\n", "let a b\n", "@ ", "(\n", "{ x\n", "f(1,", "µm ", "x = (\n"}) {
    std::string text = "wale 1\n";
    while (text.size() + std::strlen(part) < wale::largest_source) text += part;
    const long before = wale::test::allocations;
    const Reading reading(text);
    for (const auto& each : reading.diagnostics.all()) render_text(each, reading.sources, false);
    const long allocations = wale::test::allocations - before;
    EXPECT_LT(allocations, most_allocations_per_byte * static_cast<double>(text.size())) << part;
    EXPECT_LE(reading.tree.exprs.size(), text.size()) << part;
    EXPECT_LE(reading.diagnostics.all().size(), wale::error_limit + 1) << part;
  }
}

}  // namespace
