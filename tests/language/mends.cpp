// Each proposed mend mends: mistakes of many kinds are made in right files, one in each, and every fix that a
// diagnostic offers leaves fewer errors than there were, and no new one.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <random>
#include <regex>
#include <set>

#include "compiler/check_files.hpp"
#include "compiler/compile.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/parse/lex.hpp"
#include "tests/language/shipped.hpp"

namespace wale::mends_test {
namespace {

struct Checked {
  Diagnostics diagnostics;
  std::string shown;

  /// As `wale check` does; without the programs of its materials if it is `quick`, nor the fixes tried.
  Checked(const std::string& name, const std::string& text, bool quick = false) {
    SourceSet sources;
    const SourceId source = sources.add(std::string(WALE_SOURCE_DIR) + "/" + name, text);
    if (quick)
      check_source(sources, source, *file_resolver({}), diagnostics);
    else
      diagnostics = check_text(sources, source);
    for (const Diagnostic& each : diagnostics.all()) shown += render_text(each, sources, false);
  }
};

/// Materials with every part of a statement that people forget, double or exchange.
const std::pair<std::string, std::string> own[] = {
    {"parts.wale", R"(wale 1

let pitch = 2 mm

/// Half a wave.
function tops(along: position, period: wavelength) = max(0, cos(2 pi * along / period))

material parts {
  perceptual {
    roughness 0.4 ± 0.1
  }
  physical {
    param k = 120 N/m in 10 N/m .. 800 N/m, soft 50 N/m .. 300 N/m  "of the spring"
    param wide = 2.5 mm in 1 mm .. 5 mm
    param share = 0.4 in 0.2 .. 0.6
    state gone : length = 0 mm in 0 mm .. 900 mm
    next gone = gone + length(velocity) * dt
    memory track : length = 0 mm in 0 mm .. 5 mm, cell 1 mm
    next track = 1 mm
    let stiff = k / 2
    height ribs = grating(x, period: wide, duty: share, smooth: 24/256)
    height hills = tops(y, pitch)
    force texture = lateral(ribs + hills)
    force drawn = spring(stiff, rest: vector(0 mm, 5 mm)) limit 4 N
    force drag = viscous(2 N s/m) limit 3 N
    force wall = firm(500 N/m, face: 30 mm)
    force turned = if button then vector(0.2 N, 0 N) else vector(0 N, 0 N)
    force worn = if gone > 500 mm then vector(-10 N/m * x, 0 N) else -k * hand
  }
}
)"},
    {"choices.wale", R"(wale 1

material choices {
  physical {
    param size = 1 N in 0.5 N .. 2 N  "of the push"
    let inside = x > 5 mm and not button
    height grain = noise2(x / 1 mm, y / 2 mm)
    height lines = grating(x, 2 mm, 0.5)
    force pull = if inside then sticky(0.5 N) else if y < 0 mm then viscous(1 N s/m) else vector(0 N, 0 N)
    force grained = lateral(grain, amplitude: size)
    force lined = lateral(lines, size)
    force beat = vibrate(0.3 N, rate: 120 Hz)
  }
}

material another = choices(size: 0.8 N)
)"},
};

struct Right {
  std::string name, text;
  std::vector<Token> tokens;

  std::string spelling(std::size_t token) const {
    return text.substr(tokens[token].begin, tokens[token].end - tokens[token].begin);
  }
};

std::vector<Right> right_files() {
  std::vector<std::pair<std::string, std::string>> files(std::begin(own), std::end(own));
  for (const auto& [name, text] : shipped_files())
    if (name.starts_with("library/") && text.size() < 2500 && name.find("/std/") == std::string::npos)
      files.emplace_back(name, text);
  std::vector<Right> all;
  for (const auto& [name, text] : files) {
    Right right{name, text, {}};
    SourceSet sources;
    Diagnostics ignored;
    right.tokens = lex(sources, sources.add(name, text), ignored).tokens;
    all.push_back(std::move(right));
  }
  return all;
}

using Random = std::mt19937;
/// A file with a mistake; empty if the mistake cannot be made there.
using Make = std::function<std::string(const Right&, Random&)>;

template <class List>
const auto& one_of(const List& list, Random& random) {
  return list[random() % std::size(list)];
}

/// A random token for which `fits` holds; the number of tokens if there is none.
std::size_t token_for(const Right& right, Random& random, const std::function<bool(std::size_t)>& fits) {
  std::vector<std::size_t> all;
  for (std::size_t i = 1; i + 1 < right.tokens.size(); ++i)
    if (fits(i)) all.push_back(i);
  return all.empty() ? right.tokens.size() : all[random() % all.size()];
}

std::string with(const Right& right, std::size_t first, std::size_t last, const std::string& instead) {
  std::string text = right.text;
  const auto begin = right.tokens[first].begin, end = right.tokens[last].end;
  return text.replace(begin, end - begin, instead);
}

/// The text with one match of a pattern, chosen at random, replaced.
std::string replaced(const std::string& text, const char* pattern, const std::string& instead, Random& random) {
  const std::regex searched(pattern);
  std::vector<std::smatch> all;
  for (std::sregex_iterator each(text.begin(), text.end(), searched), end; each != end; ++each) all.push_back(*each);
  if (all.empty()) return {};
  const std::smatch& chosen = all[random() % all.size()];
  return std::string(chosen.prefix().first == text.begin() ? text.begin() : text.begin(), chosen[0].first) +
         chosen.format(instead) + std::string(chosen[0].second, text.end());
}

bool is_unit(const Right& right, std::size_t i) {
  return right.tokens[i].kind == TokenKind::name && right.tokens[i - 1].kind == TokenKind::number;
}

std::string misspelt(std::string word, Random& random) {
  if (word.size() < 4) return word + word.back();
  const std::size_t at = 1 + random() % (word.size() - 2);
  switch (random() % 3) {
    case 0: word.erase(at, 1); break;
    case 1: std::swap(word[at], word[at - 1]); break;
    default: word.insert(at, 1, word[at]);
  }
  return word;
}

const std::map<std::string, Make>& kinds() {
  static const std::map<std::string, Make> all{
      {"a unit of another kind",
       [](const Right& right, Random& random) -> std::string {
         const auto i = token_for(right, random, [&](std::size_t each) { return is_unit(right, each); });
         if (i == right.tokens.size()) return {};
         static const std::vector<std::string> units{"N", "mm", "s", "Hz", "kg", "N/m", "N s/m", "m/s", "g"};
         return with(right, i, i, one_of(units, random));
       }},
      {"a unit of another language",
       [](const Right& right, Random& random) -> std::string {
         const auto i = token_for(right, random, [&](std::size_t each) { return is_unit(right, each); });
         if (i == right.tokens.size()) return {};
         static const std::map<std::string, std::vector<std::string>> units{{"N", {"newton", "Newtons", "n"}},
                                                                            {"mm", {"millimeters", "MM", "millimetre"}},
                                                                            {"s", {"sec", "seconds"}},
                                                                            {"Hz", {"hertz", "hz"}},
                                                                            {"g", {"grams"}},
                                                                            {"kg", {"kilograms"}}};
         const auto theirs = units.find(right.spelling(i));
         return theirs == units.end() ? "" : with(right, i, i, one_of(theirs->second, random));
       }},
      {"no unit",
       [](const Right& right, Random& random) -> std::string {
         const auto i = token_for(right, random, [&](std::size_t each) { return is_unit(right, each); });
         return i == right.tokens.size() ? "" : with(right, i, i, "");
       }},
      {"a word misspelt",
       [](const Right& right, Random& random) -> std::string {
         const auto i = token_for(right, random, [&](std::size_t each) {
           return right.tokens[each].kind == TokenKind::name && right.spelling(each).size() > 3;
         });
         return i == right.tokens.size() ? "" : with(right, i, i, misspelt(right.spelling(i), random));
       }},
      {"a token forgotten",
       [](const Right& right, Random& random) -> std::string {
         const auto i = token_for(right, random, [&](std::size_t each) {
           const TokenKind kind = right.tokens[each].kind;
           return kind != TokenKind::name && kind != TokenKind::number && kind != TokenKind::text;
         });
         return i == right.tokens.size() ? "" : with(right, i, i, "");
       }},
      {"a token twice",
       [](const Right& right, Random& random) -> std::string {
         const auto i = token_for(right, random, [](std::size_t) { return true; });
         return with(right, i, i, right.spelling(i) + " " + right.spelling(i));
       }},
      {"no `then`", [](const Right& right, Random& random) { return replaced(right.text, " then ", " ", random); }},
      {"no `else`", [](const Right& right, Random& random) { return replaced(right.text, " else ", " ", random); }},
      {"a part twice",
       [](const Right& right, Random& random) -> std::string {
         static const std::vector<const char*> parts{R"( limit [\d.]+ N)",  R"( in [\d.]+ \S+ \.\. [\d.]+ [^\s,]+)",
                                                     R"( ± [\d.]+)",        R"(, soft [\d.]+ \S+ \.\. [\d.]+ \S+)",
                                                     R"(, cell [\d.]+ mm)", R"(  "[^"]+"(?=\n))"};
         return replaced(right.text, one_of(parts, random), "$&$&", random);
       }},
      {"arguments exchanged",
       [](const Right& right, Random& random) -> std::string {
         static const char* const two = R"(\(([^(),]+), ([^(),:]+: )?([^(),:]+)([,)]))";
         static const char* const named = R"((\w+: )([^(),:]+), (\w+: )([^(),:]+)([,)]))";
         return random() % 2 == 0 ? replaced(right.text, two, "($3, $2$1$4", random)
                                  : replaced(right.text, named, "$1$4, $3$2$5", random);
       }},
      {"arguments turned round",
       [](const Right& right, Random& random) -> std::string {
         static const char* const three = R"(\(([^(),]+), ([^(),:]+), ([^(),:]+)([,)]))";
         return replaced(right.text, three, random() % 2 == 0 ? "($3, $1, $2$4" : "($2, $3, $1$4", random);
       }},
      {"a declaration in a block",
       [](const Right& right, Random& random) -> std::string {
         static const std::vector<std::string> declarations{"function hill(t) = max(0, cos(t))",
                                                            "export function hill(t) = max(0, cos(t))",
                                                            "function lever(turn: length) = turn /\n      2",
                                                            "unit thou = 25.4 um",
                                                            "import std.friction",
                                                            "dimension torque = force * length",
                                                            "material inner { perceptual { roughness 0.5 } }",
                                                            "material inner = corduroy"};
         static const std::vector<const char*> places{R"((\n  physical \{\n))", R"((\n  perceptual \{\n))",
                                                      R"((\nmaterial \w+ \{\n))", R"((\n    force[^\n]*\n))"};
         return replaced(right.text, one_of(places, random), "$1    " + one_of(declarations, random) + "\n", random);
       }},
      {"a statement outside",
       [](const Right& right, Random& random) -> std::string {
         static const std::vector<std::string> statements{"param q = 1 N in 0 N .. 2 N", "force extra = sticky(0.2 N)",
                                                          "roughness 0.5", "title \"Rib\"", "active 1 W"};
         static const std::vector<const char*> places{R"((\nmaterial \w+ \{\n))", R"((\n  \}\n))"};
         return replaced(right.text, one_of(places, random), "$1  " + one_of(statements, random) + "\n", random);
       }},
      {"two statements in a line",
       [](const Right& right, Random& random) -> std::string {
         return replaced(right.text, R"(\n    (?=(param|let|height|force|state) ))", " ", random);
       }},
  };
  return all;
}

/// The errors of a text by what they say, without the names and numbers in it.
std::set<std::string> errors_in(const Checked& checked) {
  std::set<std::string> found;
  for (const Diagnostic& each : checked.diagnostics.all())
    if (severity_of(each.code) == Severity::error) found.insert(std::string(code_name(each.code)) + each.message);
  return found;
}

TEST(Mends, LeaveFewerErrorsAndNoNewOne) {
  const std::vector<Right> files = right_files();
  for (const Right& each : files) {
    const Checked right(each.name, each.text, true);
    ASSERT_FALSE(right.diagnostics.has_errors()) << right.shown;
  }
  const char* const wanted = std::getenv("WALE_MENDS");
  const int rounds = wanted ? std::atoi(wanted) : 40;
  int offered = 0, whole = 0, mistakes = 0, several = 0;
  for (const auto& [kind, make] : kinds()) {
    Random random(17);
    for (int round = 0; round < rounds; ++round) {
      // Half of the mistakes are made in those files that have every part.
      const Right& right = round % 2 == 0 ? files[random() % std::size(own)] : files[random() % files.size()];
      const std::string text = make(right, random);
      if (text.empty() || text == right.text) continue;
      if (!Checked(right.name, text, true).diagnostics.has_errors()) continue;
      const Checked wrong(right.name, text);
      ++mistakes, several += wrong.diagnostics.error_count() > 1;
      if (wanted && wrong.diagnostics.error_count() > 1)
        std::cout << "==== several: " << kind << " in " << right.name << "\n" << wrong.shown;
      const std::set<std::string> before = errors_in(wrong);
      for (const Diagnostic& each : wrong.diagnostics.all()) {
        if (severity_of(each.code) != Severity::error) continue;
        for (const Fix& fix : each.fixes) {
          const FixedText fixed = apply_fixes(text, each.span.source, {fix});
          if (fixed.applied.empty()) continue;
          ++offered;
          const Checked after(right.name, fixed.text, true);
          const std::size_t left = after.diagnostics.error_count();
          whole += left == 0;
          const bool is_new =
              std::ranges::any_of(errors_in(after), [&](const auto& error) { return !before.contains(error); });
          EXPECT_TRUE(left < wrong.diagnostics.error_count() && !is_new)
              << "==== " << kind << " in " << right.name << ": " << fix.title << (fix.safe ? " (safe)" : "") << "\n"
              << wrong.shown << "-- after --\n"
              << after.shown;
        }
      }
    }
  }
  std::cout << mistakes << " mistakes, " << several << " with several errors, " << offered << " fixes, " << whole
            << " leave no error\n";
  EXPECT_GE(mistakes, 300);
  EXPECT_GE(offered, 100);
}

}  // namespace
}  // namespace wale::mends_test
