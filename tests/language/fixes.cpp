#include <gtest/gtest.h>

#include "compiler/declarations/unit_names.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/diagnostics/fix.hpp"
#include "tests/language/reading.hpp"

namespace {

using wale::Fix;

wale::Span span(std::uint32_t begin, std::uint32_t end) { return {0, begin, end}; }

std::string applied(const std::string& text, const std::vector<Fix>& fixes) {
  return wale::apply_fixes(text, 0, fixes).text;
}

TEST(ApplyFixes, ReplacesInsertsAndRemoves) {
  EXPECT_EQ(applied("one two three", {wale::replace(span(4, 7), "2")}), "one 2 three");
  EXPECT_EQ(applied("one two three", {wale::insert_before(span(4, 7), "a ")}), "one a two three");
  EXPECT_EQ(applied("one two three", {wale::insert_after(span(4, 7), ",")}), "one two, three");
  EXPECT_EQ(applied("one two three", {wale::replace(span(3, 7), "")}), "one three");
  EXPECT_EQ(applied("", {wale::insert_before(span(0, 0), "x")}), "x");
}

TEST(ApplyFixes, TakesFixesInAnyOrderAndReturnsThemInTheOrderOfTheText) {
  const auto fixed = wale::apply_fixes("abc", 0, {wale::replace(span(2, 3), "C"), wale::replace(span(0, 1), "A")});
  EXPECT_EQ(fixed.text, "AbC");
  ASSERT_EQ(fixed.applied.size(), 2u);
  EXPECT_EQ(fixed.applied[0].title, "write `A`");
}

TEST(ApplyFixes, OfTwoThatCollideTheFirstIsApplied) {
  EXPECT_EQ(applied("abcd", {wale::replace(span(1, 3), "X"), wale::replace(span(2, 4), "Y")}), "aXd");
  EXPECT_EQ(applied("abcd", {wale::replace(span(2, 4), "Y"), wale::replace(span(1, 3), "X")}), "abY");
  EXPECT_EQ(applied("abcd", {wale::replace(span(0, 4), "X"), wale::insert_before(span(2, 2), "Y")}), "X");
  EXPECT_EQ(applied("abcd", {wale::insert_before(span(2, 2), "1"), wale::insert_before(span(2, 2), "2")}), "ab1cd");
  // Neighbours do not collide.
  EXPECT_EQ(applied("abcd", {wale::replace(span(0, 2), "X"), wale::replace(span(2, 4), "Y")}), "XY");
}

TEST(ApplyFixes, AppliesAFixWholeOrNotAtAll) {
  const Fix both{"", {{span(0, 1), "A"}, {span(2, 3), "C"}}, true};
  EXPECT_EQ(applied("abc", {both}), "AbC");
  EXPECT_EQ(applied("abc", {wale::replace(span(2, 3), "x"), both}), "abx");
  const Fix elsewhere{"", {{span(0, 1), "A"}, {{1, 0, 1}, "B"}}, true};
  EXPECT_EQ(applied("abc", {elsewhere}), "abc");
  EXPECT_EQ(applied("abc", {wale::replace(span(2, 9), "x"), wale::replace(span(2, 1), "y"), Fix{}}), "abc");
}

TEST(ApplyFixes, TwoHundredThousandAreApplied) {
  std::string text(200000, 'a'), expected(200000, 'b');
  std::vector<Fix> fixes;
  for (std::uint32_t at = 0; at < text.size(); ++at) fixes.push_back(wale::replace(span(at, at + 1), "b"));
  EXPECT_EQ(applied(text, fixes), expected);
}

TEST(SafeFixes, AreTheFirstSafeOneOfEachDiagnostic) {
  wale::Diagnostic several{.code = wale::Code::unknown_name};
  several.fixes = {wale::replace(span(0, 1), "unsafe", {}, false), wale::replace(span(0, 1), "first"),
                   wale::replace(span(0, 1), "second")};
  const wale::Diagnostic none{.code = wale::Code::unknown_name};
  const auto fixes = wale::safe_fixes({none, several});
  ASSERT_EQ(fixes.size(), 1u);
  EXPECT_EQ(fixes[0].title, "write `first`");
}

TEST(Respell, IsSafeOnlyForTheOneNameThatIsOneSlipAway) {
  const auto fix = [](const char* word, std::vector<std::string> candidates) -> std::string {
    const auto fixes = wale::respell(span(0, 1), word, candidates);
    return fixes.empty() ? "none" : (fixes[0].safe ? "safe " : "unsafe ") + fixes[0].edits.at(0).replacement;
  };
  EXPECT_EQ(fix("peroid", {"period", "duty"}), "safe period");
  EXPECT_EQ(fix("perod", {"period"}), "safe period");
  EXPECT_EQ(fix("perioood", {"period"}), "unsafe period") << "two slips";
  EXPECT_EQ(fix("ribc", {"ribs", "ribb"}), "unsafe ribs") << "two are as near";
  EXPECT_EQ(fix("ribs2", {"ribs1", "ribs3"}), "unsafe ribs1");
  EXPECT_EQ(fix("ribc", {"ribs", "ribs"}), "safe ribs") << "the same name twice is one";
  EXPECT_EQ(fix("Period", {"period", "peroid"}), "safe period") << "capitals are nearer than letters";
  EXPECT_EQ(fix("wavelength", {"period", "duty"}), "none");
  EXPECT_EQ(fix("k", {"b", "c"}), "none") << "every name is near to a single letter";
  EXPECT_FALSE(wale::respell(span(0, 1), "MN", {"mN"}, false).at(0).safe) << "MN is 10^9 mN";
}

TEST(UnitNames, AreThoseThatPeopleWriteOut) {
  const struct {
    const char *name, *symbol;
  } cases[] = {{"millimeter", "mm"}, {"Millimetres", "mm"}, {"metre", "m"},   {"Newton", "N"},     {"newtons", "N"},
               {"kilograms", "kg"},  {"sec", "s"},          {"secs", "s"},    {"msec", "ms"},      {"kilohertz", "kHz"},
               {"inches", "inch"},   {"degrees", "deg"},    {"pixels", "px"}, {"micrometre", "um"}};
  for (const auto& each : cases) EXPECT_EQ(wale::symbol_of_unit(each.name), each.symbol) << each.name;
  for (const char* name : {"foot", "lbf", "mm", "", "s", "millisecondth", "centihertz"})
    EXPECT_EQ(wale::symbol_of_unit(name), std::nullopt) << name;
}

/// The text after its safe fixes are applied until there are none, at most ten times.
std::string mended(std::string text) {
  for (int round = 0; round < 10; ++round) {
    const Reading reading(text);
    const auto fixed = wale::apply_fixes(text, 0, wale::safe_fixes(reading.diagnostics.all()));
    if (fixed.applied.empty()) break;
    text = fixed.text;
  }
  return text;
}

TEST(ParserFixes, MendUnambiguousMistakes) {
  const struct {
    const char *wrong, *right;
  } cases[] = {
      {"let a = 5. mm", "let a = 5 mm"},
      {"let a = .5", "let a = 0.5"},
      {"let a = -.5", "let a = -0.5"},
      {"let a = 0x1F", "let a = 31"},
      {"let a = 2 µm + 3 μm", "let a = 2 um + 3 um"},
      {"let a = 2 m²", "let a = 2 m^2"},
      {"let a = 90°", "let a = 90deg"},
      {"let a = 3 × b − c ÷ d", "let a = 3 * b - c / d"},
      {"let a = b ** 2", "let a = b ^ 2"},
      {"let a = if b ≤ c then 1 else 2", "let a = if b <= c then 1 else 2"},
      {"param a = 1 in 0 … 2", "param a = 1 in 0 .. 2"},
      {"param a = 1 in 0 ... 2", "param a = 1 in 0 .. 2"},
      {"param a = 1 in 0 2", "param a = 1 in 0 .. 2"},
      {"param a 1 in 0 .. 2", "param a = 1 in 0 .. 2"},
      {"param a = 1 in 0 .. 2 “how much”", "param a = 1 in 0 .. 2 \"how much\""},
      {"v’ = 3", "v' = 3"},
      {"let a 3", "let a = 3"},
      {"let \"a\" = 3", "let a = 3"},
      {"height h grating(x)", "height h = grating(x)"},
      {"force lateral(h)", "force = lateral(h)"},
      {"force -k * hand", "force = -k * hand"},
      {"fource = 3", "force = 3"},
      {"heigth h = x", "height h = x"},
      {"patch = 3 mm, 4 mm", "patch 3 mm, 4 mm"},
      {"patch=3 mm, 4 mm", "patch 3 mm, 4 mm"},
      {"let a = 2 sin(b)", "let a = 2 * sin(b)"},
      {"let a = 2 (b + c)", "let a = 2 * (b + c)"},
      {"let a = 2,5 mm", "let a = 2.5 mm"},
      {"let a = \u200B3", "let a = 3"},
      {"let a = b\n  + c", "let a = b +\n  c"},
      {"# a comment\nlet a = 3", "// a comment\nlet a = 3"},
  };
  for (const auto& each : cases) {
    const auto file = [](const std::string& statement) {
      return "wale 1\nmaterial m {\nphysical {\n" + statement + "\n} }\n";
    };
    EXPECT_EQ(mended(file(each.wrong)), file(each.right));
    EXPECT_EQ(Reading(file(each.right)).errors(), std::vector<std::string>{}) << each.right;
  }
}

TEST(ParserFixes, MendDeclarationsAndSettings) {
  EXPECT_EQ(mended("let a = 1\n"), "wale 1\nlet a = 1\n");
  EXPECT_EQ(mended("\xEF\xBB\xBF// ribs\r\nlet a = 1\r\n"), "\xEF\xBB\xBFwale 1\r\n// ribs\r\nlet a = 1\r\n");
  EXPECT_EQ(mended("Wale 1\n"), "wale 1\n");
  EXPECT_EQ(mended("wale\nlet a = 1\n"), "wale 1\nlet a = 1\n");
  EXPECT_EQ(mended("wale 1\nimport \"fabric/denim.wale\"\n"), "wale 1\nimport fabric.denim\n");
  EXPECT_EQ(mended("wale 1\nmaterail m { perceptaul { roughness: 0.5 } }\n"),
            "wale 1\nmaterial m { perceptual { roughness 0.5 } }\n");
  EXPECT_EQ(mended("wale 1\nhand h { mass = 3 kg\n damping=5 N s/m }\n"),
            "wale 1\nhand h { mass 3 kg\n damping 5 N s/m }\n");
}

TEST(ParserFixes, CloseBlocksInLinesOfTheirOwn) {
  EXPECT_EQ(mended("wale 1\nmaterial a {\n  physical {\n    force = x  // the push\n  }\nmaterial b {\n}\n"),
            "wale 1\nmaterial a {\n  physical {\n    force = x  // the push\n  }\n}\nmaterial b {\n}\n");
  EXPECT_EQ(mended("wale 1\nmaterial a {\n  perceptual {\n    roughness 0.5"),
            "wale 1\nmaterial a {\n  perceptual {\n    roughness 0.5\n  }\n}");
  EXPECT_EQ(mended("wale 1\nmaterial a { perceptual { roughness 0.5 physical { force = x } }\n"),
            mended(mended("wale 1\nmaterial a { perceptual { roughness 0.5 physical { force = x } }\n")));
  const std::string commented = "wale 1\nmaterial a {\n  physical {\n    force = x  /* the\n push */ }\n";
  EXPECT_EQ(Reading(mended(commented)).errors().size(), 0u) << mended(commented);
}

TEST(ParserFixes, LeaveDoubtfulThingsAlone) {
  for (const char* statement :
       {"let a = k hand", "let a = (3", "let a = 3)", "q = 3", "let a = b == c", "let a = [1, 2]", "let a = (1, 2)",
        "let a b = 3", "let größe = 3", "let a = f(x, p: 2,5 mm)", "let a = x.5", "let a = “b \"c\" d”",
        "let a = if b = c then 1 else 2", "let a = 1e999"}) {
    const std::string text = "wale 1\nmaterial m {\nphysical {\n" + std::string(statement) + "\n} }\n";
    EXPECT_EQ(mended(text), text);
    EXPECT_TRUE(Reading(text).diagnostics.has_errors()) << statement;
  }
  EXPECT_EQ(mended("A shopping list\n\neggs\n"), "A shopping list\n\neggs\n");
  EXPECT_EQ(mended(""), "");
  EXPECT_EQ(mended("wale 0\n"), "wale 0\n");
}

}  // namespace
