#include <gtest/gtest.h>

#include "tests/language/reading.hpp"

namespace {

using Errors = std::vector<std::string>;

TEST(Recovery, EveryStatementReportsItsOwnErrorOnce) {
  const Reading reading(
      "wale 1\n"
      "material m {\n"
      "  perceptual {\n"
      "    roughness = 0.6\n"
      "    stickiness\n"
      "  }\n"
      "  physical {\n"
      "    param a 0.5 in 0 .. 1\n"
      "    height ribs grating(x)\n"
      "    let b = 2 sin(x)\n"
      "    let c =\n"
      "    let d = (a + b\n"
      "    let e = f(a,\n"
      "      2 mm 3,\n"
      "      b)\n"
      "    let g = if a < 3 then 2\n"
      "    h = 3\n"
      "    force = b @ c ) ( d\n"
      "  }\n"
      "}\n"
      "force = 3\n"
      "material n { physical { force = lateral(x) } }\n");
  EXPECT_EQ(reading.errors(), (Errors{
                                  "W0103 4:15 a percept's level has no `=` before it",
                                  "W0103 5:15 expected a level after `stickiness`",
                                  "W0103 8:13 expected `=` after `a`",
                                  "W0103 9:17 expected `=` after `ribs`",
                                  "W0103 10:15 expected the end of the line after `2`",
                                  "W0103 11:12 expected a value after `=`",
                                  "W0103 12:19 expected `)` after `b`",
                                  "W0103 14:12 expected `,` or `)` after `mm`",
                                  "W0103 16:28 expected `else` after `2`",
                                  "W0103 17:5 the definition of `h` lacks its keyword",
                                  "W0101 18:15 Wale does not use the character `@`",
                                  "W0103 21:1 no declaration begins with `force`",
                              }));
  // The tree has everything that could be read, and names with a wrong definition are defined.
  EXPECT_EQ(reading.printed(),
            "(material m\n"
            "  (perceptual\n"
            "    (roughness 0.6)\n"
            "    (stickiness <error>))\n"
            "  (physical\n"
            "    (param a 0.5 (in 0 1))\n"
            "    (height ribs (grating x))\n"
            "    (let b <error>)\n"
            "    (let c <error>)\n"
            "    (let d <error>)\n"
            "    (let e <error>)\n"
            "    (let g <error>)\n"
            "    (let h 3)\n"
            "    (force <error>)))\n"
            "(material n\n"
            "  (physical\n"
            "    (force (lateral x))))\n");
}

TEST(Recovery, AMissingBraceIsReportedAtTheNextBlockAndNamesItsPartner) {
  const Reading reading(
      "wale 1\n"
      "material a {\n"
      "  physical {\n"
      "    force = x\n"
      "  }\n"
      "material b {\n"
      "  perceptual {\n"
      "    roughness 0.5\n"
      "  physical { force = x }\n"
      "}\n"
      "material c { physical {");
  EXPECT_EQ(reading.errors(),
            (Errors{"W0103 6:1 expected `}` before `material`", "W0103 9:3 expected `}` before `physical`",
                    "W0103 11:24 expected `}` before the end of the file"}));
  EXPECT_EQ(reading.diagnostics.all()[0].help, "close the `{` after `a` in line 2, column 12");
  EXPECT_EQ(reading.diagnostics.all()[1].help, "close the `{` after `perceptual` in line 7, column 14");
  EXPECT_EQ(reading.tree.declarations.size(), 3u);
}

TEST(Recovery, AMisspeltWordIsReadAsTheNearestOne) {
  const Reading reading("wale 1\nmateriall m { physicl { heigt h = x; force = lateral(h) } }\n");
  EXPECT_EQ(reading.errors(),
            (Errors{"W0103 2:1 no declaration begins with `materiall`", "W0103 2:15 a material has no `physicl`",
                    "W0103 2:25 no statement begins with `heigt`"}));
  for (const auto& each : reading.diagnostics.all()) {
    EXPECT_TRUE(each.help.starts_with("did you mean")) << each.help;
    ASSERT_EQ(each.facts.size(), 1u);
    EXPECT_EQ(each.facts[0].name, "meant");
  }
  EXPECT_EQ(std::get<std::string>(reading.diagnostics.all()[0].facts[0].value), "material");
  EXPECT_EQ(reading.printed(), "(material m\n  (physical\n    (height h x)\n    (force (lateral h))))\n");
}

TEST(Recovery, AnUnknownBlockIsSkippedWhole) {
  const Reading reading("wale 1\nthing foo { a { b } c }\nlet d = 1\n");
  EXPECT_EQ(reading.errors(), (Errors{"W0103 2:1 no declaration begins with `thing`"}));
  EXPECT_EQ(reading.printed(), "(let d 1)\n");
}

TEST(Recovery, StatementsOutsideTheirSectionAreReportedTogether) {
  const Reading reading("wale 1\nmaterial m {\n  param k = 1 N/m\n  force = k * x\n}\n");
  EXPECT_EQ(reading.errors(), (Errors{"W0103 3:3 `param` is outside the sections of the material"}));
  EXPECT_EQ(reading.diagnostics.all()[0].help, "put it into `physical { … }`");
  EXPECT_EQ(reading.printed(), "(material m\n  (physical\n    (param k [1 N/m])\n    (force (* k x))))\n");
}

TEST(Recovery, ErrorsComeInTheOrderOfTheText) {
  const Reading reading("wale 1\nlet a b\nlet c = @\nlet d e\n");
  EXPECT_EQ(reading.errors(),
            (Errors{"W0103 2:7 expected `=` after `a`", "W0101 3:9 Wale does not use the character `@`",
                    "W0103 4:7 expected `=` after `d`"}));
}

TEST(Mends, SayWhatToWriteInstead) {
  const struct {
    const char *statement, *help;
  } cases[] = {
      {"let a = 2 sin(x)", "to multiply, write `2 * sin(…)`"},
      {"let a = k hand", "to multiply, write `k * hand`"},
      {"let a = k height", "to multiply, write `k * height`"},
      {"force = steady() active 1 W", "put `active` on a line of its own"},
      {"let a = 2 (k + 1)", "to multiply, write `2 * (…)`"},
      {"let a = 2,5 * k", "write decimals with a point: `2.5`"},
      {"let a = f(x, p: 2,5 mm)", "write decimals with a point: `2.5`"},
      {"let a = b < c < d", "comparisons cannot be chained; join two of them with `and`"},
      {"let a = [1, 2]", "write vectors as `vector(a, b)`"},
      {"let a = (1, 2)", "write vectors as `vector(a, b)`"},
      {"let a = if b = c then 1 else 2", "`=` defines; compare values with `<`, `<=`, `>` and `>=`"},
      {"let a = 3)", "it closes no `(`; remove it"},
      {"let a = (3", "close the `(` in line 4, column 9"},
      {"let a = 0.5 ± 0.1", "a tolerance belongs to a percept; to subtract, write `-`"},
      {"let in = 3", "call the value something else"},
      {"let 2x = 3", "names must begin with a letter"},
      {"let \"a\" = 3", "write names without quotes"},
      {"height ribs grating(x)", "write `height ribs = …`"},
      {"param k 3", "write `param k = …`"},
      {"patch = 3 mm", "write `patch 3 mm`"},
      {"q = 3", "write `let q = …`"},
      {"fource = 3", "did you mean `force`?"},
      {"* 3", "to continue on the next line, end the line above with the operator"},
      {"let a = 5 mm^b", "if `mm` is not a unit, write `* mm^…`"},
  };
  for (const auto& each : cases) {
    const Reading reading("wale 1\nmaterial m {\nphysical {\n" + std::string(each.statement) + "\n} }\n");
    ASSERT_EQ(reading.diagnostics.all().size(), 1u) << each.statement;
    EXPECT_EQ(reading.diagnostics.all()[0].help, each.help) << each.statement;
  }
}

TEST(Version, StandsAtTheHead) {
  EXPECT_EQ(Reading("wale 1; let a = 1").errors(), Errors{});
  EXPECT_EQ(Reading("\n// comment\nwale 1\n").errors(), Errors{});
  EXPECT_EQ(Reading("").errors(), (Errors{"W0104 1:1 the file does not begin with its version"}));
  EXPECT_EQ(Reading("let a = 1\n").errors(), (Errors{"W0104 1:1 the file does not begin with its version"}));
  EXPECT_EQ(Reading("let a = 1\n").printed(), "(let a 1)\n");
  EXPECT_EQ(Reading("wale\nlet a = 1\n").printed(), "(let a 1)\n");
  EXPECT_EQ(Reading("wale 0\n").errors(), (Errors{"W0104 1:1 there is no version 0 of Wale"}));
  EXPECT_EQ(Reading("let a = 1\n").diagnostics.all()[0].help, "write `wale 1` in a line above everything else");
}

TEST(Version, ANewerFileIsNotParsed) {
  const Reading reading("wale 2\nnew ¬ syntax { (\n");
  EXPECT_EQ(reading.errors(), (Errors{"W0105 1:1 this file is written in wale 2"}));
  EXPECT_TRUE(reading.tree.declarations.empty());
}

}  // namespace
