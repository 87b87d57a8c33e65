// Workspaces as they are checked and laid out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compiler/compile_workspace.hpp"
#include "compiler/diagnostics/render.hpp"

namespace wale::workspaces_test {
namespace {

/// The errors of a text, checked.
std::vector<std::string> errors_of(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  check_source(sources, sources.add("test.wale", text), *resolver, diagnostics);
  std::vector<std::string> errors;
  for (const auto& each : diagnostics.all()) errors.push_back(each.message);
  return errors;
}

/// A checked text, which has no errors, and the workspaces in it.
struct Checked {
  SourceSet sources;
  Diagnostics diagnostics;
  std::unique_ptr<Resolver> resolver = file_resolver({});
  SourceId source;
  CheckedModule module;

  explicit Checked(const std::string& text) : source(sources.add("test.wale", text)) {
    module = check_source(sources, source, *resolver, diagnostics);
    for (const auto& each : diagnostics.all()) ADD_FAILURE() << render_text(each, sources, false);
  }
  const CheckedPatch& patch(std::size_t i = 0) const { return module.workspaces.at(0).patches.at(i); }
  std::vector<LaidPatch> laid(Diagnostics& said) const {
    auto result = compile_workspace(module.workspaces.at(0), module, default_device, sources, source, *resolver, said);
    EXPECT_TRUE(result);
    return result ? *result : std::vector<LaidPatch>{};
  }
};

std::string desk(const std::string& patches) { return "wale 1\nworkspace desk {\n" + patches + "\n}\n"; }

TEST(Workspaces, HavePlacesSizesAndMaterials) {
  const Checked checked(
      desk("patch board = oak { at -50 mm, 2 cm; size 80 mm, 60 mm; rim 2 mm }\n"
           "patch cloth = denim(roughness: 0.3) { size 60 mm, 0.09 m; shape ellipse }\n"
           "patch plain = \"jeans\""));
  EXPECT_EQ(checked.module.workspaces.at(0).name, "desk");
  EXPECT_NEAR(checked.patch(0).at[0], -0.05, 1e-12);
  EXPECT_NEAR(checked.patch(0).at[1], 0.02, 1e-12);
  EXPECT_NEAR((*checked.patch(0).size)[0], 0.08, 1e-12);
  EXPECT_NEAR((*checked.patch(0).size)[1], 0.06, 1e-12);
  EXPECT_NEAR(*checked.patch(0).rim, 0.002, 1e-12);
  EXPECT_EQ(checked.patch(0).name, "board");
  EXPECT_EQ(checked.patch(0).made_of, "oak");
  EXPECT_TRUE(std::holds_alternative<EllipseOutline>(checked.patch(1).outline));
  EXPECT_EQ(checked.patch(1).material->percepts.at(0).level, 0.3);
  EXPECT_FALSE(checked.patch(2).size);
  EXPECT_EQ(checked.patch(2).at, (std::array{0.0, 0.0}));
}

TEST(Workspaces, TakeMaterialsOfTheFileByTheirNamesAlsoAsNamesOfPatches) {
  const Checked checked(
      "wale 1\nmaterial board {\n  representative { called \"chopping board\" }\n  perceptual { roughness 0.4 }\n}\n"
      "workspace desk {\n  patch board = board\n  patch other = \"chopping board\"\n}\n");
  EXPECT_EQ(checked.patch(0).material->percepts.at(0).level, 0.4);
  EXPECT_EQ(checked.patch(1).material->percepts.at(0).level, 0.4);
}

TEST(Workspaces, MarksAreInTheSlidersUnits) {
  const Checked checked(
      desk("patch a = oak {\n  mark line, low 2 mm, high 0.5 cm\n  mark smoothness, low 0.6, \"smooth\"\n"
           "  mark roughness, high coarse\n}"));
  const auto& marks = checked.patch().marks;
  ASSERT_EQ(marks.size(), 3u);
  EXPECT_EQ(marks[0].slider, "line");
  EXPECT_EQ(marks[0].unit, "mm");
  EXPECT_NEAR(*marks[0].low, 2e-3, 1e-12);
  EXPECT_NEAR(*marks[0].high, 5e-3, 1e-12);
  EXPECT_EQ(marks[2].slider, "roughness");
  EXPECT_TRUE(marks[2].is_percept);
  EXPECT_FALSE(marks[2].low);
}

TEST(Workspaces, APolygonGivesTheSizeAroundTheCentre) {
  const Checked checked(desk("patch a = oak { shape polygon(-20 mm, -10 mm, 30 mm, -10 mm, 0 mm, 25 mm) }"));
  EXPECT_NEAR((*checked.patch().size)[0], 0.06, 1e-12);
  EXPECT_NEAR((*checked.patch().size)[1], 0.05, 1e-12);
  EXPECT_EQ(std::get<PolygonOutline>(checked.patch().outline).corners.size(), 3u);
}

TEST(Workspaces, PatchesOfOneMaterialAndSizeShareAProgram) {
  const Checked checked(
      desk("patch a = oak { at -30 mm, 0 mm; size 40 mm, 40 mm }\npatch b = oak { at 30 mm, 0 mm; size 40 mm, 40 mm }\n"
           "patch c = oak { size 40 mm, 30 mm; rim 0 mm }"));
  Diagnostics said;
  const auto laid = checked.laid(said);
  ASSERT_EQ(laid.size(), 3u);
  EXPECT_EQ(laid[0].program, laid[1].program);
  EXPECT_NE(laid[0].program, laid[2].program);
  EXPECT_NEAR(laid[2].size.height, 0.03, 1e-6);
  EXPECT_NEAR(laid[0].size.rim, 1e-3, 1e-9);  // usual between neighbours
  EXPECT_EQ(laid[2].size.rim, 0);
  EXPECT_TRUE(said.all().empty());
}

TEST(Workspaces, OnlyAMaterialIsCalledByAText) {
  EXPECT_EQ(errors_of("wale 1\nlet a = \"sin\"(1)\n"), std::vector<std::string>{"a text is no function"});
  EXPECT_EQ(errors_of("wale 1\nmaterial a { representative { title \"b\"(1) }; perceptual { roughness 0.4 } }\n"),
            std::vector<std::string>{"`title` takes texts in quotes"});
  EXPECT_EQ(errors_of(desk("patch a = \"denim\"(rougness: 0.3)")),
            std::vector<std::string>{"`denim` has no parameter `rougness`"});
  EXPECT_EQ(errors_of(desk("patch a = \"dennim\"(roughness: 0.3)")),
            std::vector<std::string>{"no material is called `dennim`"});
  EXPECT_EQ(errors_of(desk("patch a = oak { shape \"mask\"(\"a.png\", scale: 1 mm/px) }")),
            std::vector<std::string>{"expected a shape"});
}

TEST(Workspaces, AreShownInMoviesByKeysAndInGroups) {
  const std::string two = "wale 1\nworkspace kitchen { patch board = oak; patch cloth = denim }\nworkspace hall { }\n";
  const Checked checked(two +
                        "/// First one, then the other.\nmovie demo { frames kitchen, hall; frames kitchen }\n"
                        "keys sorting { of kitchen; area 80 mm, 6 cm; at 10 mm, -20 mm; key 25 mm; labels random }\n"
                        "groups sorted { of kitchen; group board, \"hard\"; group cloth }\n");
  const CheckedMovie& movie = checked.module.movies.at(0);
  EXPECT_EQ(movie.documentation, "First one, then the other.");
  ASSERT_EQ(movie.frames.size(), 3u);
  EXPECT_EQ(movie.frames[1].name, "hall");
  const CheckedKeys& keys = checked.module.keys.at(0);
  EXPECT_EQ(keys.workspace.name, "kitchen");
  EXPECT_NEAR(keys.area[1], 0.06, 1e-12);
  EXPECT_NEAR(keys.at[1], -0.02, 1e-12);
  EXPECT_NEAR(*keys.key, 0.025, 1e-12);
  EXPECT_TRUE(keys.numbered_at_random);
  const CheckedGroups& groups = checked.module.groups.at(0);
  ASSERT_EQ(groups.groups.size(), 2u);
  EXPECT_EQ(groups.groups[0].says, "hard");
  EXPECT_EQ(groups.groups[1].patches.at(0).name, "cloth");
  for (const auto& [declared, message] : std::vector<std::pair<std::string, std::string>>{
           {"movie a { frames kitchn }", "this file has no workspace `kitchn`"},
           {"movie a { }", "the movie `a` lacks `frames`"},
           {"movie a { frames hall }\nmovie a { frames hall }", "there are two movies `a`"},
           {"movie a { frames hall; speed 2 }", "a movie has no setting `speed`"},
           {"keys a { of kitchen }", "the keys `a` lacks `area`"},
           {"keys a { of kitchen; area 0 mm, 80 mm }", "the sides of the `area` must be greater than zero"},
           {"keys a { of kitchen; area 80 mm, 80 mm; labels big }",
            "the labels of keys are `names` or `random` numbers"},
           {"groups a { of kitchen; group board, board }", "`board` is in two groups"},
           {"groups a { of kitchen; group bord }", "`kitchen` has no patch `bord`"},
           {"groups a { group board }", "the groups `a` lacks `of`"}})
    EXPECT_EQ(errors_of(two + declared + "\n"), std::vector<std::string>{message}) << declared;
}

/// The workspace of sandpaper is a disc, 228.6 mm across.
TEST(Workspaces, TheReachIsThatOfTheOutline) {
  const double radius = 114.3;
  // An ellipse 60 mm wide touches the edge at 114.3 - 30 mm to the right; the corners of a rectangle are beyond.
  const std::string place = fmt::format("at {} mm, 0 mm; size 60 mm, 60 mm", radius - 30.01);
  for (const auto& [shape, reaches] : {std::pair{"ellipse", true}, {"rectangle", false}}) {
    const Checked checked(desk("patch a = denim { " + place + "; shape " + shape + " }"));
    Diagnostics said;
    checked.laid(said);
    EXPECT_EQ(said.all().empty(), reaches) << shape;
    if (said.all().empty()) continue;
    EXPECT_EQ(said.all().front().code, Code::beyond_reach);
    // The rectangle fits where its right corners, 30 mm up and down, are on the edge.
    const double fits = std::sqrt(radius * radius - 30 * 30) - 30;
    const std::string proposed = fmt::format("`at {:.1f} mm, 0 mm`", std::floor(fits * 10) / 10);
    EXPECT_NE(said.all().front().help.find(proposed), std::string::npos) << said.all().front().help << proposed;
  }
}

TEST(Workspaces, OverlapIsNoError) {
  EXPECT_EQ(errors_of(desk("patch a = oak { size 40 mm, 40 mm }\npatch b = denim { size 40 mm, 40 mm }")),
            std::vector<std::string>{});
}

}  // namespace
}  // namespace wale::workspaces_test
