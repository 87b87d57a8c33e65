// One mistake gives few errors: shipped files with one token dropped, doubled or exchanged.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/parse/lex.hpp"

namespace wale::cascades_test {
namespace {

namespace fs = std::filesystem;

/// A shipped file under its own path, so that its imports and pictures are found and it replaces the embedded copy.
struct Shipped {
  std::string name, text;
  std::vector<Token> tokens;
};

std::vector<Shipped> shipped() {
  std::vector<fs::path> paths;
  for (const char* folder : {"schema", "calibration", "library"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".wale") paths.push_back(entry.path());
  std::ranges::sort(paths);
  std::vector<Shipped> files;
  for (const auto& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    Shipped file{path.string(), {std::istreambuf_iterator<char>(stream), {}}, {}};
    SourceSet sources;
    Diagnostics ignored;
    file.tokens = lex(sources, sources.add(file.name, file.text), ignored).tokens;
    file.tokens.pop_back();  // the end
    files.push_back(std::move(file));
  }
  return files;
}

Diagnostics errors_of(const std::string& name, const std::string& text, std::string& shown) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  check_source(sources, sources.add(name, text), *resolver, diagnostics);
  for (const auto& each : diagnostics.all())
    if (severity_of(each.code) == Severity::error) shown += render_text(each, sources, false);
  return diagnostics;
}

struct Mistake {
  std::string what, text, shown;
  std::size_t errors = 0;
};

/// The file with one random change of one token, and its errors.
Mistake mistake_in(const Shipped& file, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return random() % n; };
  const auto spelling = [&](const Token& token) { return file.text.substr(token.begin, token.end - token.begin); };
  const Token& token = file.tokens[below(file.tokens.size())];
  std::string text = file.text;
  Mistake mistake;
  switch (below(3)) {
    case 0:
      mistake.what = "without `" + spelling(token) + "`";
      text.erase(token.begin, token.end - token.begin);
      break;
    case 1:
      mistake.what = "with `" + spelling(token) + "` twice";
      text.insert(token.end, " " + spelling(token));
      break;
    default: {
      const std::string other = spelling(file.tokens[below(file.tokens.size())]);
      mistake.what = "with `" + other + "` in the place of `" + spelling(token) + "`";
      text.replace(token.begin, token.end - token.begin, other);
    }
  }
  const auto line = std::count(file.text.begin(), file.text.begin() + token.begin, '\n') + 1;
  mistake.what = file.name + ":" + std::to_string(line) + " " + mistake.what;
  mistake.errors = errors_of(file.name, text, mistake.shown).error_count();
  mistake.text = std::move(text);
  return mistake;
}

/// The text after all safe fixes, applied until there are none. `rounds` receives the number of rounds.
std::string mended(const std::string& name, std::string text, int& rounds) {
  for (rounds = 0; rounds < 50; ++rounds) {
    SourceSet sources;
    Diagnostics diagnostics;
    const auto resolver = file_resolver({});
    const SourceId source = sources.add(name, text);
    check_source(sources, source, *resolver, diagnostics);
    const FixedText fixed = apply_fixes(text, source, safe_fixes(diagnostics.all()));
    if (fixed.applied.empty()) break;
    text = fixed.text;
  }
  return text;
}

TEST(SafeFixes, EndAndNeverMakeAFileWorse) {
  const auto files = shipped();
  std::mt19937 random(8);
  int mended_whole = 0;
  for (int round = 0; round < 600; ++round) {
    const Shipped& file = files[random() % files.size()];
    const std::string text = mistake_in(file, random).text;
    int rounds = 0;
    const std::string result = mended(file.name, text, rounds);
    ASSERT_LT(rounds, 50) << result;
    if (result == text) continue;
    std::string before, after;
    const std::size_t errors = errors_of(file.name, text, before).error_count();
    const std::size_t left = errors_of(file.name, result, after).error_count();
    EXPECT_LE(left, errors) << before << "-- after --\n" << after;
    mended_whole += left == 0;
  }
  EXPECT_GT(mended_whole, 10);
}

TEST(Cascades, AreNone) {
  const auto files = shipped();
  ASSERT_GE(files.size(), 8u);
  for (const auto& file : files) {
    std::string shown;
    ASSERT_EQ(errors_of(file.name, file.text, shown).error_count(), 0u) << shown;
  }
  std::mt19937 random(7);
  std::vector<Mistake> mistakes;
  for (int round = 0; round < 1500; ++round) {
    Mistake mistake = mistake_in(files[random() % files.size()], random);
    if (mistake.errors > 0) mistakes.push_back(std::move(mistake));
  }
  ASSERT_GT(mistakes.size(), 900u);
  std::ranges::sort(mistakes, {}, &Mistake::errors);
  const auto share = [&](double part) {
    return mistakes[static_cast<std::size_t>(part * (mistakes.size() - 1))].errors;
  };
  std::string worst;
  for (std::size_t i = mistakes.size() - 5; i < mistakes.size(); ++i)
    worst += mistakes[i].what + "\n" + mistakes[i].shown + "\n";
  EXPECT_EQ(share(0.5), 1u);
  EXPECT_LE(share(0.99), 3u) << worst;
}

}  // namespace
}  // namespace wale::cascades_test
