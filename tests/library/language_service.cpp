// What an editor and a window need of a text: colours, proposals, problems with mends, layouts, the catalogue.
#include "wale/language_service.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <set>

#include "wale/catalogue.hpp"
#include "wale/patch_program.hpp"

namespace wale::language_service_test {
namespace {

const LanguageService& service() {
  static const LanguageService one;
  return one;
}

std::vector<std::string> proposed(const std::string& text) {
  std::vector<std::string> words;
  for (const Proposal& each : service().proposals(text, text.size()).words) words.push_back(each.text);
  return words;
}

bool proposes(const std::string& text, const std::string& word) {
  return std::ranges::count(proposed(text), word) == 1;
}

TEST(LanguageService, ColoursEachWordByWhatItIs) {
  const std::string text = "wale 1\n/// told\nmaterial a { // why\n physical { force = 120 N/m * hand \"t\" }\n}\n";
  std::vector<std::pair<std::string, WordKind>> found;
  for (const ColouredWord& each : coloured_words(text))
    found.emplace_back(text.substr(each.begin, each.end - each.begin), each.kind);
  using K = WordKind;
  const std::vector<std::pair<std::string, WordKind>> expected = {
      {"wale", K::keyword},     {"1", K::number},         {"/// told", K::documentation},
      {"material", K::keyword}, {"a", K::name},           {"{", K::symbol},
      {"// why", K::comment},   {"physical", K::keyword}, {"{", K::symbol},
      {"force", K::keyword},    {"=", K::symbol},         {"120", K::number},
      {"N", K::unit},           {"/", K::symbol},         {"m", K::unit},
      {"*", K::symbol},         {"hand", K::name},        {"\"t\"", K::text},
      {"}", K::symbol},         {"}", K::symbol}};
  EXPECT_EQ(found, expected);
}

TEST(LanguageService, AnyBytesAreSafe) {
  std::mt19937 random(19);
  const std::string pieces[] = {
      "wale 1\n",           "material a {",  "}", "physical {", "\"", "//", "/*", "*/",           "5 mm", "\xc3", "\0x",
      "patch b = oak { at", "workspace w {", "é", "\n",         "..", "(",  ")",  "patches from", "///"};
  for (int i = 0; i < 1500; ++i) {
    std::string text;
    for (unsigned n = random() % 14; n > 0; --n) text += pieces[random() % std::size(pieces)];
    std::size_t behind = 0;
    for (const ColouredWord& each : coloured_words(text)) {
      EXPECT_LE(behind, each.begin);
      EXPECT_LT(each.begin, each.end);
      behind = each.end;
    }
    EXPECT_LE(behind, text.size());
    const std::size_t at = random() % (text.size() + 1);
    const Proposals found = service().proposals(text, at);
    EXPECT_LE(found.begin, found.end);
    EXPECT_EQ(found.end, at);
    for (const Problem& each : service().check(text).problems) {
      EXPECT_LE(each.begin, each.end);
      EXPECT_LE(each.end, text.size());
    }
  }
}

TEST(LanguageService, ProposesWhatMayStandThere) {
  EXPECT_TRUE(proposes("wale 1\nmat", "material"));
  EXPECT_TRUE(proposes("wale 1\nmaterial a { perceptual { rough", "roughness"));
  EXPECT_TRUE(proposes("wale 1\nmaterial a { perceptual { roughness co", "coarse"));
  EXPECT_TRUE(proposes("wale 1\nmaterial a { physical { param k = 5 m", "mm"));
  EXPECT_TRUE(proposes("wale 1\nmaterial a { physical { param k = 5m", "mm"));
  EXPECT_TRUE(proposes("wale 1\nmaterial a { physical { param springy = 5 mm\n force = vector(spr", "springy"));
  EXPECT_TRUE(proposes("wale 1\nmaterial a { physical { force = lat", "lateral"));
  EXPECT_TRUE(proposes("wale 1\nworkspace w { patch a = den", "denim"));
  EXPECT_TRUE(proposes("wale 1\nworkspace w { patch a = denim { sh", "shape"));
  EXPECT_TRUE(proposes("wale 1\nworkspace w { patch a = denim { shape el", "ellipse"));
  EXPECT_TRUE(proposed("wale 1\n// mat").empty());                                         // a comment
  EXPECT_TRUE(proposed("wale 1\nmaterial a { representative { title \"mat").empty());      // a text
  EXPECT_FALSE(proposes("wale 1\nmaterial a { physical { param k = 5 m", "material"));
}

/// Applying the first mend of a problem leaves fewer problems.
TEST(LanguageService, MendsAreEditsOfTheText) {
  const std::string text = "wale 1\nmaterial a { perceptual { roughnes 0.6 } }\n";
  const auto checked = service().check(text);
  ASSERT_TRUE(checked.has_errors());
  ASSERT_FALSE(checked.problems.front().fixes.empty());
  EXPECT_EQ(text.substr(checked.problems.front().begin, checked.problems.front().end - checked.problems.front().begin),
            "roughnes");
  std::string mended = text;
  for (const TextEdit& each : checked.problems.front().fixes.front().edits)
    mended.replace(each.begin, each.end - each.begin, each.replacement);
  EXPECT_FALSE(service().check(mended).has_errors()) << mended;
}

/// Layouts by chance are the same after they were written and read.
TEST(LanguageService, ALayoutIsReadAsItWasWritten) {
  std::mt19937 random(7);
  const auto chance = [&](int in) { return static_cast<int>(random() % in); };
  for (int i = 0; i < 60; ++i) {
    Layout layout{.name = "table_" + std::to_string(i)};
    if (chance(2) == 0) layout.documentation = "What lies here.\nAnd there.";
    for (int n = chance(6); n >= 0; --n) {
      LaidOutPatch patch{.name = "p" + std::to_string(n), .made_of = chance(2) ? "oak" : "denim(roughness: 0.3)"};
      patch.at = {(chance(2001) - 1000) / 1e5, (chance(2001) - 1000) / 1e5};
      if (chance(3)) patch.size = glm::dvec2((1 + chance(900)) / 1e4 + 0.01, (1 + chance(900)) / 1e4 + 0.01);
      if (chance(4) == 0) patch.shape = "ellipse";
      else if (chance(4) == 0) patch.shape = "polygon(0 mm, 0 mm, 20 mm, 0 mm, 0 mm, 30 mm)", patch.size.reset();
      if (chance(4) == 0) patch.rim = 0.0005;
      if (chance(4) == 0) patch.before = "// before\n";
      if (chance(4) == 0) patch.inside = "// inside\n";
      layout.patches.push_back(patch);
    }
    if (chance(3) == 0) layout.trailing = "// at the end\n";
    const std::string text = "wale 1\n\n" + layout_text(layout) + "\n";
    const auto checked = service().check(text);
    EXPECT_FALSE(checked.has_errors()) << text;
    ASSERT_EQ(checked.layouts.size(), 1u) << text;
    const Layout& again = checked.layouts.front();
    ASSERT_EQ(again.patches.size(), layout.patches.size()) << text;
    EXPECT_EQ(again.documentation, layout.documentation);
    EXPECT_EQ(again.trailing, layout.trailing) << text;
    EXPECT_EQ(text.substr(0, again.begin) + layout_text(again) + text.substr(again.end), text);
    for (std::size_t n = 0; n < layout.patches.size(); ++n) {
      const LaidOutPatch &one = layout.patches[n], &other = again.patches[n];
      EXPECT_EQ(one.name, other.name);
      EXPECT_EQ(one.made_of, other.made_of);
      EXPECT_NEAR(one.at.x, other.at.x, 1e-9);
      EXPECT_NEAR(one.at.y, other.at.y, 1e-9);
      EXPECT_EQ(one.size.has_value(), other.size.has_value()) << text;
      if (one.size && other.size) {
        EXPECT_NEAR(one.size->x, other.size->x, 1e-9);
      }
      EXPECT_EQ(one.shape, other.shape);
      EXPECT_EQ(one.rim.has_value(), other.rim.has_value());
      EXPECT_EQ(one.before, other.before) << text;
      EXPECT_EQ(one.inside, other.inside) << text;
    }
  }
}

const std::string by_hand = R"(wale 1
// my header comment
material   a {  physical { force = spring( 50 N/m ) } }  // trailing
workspace w {
  // left one
  patch p = a { size 40 mm, 40 mm; at -50 mm, 0 mm } // why
  patch q = corduroy { at 50.00 mm, 0 mm
     size 5 cm, 4 cm // in cm
     rim 2 mm }

  patch   r=oak   // as it is
  // the last word
}
)";

std::string rewritten(const std::function<void(Layout&)>& change, const std::string& text = by_hand) {
  const auto checked = service().check(text);
  EXPECT_FALSE(checked.has_errors()) << text;
  Layout layout = checked.layouts.at(0);
  change(layout);
  const std::string now = text.substr(0, layout.begin) + layout_text(layout) + text.substr(layout.end);
  EXPECT_FALSE(service().check(now).has_errors()) << now;
  return now;
}

std::string with(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return at == text.npos ? text : text.replace(at, what.size(), by);
}

TEST(LanguageService, WhatHasNotChangedIsWrittenAsItsAuthorWroteIt) {
  EXPECT_EQ(rewritten([](Layout&) {}), by_hand);
  EXPECT_EQ(rewritten([](Layout& layout) { layout.patches[0].at.x = 0.01; }),
            with(by_hand, "at -50 mm, 0 mm", "at 10 mm, 0 mm"));
  EXPECT_EQ(rewritten([](Layout& layout) { layout.patches[1].size = glm::dvec2(0.05, 0.03); }),
            with(by_hand, "size 5 cm, 4 cm", "size 50 mm, 30 mm"));
  EXPECT_EQ(rewritten([](Layout& layout) { layout.patches[1].made_of = "corduroy(wale: 3 mm)"; }),
            with(by_hand, "= corduroy {", "= corduroy(wale: 3 mm) {"));
  EXPECT_EQ(rewritten([](Layout& layout) { layout.patches[0].rim = 0.001; }),
            with(by_hand, "{ size 40 mm, 40 mm;", "{ rim 1 mm; size 40 mm, 40 mm;"));
  EXPECT_EQ(rewritten([](Layout& layout) { layout.patches[2].at = {0.03, -0.04}; }),
            with(by_hand, "r=oak ", "r=oak { at 30 mm, -40 mm } "));
  EXPECT_EQ(rewritten([](Layout& layout) { layout.patches.erase(layout.patches.begin() + 1); }),
            with(by_hand, R"(  patch q = corduroy { at 50.00 mm, 0 mm
     size 5 cm, 4 cm // in cm
     rim 2 mm }
)", ""));
  // Each comment stays with its patch where the order changes.
  const std::string turned = rewritten([](Layout& layout) { std::swap(layout.patches[0], layout.patches[2]); });
  EXPECT_NE(turned.find("r=oak   // as it is\n"), turned.npos) << turned;
  EXPECT_NE(turned.find("  // left one\n  patch p = a { size 40 mm, 40 mm; at -50 mm, 0 mm } // why\n"), turned.npos)
      << turned;
  EXPECT_LT(turned.find("r=oak"), turned.find("patch p")) << turned;
  const std::string one_line = "wale 1\nworkspace w { patch a = oak; patch b = denim }\n";
  EXPECT_EQ(rewritten([](Layout&) {}, one_line), one_line);
  rewritten([](Layout& layout) { std::swap(layout.patches[0], layout.patches[1]); }, one_line);
  rewritten([](Layout& layout) { layout.patches.erase(layout.patches.begin()); }, one_line);
  rewritten([](Layout& layout) { layout.patches.push_back({.name = "c", .made_of = "oak"}); }, one_line);
}

TEST(LanguageService, CompilesAMaterialUnderAnotherName) {
  const std::string text = "wale 1\nmaterial of_a_window = denim(roughness: 0.3)\n";
  const CompiledText own = service().compile(text, {.material = "of_a_window"});
  const CompiledText called = service().compile(text, {.material = "of_a_window"}, "denim");
  ASSERT_TRUE(own.program && called.program);
  PatchProgram description = own.program->description();
  EXPECT_EQ(description.material, "of_a_window");
  description.material = "denim";
  EXPECT_EQ(write_patch_program(called.program->description()), write_patch_program(description))
      << "only its name differs";
  // Nothing says a name that nobody wrote.
  const std::string wrong = "wale 1\nmaterial of_a_window { physical { force = vector(20 N, 0 N) } }\n";
  for (const Problem& each : service().compile(wrong, {.material = "of_a_window"}, "mine").problems)
    EXPECT_EQ(in_words(each.error).find("of_a_window"), std::string::npos) << in_words(each.error);
  EXPECT_FALSE(service().compile(text, {.material = "missing"}, "denim").program);
}

TEST(LanguageService, DrawsWhatPreviewDraws) {
  const CompiledText compiled = service().compile("wale 1\nmaterial m = corduroy\n");
  ASSERT_TRUE(compiled.program);
  const Program& program = *compiled.program;
  const auto svg = service().preview(program, program.default_parameters(), program.default_size(), "a.svg");
  ASSERT_TRUE(svg) << in_words(svg.error());
  const std::string text(reinterpret_cast<const char*>(svg->data()), svg->size());
  EXPECT_NE(text.find("<svg"), std::string::npos);
  EXPECT_EQ(service().preview(program, program.default_parameters(), program.default_size(), "a.xyz").error().code,
            Code::malformed_value);
  const auto parts = service().preview_parts(program, program.default_parameters(), program.default_size());
  ASSERT_TRUE(parts) << in_words(parts.error());
  EXPECT_EQ(parts->front().name, "surface");
  EXPECT_EQ(std::ranges::count(*parts, "spectrum", &PreviewPart::name), 1);
  for (const PreviewPart& each : *parts) {
    ASSERT_GT(each.png.size(), 8u) << each.name;
    EXPECT_EQ(each.png[1], std::byte{'P'}) << each.name;
  }
}

TEST(LanguageService, TellsWhatAMaterialReadsAs) {
  const auto compiled = service().compile("wale 1\nmaterial m { perceptual { roughness 0.6 } }\n");
  ASSERT_TRUE(compiled.program);
  const auto told = service().tell(*compiled.program);
  ASSERT_TRUE(told);
  ASSERT_EQ(told->percepts.size(), 1u);
  EXPECT_EQ(told->percepts.front().name, "roughness");
  EXPECT_NEAR(*told->percepts.front().asked, 0.6, 1e-6);
  EXPECT_NEAR(*told->percepts.front().reads, 0.6, 0.01);
  EXPECT_TRUE(told->text.starts_with("m\n")) << told->text;
}

TEST(Catalogue, EachSpellingNamesItsMaterial) {
  const auto catalogue = library_catalogue();
  const auto all = catalogue->search("");
  EXPECT_GT(all.size(), 100u);
  std::set<std::string> spellings;
  std::string text = "wale 1\nworkspace all {\n";
  for (const CatalogueEntry& each : all) {
    EXPECT_TRUE(spellings.insert(each.spelling).second) << each.spelling;
    text += "  patch p" + std::to_string(spellings.size()) + " = " + each.spelling + "\n";
  }
  const auto checked = service().check(text + "}\n");
  for (const Problem& each : checked.problems)
    if (severity_of(each.error.code) == Severity::error) ADD_FAILURE() << in_words(each.error);
}

TEST(Catalogue, SearchesAsFindDoes) {
  const auto catalogue = library_catalogue();
  const auto found = catalogue->search("ribb");
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(std::ranges::any_of(found, [](const CatalogueEntry& each) { return each.name == "corduroy"; }));
  EXPECT_TRUE(catalogue->search("no such words").empty());
  EXPECT_LT(catalogue->search("", "fabric").size(), catalogue->search("").size());
  EXPECT_EQ(std::ranges::count(catalogue->kinds(), "fabric"), 1);
}

TEST(LanguageService, TellsOfFoldersDevicesAndWorkspacesThatAreNotThere) {
  const std::string text = "wale 1\nworkspace w { patch a = oak { at 0 mm, 0 mm; size 40 mm, 40 mm } }\n";
  const LanguageService missing({.folders = {"/nonexistent/x"}});
  const auto first = [](const std::vector<Problem>& problems) {
    return problems.empty() ? Error{} : problems.front().error;
  };
  EXPECT_EQ(missing.folders_exist().error().code, Code::unreadable_file);
  EXPECT_EQ(first(missing.check(text).problems).code, Code::unreadable_file);
  EXPECT_EQ(missing.check(text).layouts.size(), 1u) << "the text is still checked";
  EXPECT_EQ(first(missing.compile(text).problems).code, Code::unreadable_file);
  EXPECT_EQ(first(missing.legibility(text)).code, Code::unreadable_file);
  EXPECT_EQ(library_catalogue({.folders = {"/nonexistent/x"}})->folders_exist().error().code, Code::unreadable_file);
  EXPECT_TRUE(library_catalogue()->folders_exist());
  EXPECT_TRUE(service().folders_exist());

  EXPECT_TRUE(service().check(text, {.device = "falcon"}).problems.empty());
  EXPECT_EQ(first(service().check(text, {.device = "falcom"}).problems).code, Code::unknown_device);
  EXPECT_EQ(first(service().check(text, {.device = "falcom"}).problems).nearest.front(), "falcon");
  EXPECT_EQ(first(service().legibility(text, {.device = "falcom"})).code, Code::unknown_device);
  EXPECT_EQ(first(service().legibility(text, {.workspace = "v"})).code, Code::unknown_workspace);
  EXPECT_EQ(first(service().legibility("wale 1\n")).code, Code::unknown_workspace);
  EXPECT_EQ(first(service().check(text, {.name = "a\nb"}).problems).code, Code::malformed_value);
}

}  // namespace
}  // namespace wale::language_service_test
