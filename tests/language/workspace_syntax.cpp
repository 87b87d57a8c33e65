// Workspaces as they are read, printed and formatted.
#include <gtest/gtest.h>

#include "compiler/diagnostics/render.hpp"
#include "compiler/format/format.hpp"
#include "tests/language/reading.hpp"

namespace wale::workspace_syntax_test {
namespace {

/// The workspace of the issue, as people write it.
constexpr const char* kitchen =
    "wale 1\n"
    "/// What lies on the table.\n"
    "workspace kitchen {\n"
    "  patch board = oak { at -50 mm, 20 mm; size 80 mm, 60 mm }\n"
    "  /// Worn.\n"
    "  patch cloth = denim(roughness: 0.3)\n"
    "  {\n"
    "    at 40 mm, 0 mm; size 60 mm, 90 mm; shape ellipse\n"
    "    mark roughness, low 0.2, high 0.45, \"still denim\"\n"
    "  }\n"
    "  patch plain = 0.7 oak + 0.3 denim\n"
    "  patch river = \"wet glass\" { shape mask(\"river.png\", scale: 0.5 mm/px) }\n"
    "  patches from picture(\"map.png\", scale: 0.3 mm/px) { colour \"#c04020\" = brick; colour \"#2060c0\" = oil }\n"
    "}\n";

std::string formatted_workspace(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto result = format(sources, sources.add("test.wale", text), diagnostics);
  if (result) return *result;
  std::string errors;
  for (const auto& each : diagnostics.all()) errors += render_text(each, sources, false);
  return errors;
}

std::string desk(const std::string& patches) { return "wale 1\nworkspace desk {\n" + patches + "\n}\n"; }

TEST(WorkspaceSyntax, AreReadWithTheirPatches) {
  EXPECT_EQ(Reading(kitchen).printed(),
            "(documented \"What lies on the table.\") (workspace kitchen\n"
            "  (patch board = oak\n"
            "    (at (- [50 mm]) [20 mm])\n"
            "    (size [80 mm] [60 mm]))\n"
            "  (documented \"Worn.\") (patch cloth = (denim roughness: 0.3)\n"
            "    (at [40 mm] [0 mm])\n"
            "    (size [60 mm] [90 mm])\n"
            "    (shape ellipse)\n"
            "    (mark roughness {low 0.2} {high 0.45} \"still denim\"))\n"
            "  (patch plain = (+ [0.7 oak] [0.3 denim]))\n"
            "  (patch river = \"wet glass\"\n"
            "    (shape (mask \"river.png\" scale: [0.5 mm/px])))\n"
            "  (patches from (picture \"map.png\" scale: [0.3 mm/px])\n"
            "    (colour {\"#c04020\" = brick})\n"
            "    (colour {\"#2060c0\" = oil})))\n");
}

TEST(WorkspaceSyntax, AreFormattedAndNothingIsLost) {
  const std::string expected =
      "wale 1\n"
      "/// What lies on the table.\n"
      "workspace kitchen {\n"
      "  patch board = oak {\n"
      "    at   -50 mm, 20 mm\n"
      "    size 80 mm, 60 mm\n"
      "  }\n"
      "  /// Worn.\n"
      "  patch cloth = denim(roughness: 0.3) {\n"
      "    at    40 mm, 0 mm\n"
      "    size  60 mm, 90 mm\n"
      "    shape ellipse\n"
      "    mark  roughness, low 0.2, high 0.45, \"still denim\"\n"
      "  }\n"
      "  patch plain = 0.7 oak + 0.3 denim\n"
      "  patch river = \"wet glass\" { shape mask(\"river.png\", scale: 0.5 mm/px) }\n"
      "  patches from picture(\"map.png\", scale: 0.3 mm/px) {\n"
      "    colour \"#c04020\" = brick\n"
      "    colour \"#2060c0\" = oil\n"
      "  }\n"
      "}\n";
  EXPECT_EQ(formatted_workspace(kitchen), expected);
  EXPECT_EQ(formatted_workspace(expected), expected);
  EXPECT_EQ(Reading(expected).printed(), Reading(kitchen).printed());
}

TEST(WorkspaceSyntax, ATitleInQuotesTakesArguments) {
  const std::string written =
      "wale 1\n"
      "material damp = \"wet glass\"(roughness: 0.3)\n"
      "workspace desk {\n"
      "  patch a = 0.5 oak + 0.3 * \"wet glass\"(roughness: 0.3)\n"
      "  patch b = between(\"wet glass\", \"wet glass\"(roughness: 0.9), 0.5) { at 40 mm, 0 mm }\n"
      "  patches from picture(\"map.png\", scale: 0.3 mm/px) {\n"
      "    colour \"#c04020\" = \"wet glass\"(roughness: 0.3)\n"
      "  }\n"
      "}\n";
  EXPECT_EQ(Reading(written).printed(),
            "(material damp = (\"wet glass\" roughness: 0.3))\n"
            "(workspace desk\n"
            "  (patch a = (+ [0.5 oak] (* 0.3 (\"wet glass\" roughness: 0.3))))\n"
            "  (patch b = (between \"wet glass\" (\"wet glass\" roughness: 0.9) 0.5)\n"
            "    (at [40 mm] [0 mm]))\n"
            "  (patches from (picture \"map.png\" scale: [0.3 mm/px])\n"
            "    (colour {\"#c04020\" = (\"wet glass\" roughness: 0.3)})))\n");
  EXPECT_EQ(formatted_workspace(written), written);
}

TEST(WorkspaceSyntax, MoviesKeysAndGroupsAreRecords) {
  const std::string written =
      "wale 1\n"
      "/// In this order.\n"
      "movie demo { frames kitchen, workshop }\n"
      "keys sorting {\n"
      "  of     kitchen\n"
      "  area   80 mm, 80 mm\n"
      "  labels random\n"
      "}\n"
      "groups sorted {\n"
      "  of    kitchen\n"
      "  group board, cloth, \"rough\"\n"
      "  group steel\n"
      "}\n";
  EXPECT_EQ(formatted_workspace(written), written);
  EXPECT_EQ(Reading("wale 1\nexport movie demo { frames kitchen }\n").errors(),
            std::vector<std::string>{"W0103 2:1 a movie cannot be exported: no other file names it"});
}

TEST(WorkspaceSyntax, AnUnclosedPatchIsOneError) {
  const Reading reading(desk("  patch a = oak { at 0 mm, 0 mm\n  patch b = oak\n"));
  EXPECT_EQ(reading.errors(), std::vector<std::string>{"W0103 4:3 expected `}` before `patch`"});
  EXPECT_EQ(Reading(desk("  pach a = oak\n  b = oak\n")).errors(),
            (std::vector<std::string>{"W0103 3:3 nothing in a workspace begins with `pach`",
                                      "W0103 4:3 nothing in a workspace begins with `b`"}));
}

}  // namespace
}  // namespace wale::workspace_syntax_test
