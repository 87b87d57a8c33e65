// Files with words dropped, doubled, exchanged or taken from other files. Every diagnostic has a message, a place and a
// mend, no stage crashes, and no program is refused by the machine.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>

#include "tests/compiler/compiling.hpp"

namespace wale::compiling::robustness_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    if (letter(text[i]))
      while (end < text.size() && letter(text[end])) ++end;
    words.push_back(text.substr(i, end - i));
    i = end;
  }
  return words;
}

/// The words of each shipped file and each case of a diagnostic, except the cases for damaged text and for size.
std::vector<std::vector<std::string>> corpus() {
  std::vector<fs::path> files;
  for (const char* folder : {"library", "schema", "calibration", "tests/language/diagnostics"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".wale" && entry.path().string().find("W01") == std::string::npos &&
          entry.path().string().find("W0603") == std::string::npos)
        files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<std::vector<std::string>> texts;
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    texts.push_back(words_of({std::istreambuf_iterator<char>(file), {}}));
  }
  return texts;
}

TEST(MangledFiles, HaveDiagnosticsWithPlacesAndMends) {
  const auto texts = corpus();
  ASSERT_GT(texts.size(), 30u);
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return random() % n; };
  long wrong = 0, right = 0;
  for (int round = 0; round < 500; ++round) {
    std::vector<std::string> words = texts[below(texts.size())];
    for (std::size_t change = below(4); change < 4; ++change) {
      const auto& other = texts[below(texts.size())];
      const auto at = words.begin() + static_cast<std::ptrdiff_t>(below(words.size()));
      switch (below(5)) {
        case 0: words.erase(at); break;
        case 1: words.insert(at, *at); break;
        case 2: std::swap(*at, words[below(words.size())]); break;
        case 3: *at = other[below(other.size())]; break;
        default: words.insert(at, {" ", other[below(other.size())], " "}); break;
      }
    }
    std::string text;
    for (const auto& word : words) text += word;

    SourceSet sources;
    Diagnostics diagnostics;
    Files none;
    const SourceId source = sources.add("mangled.wale", text);
    const CheckedModule module = check_source(sources, source, none, diagnostics);
    std::vector<Diagnostic> all = diagnostics.all();
    if (!diagnostics.has_errors())
      for (const auto& material : module.materials) {
        Diagnostics of_material;
        const auto program =
            compile_material(module, material.name, default_device, sources, source, none, of_material);
        EXPECT_EQ(program.has_value(), !of_material.has_errors()) << text;
        all.insert(all.end(), of_material.all().begin(), of_material.all().end());
      }
    for (const auto& diagnostic : all) {
      const std::string shown = render_text(diagnostic, sources, false);
      ASSERT_LE(diagnostic.span.begin, diagnostic.span.end) << shown;
      ASSERT_LE(diagnostic.span.end, sources[diagnostic.span.source].text.size()) << shown;
      ASSERT_FALSE(diagnostic.message.empty()) << shown;
      ASSERT_FALSE(diagnostic.help.empty() && diagnostic.expected.empty()) << shown;
      ASSERT_EQ(shown.find("the machine refuses"), std::string::npos) << shown << text;
      ASSERT_FALSE(std::regex_search(diagnostic.message, std::regex("\\bnan\\b"))) << shown << text;
    }
    ++(all.empty() ? right : wrong);
  }
  EXPECT_GT(wrong, right);
  EXPECT_GT(right, 10) << "too few of the changed files are still valid";
}

/// The material has more constants than 16 bits can count; its registers are counted correctly nevertheless.
TEST(VastMaterial, IsRefusedForItsRegisters) {
  constexpr int lets = 90, terms = 900;
  std::string physical = "let u = x / 1 m\nlet a0 = u\n";
  for (int let = 1; let <= lets; ++let) {
    physical += "let a" + std::to_string(let) + " = a" + std::to_string(let - 1);
    for (int term = 0; term < terms; ++term) physical += " + " + std::to_string(let * terms + term) + " * u";
    physical += "\n";
  }
  physical += "force = vector(a" + std::to_string(lets) + " * 1 N, 0 N)";
  try {
    compiled(physical);
    FAIL() << "a program of " << lets * terms << " constants";
  } catch (const std::runtime_error& refused) {
    EXPECT_NE(std::string(refused.what()).find("registers, and a patch program has 16 384"), std::string::npos);
  }
}

}  // namespace
}  // namespace wale::compiling::robustness_test
