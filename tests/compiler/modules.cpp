// Imports: exported names, private names, and the search for modules.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/compiler/compiling.hpp"

namespace wale::compiling::modules_test {
namespace {

/// Files in memory by module name. `asked` counts the requests for each.
class Library final : public Resolver {
 public:
  explicit Library(std::map<std::string, std::string> modules) : modules_(std::move(modules)) {}

  std::map<std::string, int> asked;

  Result<ResolvedFile> module(const std::string& path, const std::string&) override {
    ++asked[path];
    const auto found = modules_.find(path);
    if (found == modules_.end()) return Error{Code::unreadable_file, "no such file"};
    return ResolvedFile{path, "wale 1\n" + found->second};
  }
  Result<ResolvedFile> file(const std::string&, const std::string&) override {
    return Error{Code::unreadable_file, "no such file"};
  }

 private:
  std::map<std::string, std::string> modules_;
};

/// A file that is checked with a library of modules.
struct Checked {
  Library library;
  SourceSet sources;
  Diagnostics diagnostics;
  SourceId source;
  CheckedModule module;

  Checked(const std::string& text, std::map<std::string, std::string> modules)
      : library(std::move(modules)),
        source(sources.add("test.wale", "wale 1\n" + text)),
        module(check_source(sources, source, library, diagnostics)) {}

  /// The errors in the order in which they were reported, each as its code and the name of its file.
  std::vector<std::string> errors() const {
    std::vector<std::string> all;
    for (const auto& diagnostic : diagnostics.all())
      if (severity_of(diagnostic.code) == Severity::error)
        all.push_back(code_name(diagnostic.code) + " " + sources[diagnostic.span.source].name);
    return all;
  }

  /// The force of a material, in N, at the place (x, y) in m.
  Force force(double x, double y = 0, const std::string& material = "m") {
    const auto program = compile_material(module, material, default_device, sources, source, library, diagnostics);
    if (!program) {
      std::string reasons;
      for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources, false);
      throw std::runtime_error(reasons);
    }
    Bank bank(*program);
    Hand hand;
    hand.position = {static_cast<float>(x), static_cast<float>(y)};
    return tick(bank, hand);
  }
};

using Codes = std::vector<std::string>;

/// A material whose force along x is that many newtons.
std::string newtons(const std::string& number) {
  return "material m { physical { force = vector(1 N * (" + number + "), 0 N) } }\n";
}

const char* const tools = R"(
let waste = 0.5
unit span = 9 inch
dimension yield = length / force
let shown = 3 mm
function hidden(t) = waste * t
export function plane(t) = hidden(t) + 1
export let offered = waste * 8
export unit ell = 5 span
)";

TEST(Modules, OfferExportsAndUseTheirPrivateNames) {
  Checked file("import tools\n" + newtons("plane(3) + offered / 100 + 1 ell / 100 m"), {{"tools", tools}});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(0).x, 2.5f + 0.04f + 5 * 9 * 0.0254f / 100);
}

TEST(Modules, KeepTheRestToThemselves) {
  for (const char* use : {"waste", "hidden(1)", "shown / 1 mm", "1 span / 1 m"})
    EXPECT_EQ(Checked("import tools\n" + newtons(use), {{"tools", tools}}).errors(), Codes{"W0215 test.wale"}) << use;
  EXPECT_EQ(
      Checked("import tools\nfunction f(t: yield) = t / 1 m * 1 N\n" + newtons("f(1 m / 1 N)"), {{"tools", tools}})
          .errors(),
      Codes{"W0215 test.wale"});
}

TEST(Modules, KeepDimensionsToThemselvesInStatesToo) {
  const std::map<std::string, std::string> modules{{"cloth", "dimension wear\nexport unit rub : wear"}};
  EXPECT_EQ(Checked("import cloth\nmaterial m { physical { state worn : wear = 1 rub in 0 rub .. 2 rub\n"
                    "  force = vector(worn / 1 rub * 1 N, 0 N) } }\n",
                    modules)
                .errors(),
            Codes{"W0215 test.wale"});
  EXPECT_EQ(Checked("import cloth\ndimension rate = wear / time\n" + newtons("1"), modules).errors(),
            Codes{"W0215 test.wale"});
}

TEST(Modules, MayBeGivenNamesThatOthersKeepToThemselves) {
  // Private names of other modules are free in this file.
  Checked file("import tools\nlet waste = 7\nfunction hidden(t) = t + waste\nunit span = 1 mm\n" +
                   newtons("plane(2) + hidden(1) / 10 + 1 span / 1 m"),
               {{"tools", tools}});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(0).x, 2 + 0.8f + 0.001f);
}

TEST(Modules, WithEqualPrivateNamesDoNotClash) {
  Checked file("import one\nimport two\n" + newtons("first(1) + second(1) / 100"),
               {{"one", "let k = 2\nfunction inner(t) = k * t\nexport function first(t) = inner(t)"},
                {"two", "let k = 3\nfunction inner(t) = k * t + 1\nexport function second(t) = inner(t)"}});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(0).x, 2.04f);
}

TEST(Modules, ThatExportEqualNamesClash) {
  Checked file("import one\nimport two\n" + newtons("inner(1)"),
               {{"one", "export function inner(t) = 2 * t"}, {"two", "export function inner(t) = 3 * t"}});
  EXPECT_EQ(file.errors(), Codes{"W0202 test.wale"});
}

TEST(Modules, AreLoadedOnceHoweverManyImportThem) {
  // If `base` were loaded twice, `wear` would be two dimensions, and `total` could not add `worn` and `torn`.
  Checked file("import left\nimport right\nimport base\n" + newtons("total(worn(2), torn(3)) / 1 rub"),
               {{"base", "export dimension wear\nexport unit rub : wear"},
                {"left", "import base\nexport function worn(t) = t * 1 rub"},
                {"right",
                 "import base\nexport function torn(t) = t * 1 rub\nexport function total(a: wear, b: wear) = "
                 "a + b"}});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(0).x, 5);
  EXPECT_EQ(file.module.modules.modules.size(), 4u);
}

TEST(Modules, DoNotExportTheirImports) {
  const std::map<std::string, std::string> modules{{"far", "export let distance = 4"},
                                                   {"near", "import far\nexport let half = distance / 2"}};
  Checked good("import near\n" + newtons("half"), modules);
  EXPECT_EQ(good.errors(), Codes{});
  EXPECT_FLOAT_EQ(good.force(0).x, 2);
  EXPECT_EQ(Checked("import near\n" + newtons("half + distance"), modules).errors(), Codes{"W0201 test.wale"});
}

TEST(Modules, GiveDimensionsBoundsAndUnits) {
  Checked file(R"(import cloth
material m { physical {
  state worn : wear = 1 rub
  let share = worn / 4 rub
  next worn = worn + rubbed(5)
  force = vector(1 N * share, 0 N)
} }
)",
               {{"cloth",
                 "export dimension wear in 0 rub .. 3 rub\nexport unit rub : wear\n"
                 "export function rubbed(t) = t * 1 rub"}});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(0).x, 0.25f);
}

TEST(Modules, KeepTheirBaseDimensionsApart) {
  const std::map<std::string, std::string> modules{
      {"cloth", "dimension wear\nunit rub : wear\nexport function worn(t) = t * 1 rub"},
      {"stove", "dimension heat\nunit glow : heat\nexport function warm(t) = t * 1 glow"},
      {"shoe", "dimension wear\nunit rub : wear\nexport function trodden(t) = t * 1 rub"}};
  Checked file("import cloth\nimport stove\n" + newtons("worn(6) / worn(2) + warm(1) / warm(4)"), modules);
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(0).x, 3.25f);
  EXPECT_EQ(Checked("import cloth\nimport stove\n" + newtons("(worn(6) + warm(1)) / worn(1)"), modules).errors(),
            Codes{"W0302 test.wale"});
  // Both files declare a dimension `wear`, independently of each other, so these are two dimensions.
  EXPECT_EQ(Checked("import cloth\nimport shoe\n" + newtons("(worn(6) + trodden(1)) / worn(1)"), modules).errors(),
            Codes{"W0302 test.wale"});
}

const char* const fabric = R"(
let customary = 20 N/m
function pull(k) = -k * hand
material elastic { physical {
  param k = customary in 1 N/m .. 50 N/m
  force = pull(k)
} }
)";

TEST(Modules, OfferMaterialsToDeriveFrom) {
  Checked file(R"(import fabric
material soft = elastic(k: 5 N/m)
material m { representative { like elastic }
  physical { force wind = vector(0.25 N, 0 N) } }
material mixed = 0.5 elastic + 0.5 soft
material middle = between(soft, elastic, 0.5)
)",
               {{"fabric", fabric}});
  EXPECT_EQ(file.errors(), Codes{});
  // Only the file's own materials are listed.
  std::vector<std::string> names;
  for (const auto& material : file.module.materials) names.push_back(material.name);
  EXPECT_EQ(names, (Codes{"soft", "m", "mixed", "middle"}));
  EXPECT_FLOAT_EQ(file.force(-0.01, 0, "soft").x, 0.05f);
  EXPECT_FLOAT_EQ(file.force(-0.01, 0, "m").x, 0.45f);
  EXPECT_FLOAT_EQ(file.force(-0.01, 0, "mixed").x, 0.125f);
  EXPECT_FLOAT_EQ(file.force(-0.01, 0, "middle").x, 0.125f);
}

TEST(Modules, NamesOfADerivedMaterialAreThoseOfItsFile) {
  // `pull` and `customary` have another meaning in this file, which does not change the imported material.
  Checked file(
      "import fabric\nlet customary = 1 N/m\nfunction pull(k) = k * hand\n"
      "material m = elastic\nmaterial own { physical { force = pull(customary) } }\n",
      {{"fabric", fabric}});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(-0.01, 0, "m").x, 0.2f);
  EXPECT_FLOAT_EQ(file.force(-0.01, 0, "own").x, -0.01f);
}

TEST(Modules, OfTheLanguageAreFoundFromAnywhere) {
  Checked file("import std.weave\nmaterial m { physical { force = lateral(twill(hand, 2 mm), amplitude: 1 N) } }\n",
               {});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_NE(file.force(0.0013, 0.0004), Force(0, 0));
  // From within another module too, and private names stay private there.
  Checked further("import mine\nmaterial m { physical { force = lateral(cloth(hand), amplitude: 1 N) } }\n",
                  {{"mine", "import std.weave\nexport function cloth(p) = twill(p, 2 mm)"}});
  EXPECT_EQ(further.errors(), Codes{});
  EXPECT_EQ(further.force(0.0013, 0.0004), file.force(0.0013, 0.0004));
  EXPECT_EQ(Checked("import std.weave\n" + newtons("on_top(1, 1, 1, 1, 1)"), {}).errors(), Codes{"W0215 test.wale"});
}

TEST(Modules, BesideAFileComeBeforeThoseOfTheLanguage) {
  Checked file("import std.weave\n" + newtons("twill(3)"), {{"std.weave", "export function twill(t) = 2 * t"}});
  EXPECT_EQ(file.errors(), Codes{});
  EXPECT_FLOAT_EQ(file.force(0).x, 6);
}

TEST(Modules, ThatAreMissingOrCircularAreErrors) {
  EXPECT_EQ(Checked("import nowhere\n" + newtons("1"), {}).errors(), Codes{"W0212 test.wale"});
  EXPECT_EQ(Checked("import one\n" + newtons("a"),
                    {{"one", "import two\nexport let a = b"}, {"two", "import one\nexport let b = 1"}})
                .errors(),
            Codes{"W0213 two"});
}

}  // namespace
}  // namespace wale::compiling::modules_test
