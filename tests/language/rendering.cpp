#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compiler/diagnostics/render.hpp"

namespace wale::rendering_test {
namespace {

/// A diagnostic about the first occurrence of `part` in a file of that text.
struct Rendering {
  SourceSet sources;
  Diagnostic diagnostic;

  Rendering(std::string text, std::string_view part) {
    const std::size_t at = text.find(part);
    diagnostic.code = Code::wrong_dimension;
    diagnostic.span = {0, static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(at + part.size())};
    diagnostic.message = "expected force, found energy";
    sources.add("library/fabric/corduroy.wale", std::move(text));
  }
  std::string text() const { return render_text(diagnostic, sources, false); }
};

TEST(Rendering, HasAPlaceALabelAndNotes) {
  Rendering rendering("\n\n\n\n\n\n\n\n    force = k * hand * wale\n", "k * hand * wale");
  rendering.diagnostic.label = "N m";
  rendering.diagnostic.expected = "N    = kg m   s^-2";
  rendering.diagnostic.found = "N m  = kg m^2 s^-2";
  rendering.diagnostic.help = "one length too many; divide by a length, or drop `* wale` (a length, line 7)";
  EXPECT_EQ(rendering.text(),
            "error[W0301]: expected force, found energy\n"
            "  --> library/fabric/corduroy.wale:9:13\n"
            "   |\n"
            " 9 |     force = k * hand * wale\n"
            "   |             ^^^^^^^^^^^^^^^ N m\n"
            "   |\n"
            "   = expected  N    = kg m   s^-2\n"
            "     found     N m  = kg m^2 s^-2\n"
            "   = help: one length too many; divide by a length, or drop `* wale` (a length, line 7)\n");
}

TEST(Rendering, TheMarginIsAsWideAsTheLineNumber) {
  const Rendering rendering(std::string(122, '\n') + "a b\r\n", "b");
  EXPECT_EQ(rendering.text(),
            "error[W0301]: expected force, found energy\n"
            "    --> library/fabric/corduroy.wale:123:3\n"
            "     |\n"
            " 123 | a b\n"
            "     |   ^\n");
}

TEST(Rendering, CaretsCountCharactersAndTabs) {
  const Rendering letters("größe = µm + x\n", "µm");
  EXPECT_NE(letters.text().find(" 1 | größe = µm + x\n   |         ^^\n"), std::string::npos) << letters.text();
  EXPECT_NE(letters.text().find(".wale:1:9\n"), std::string::npos);
  const Rendering tabs("\ta\tb = c\n", "b");
  EXPECT_NE(tabs.text().find(" 1 |     a   b = c\n   |         ^\n"), std::string::npos) << tabs.text();
  EXPECT_NE(tabs.text().find(".wale:1:4\n"), std::string::npos);
}

TEST(Rendering, AnEmptySpanHasOneCaretAndALongOneEndsWithItsLine) {
  Rendering empty("let a =\n", "let a =");
  empty.diagnostic.span.begin = empty.diagnostic.span.end;
  EXPECT_NE(empty.text().find(" 1 | let a =\n   |        ^\n"), std::string::npos) << empty.text();
  const Rendering several("f(a,\n  b)\n", "f(a,\n  b)");
  EXPECT_NE(several.text().find(" 1 | f(a,\n   | ^^^^\n"), std::string::npos) << several.text();
}

TEST(Rendering, VeryLongLinesAreTrimmedAroundThePlace) {
  const Rendering rendering(std::string(5000, 'a') + " here " + std::string(5000, 'b'), "here");
  const std::string text = rendering.text();
  EXPECT_NE(text.find(" 1 | …aaaaa"), std::string::npos) << text;
  EXPECT_NE(text.find("a here b"), std::string::npos) << text;
  EXPECT_NE(text.find("bb…\n   |                               ^^^^\n"), std::string::npos) << text;
  EXPECT_LT(text.size(), 500u);
}

TEST(Rendering, AFileCannotSteerTheTerminal) {
  const Rendering rendering("let \x1b[31m = \xff\n", "let");
  EXPECT_NE(rendering.text().find(" 1 | let \uFFFD[31m = \uFFFD\n"), std::string::npos) << rendering.text();
}

TEST(Rendering, ColoursChangeNothingElse) {
  Rendering rendering("force = k\n", "k");
  rendering.diagnostic.expected = "N";
  rendering.diagnostic.help = "a\nb";
  std::string coloured = render_text(rendering.diagnostic, rendering.sources, true);
  EXPECT_TRUE(coloured.starts_with("\x1b[1;31merror[W0301]\x1b[0m"));
  for (std::size_t at; (at = coloured.find('\x1b')) != std::string::npos;)
    coloured.erase(at, coloured.find('m', at) - at + 1);
  EXPECT_EQ(coloured, rendering.text());
  EXPECT_NE(rendering.text().find("   = help: a\n           b\n"), std::string::npos) << rendering.text();
}

TEST(Rendering, JsonForPrograms) {
  Rendering rendering("a\nµ force = k\n", "force");
  rendering.diagnostic.help = "\xff";
  Diagnostics diagnostics;
  diagnostics.report(rendering.diagnostic);
  rendering.diagnostic.code = Code::unused_name;
  rendering.diagnostic.span.end -= 1;  // a place with an error has no warnings
  diagnostics.report(rendering.diagnostic);
  const auto json = nlohmann::json::parse(render_json(diagnostics, rendering.sources));
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["code"], "W0301");
  EXPECT_EQ(json[0]["severity"], "error");
  EXPECT_EQ(json[0]["file"], "library/fabric/corduroy.wale");
  EXPECT_EQ(json[0]["line"], 2);
  EXPECT_EQ(json[0]["column"], 3);
  EXPECT_EQ(json[0]["end_line"], 2);
  EXPECT_EQ(json[0]["end_column"], 8);
  EXPECT_EQ(json[0]["message"], "expected force, found energy");
  EXPECT_EQ(json[0]["help"], "\uFFFD");
  EXPECT_FALSE(json[0].contains("expected"));
  EXPECT_EQ(json[1]["severity"], "warning");
  EXPECT_EQ(render_json(Diagnostics(), rendering.sources), "[]");
}

TEST(Rendering, SecondarySpansAreUnderlinedOnTheirOwnLinesInOrder) {
  const std::string text = "let k = 3 N\n\n\n\n\n\n\n\n\nlet sum = k + 2 mm\n";
  Rendering rendering(text, "k + 2 mm");
  const auto at = [&](const char* part) {
    const auto begin = static_cast<std::uint32_t>(text.find(part));
    return Span{0, begin, begin + static_cast<std::uint32_t>(std::string(part).size())};
  };
  rendering.diagnostic.label = "no sum";
  rendering.diagnostic.secondary = {{at("2 mm"), "a length"}, {at("3 N"), "a force"}, {at("let sum"), ""}};
  EXPECT_EQ(rendering.text(),
            "error[W0301]: expected force, found energy\n"
            "   --> library/fabric/corduroy.wale:10:11\n"
            "    |\n"
            "  1 | let k = 3 N\n"
            "    |         --- a force\n"
            "...\n"
            " 10 | let sum = k + 2 mm\n"
            "    |           ^^^^^^^^ no sum\n"
            "    |               ---- a length\n"
            "    | -------\n");
}

TEST(Rendering, SecondarySpansInOtherFilesNameThem) {
  Rendering rendering("force = k\n", "k");
  const SourceId other = rendering.sources.add("library/levels.wale", "\n\nlet k = 3 mm\n");
  rendering.diagnostic.secondary = {{{other, 6, 7}, "declared here"}, {{9, 0, 1}, "in no file that is known"}};
  EXPECT_EQ(rendering.text(),
            "error[W0301]: expected force, found energy\n"
            "  --> library/fabric/corduroy.wale:1:9\n"
            "   |\n"
            " 1 | force = k\n"
            "   |         ^\n"
            "  ::: library/levels.wale:3:5\n"
            "   |\n"
            " 3 | let k = 3 mm\n"
            "   |     - declared here\n");
}

TEST(Rendering, NotesStandInTheOrderCauseRuleProposal) {
  Rendering rendering("force = k\n", "k");
  rendering.diagnostic.help = "write `k * x`";
  rendering.diagnostic.rule = "forces are in newtons";
  rendering.diagnostic.cause = "`k` is a stiffness";
  rendering.diagnostic.found = "N/m";
  EXPECT_TRUE(
      rendering.text().ends_with("   = found     N/m\n"
                                 "   = cause: `k` is a stiffness\n"
                                 "   = rule: forces are in newtons\n"
                                 "   = help: write `k * x`\n"))
      << rendering.text();
}

TEST(Rendering, JsonHasSpansFactsAndFixes) {
  Rendering rendering("a\nµ force = k\n", "force");
  rendering.diagnostic.label = "here";
  rendering.diagnostic.cause = "why";
  rendering.diagnostic.rule = "which";
  rendering.diagnostic.secondary = {{{0, 0, 1}, "first"}};
  rendering.diagnostic.facts = {
      {"limit", NumberWithUnit{4, "MB"}}, {"name", std::string("k")}, {"declared", Span{0, 0, 1}}};
  rendering.diagnostic.fixes = {{"write `b`", {{{0, 0, 1}, "b"}, {{0, 5, 5}, "\n"}}, true}};
  Diagnostics diagnostics;
  diagnostics.report(rendering.diagnostic);
  const auto only = nlohmann::json::parse(render_json(diagnostics, rendering.sources)).at(0);
  EXPECT_EQ(only["begin_byte"], 5);
  EXPECT_EQ(only["end_byte"], 10);
  EXPECT_EQ(only["label"], "here");
  EXPECT_EQ(only["cause"], "why");
  EXPECT_EQ(only["rule"], "which");
  EXPECT_EQ(only["secondary"],
            nlohmann::json::parse(R"([{"file": "library/fabric/corduroy.wale", "line": 1, "column": 1,
    "end_line": 1, "end_column": 2, "begin_byte": 0, "end_byte": 1, "label": "first"}])"));
  EXPECT_EQ(only["facts"][0], nlohmann::json::parse(R"({"name": "limit", "value": 4.0, "unit": "MB"})"));
  EXPECT_EQ(only["facts"][1], nlohmann::json::parse(R"({"name": "name", "text": "k"})"));
  EXPECT_EQ(only["facts"][2]["end_byte"], 1);
  const auto& fix = only["fixes"].at(0);
  EXPECT_EQ(fix["title"], "write `b`");
  EXPECT_EQ(fix["safe"], true);
  EXPECT_EQ(fix["edits"].at(1)["begin_byte"], 5);
  EXPECT_EQ(fix["edits"].at(1)["line"], 2);
  EXPECT_EQ(fix["edits"].at(1)["column"], 3);
  EXPECT_EQ(fix["edits"].at(1)["replacement"], "\n");
}

TEST(Diagnostics, RepeatNothingAndStopAtAThousandErrors) {
  Diagnostics diagnostics;
  const Diagnostic once{.code = Code::unknown_name, .span = {0, 1, 2}, .message = "what"};
  for (int i = 0; i < 3; ++i) diagnostics.report(once);
  EXPECT_EQ(diagnostics.all().size(), 1u);
  for (std::uint32_t i = 0; i < 5000; ++i)
    diagnostics.report({.code = Code::unknown_name, .span = {0, i, i}, .message = "what"});
  EXPECT_EQ(diagnostics.error_count(), 1000u);
  EXPECT_TRUE(diagnostics.is_full());
}

TEST(Rendering, WithoutAPlaceHasNoLine) {
  Diagnostics diagnostics;
  diagnostics.report({Code::unknown_device, {}, "no device is called `tablet`", {}, {}, {}, "see `wale devices`"});
  EXPECT_EQ(render_text(diagnostics.all()[0], SourceSet(), false),
            "error[W0601]: no device is called `tablet`\n   = help: see `wale devices`\n");
  EXPECT_FALSE(nlohmann::json::parse(render_json(diagnostics, SourceSet()))[0].contains("line"));
}

TEST(Codes, AreNumbersThatNeverChange) {
  EXPECT_EQ(code_name(Code::unexpected_character), "W0101");
  EXPECT_EQ(code_name(Code::nested_too_deep), "W0108");
  EXPECT_EQ(code_name(Code::program_too_large), "W0603");
  EXPECT_EQ(code_title(Code::unterminated_text), "a text or comment that does not end");
  EXPECT_EQ(severity_of(Code::unused_name), Severity::warning);
}

TEST(Places, CountLinesAndCharactersFromOne) {
  SourceSet sources;
  const SourceId id = sources.add("a", "aµ\r\nb\n");
  const auto place = [&](std::uint32_t at) {
    const LineColumn found = sources.place({id, at, at});
    return std::pair(found.line, found.column);
  };
  EXPECT_EQ(place(0), std::pair(1u, 1u));
  EXPECT_EQ(place(3), std::pair(1u, 3u));
  EXPECT_EQ(place(5), std::pair(2u, 1u));
  EXPECT_EQ(place(7), std::pair(3u, 1u));
  EXPECT_EQ(place(99), std::pair(3u, 1u));  // beyond the end is the end
  EXPECT_EQ(sources.line({id, 1, 2}), "aµ");
  EXPECT_EQ(sources.line({id, 7, 7}), "");
  EXPECT_EQ(sources.text({id, 5, 99}), "b\n");
}

}  // namespace
}  // namespace wale::rendering_test
