// Finding materials without an import: by name, by the names that people use (`called`), by kind.

#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/modules/library_index.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/modules/meant_material.hpp"
#include "compiler/parse/parse.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::compiling::likes_test {
namespace {

/// A library in memory, by module name. `listed` counts how often its modules were listed.
class Shelf final : public Resolver {
 public:
  explicit Shelf(std::map<std::string, std::string> modules) : modules_(std::move(modules)) {}

  int listed = 0;

  Result<ResolvedFile> module(const std::string& path, const std::string&) override {
    const auto found = modules_.find(path);
    if (found == modules_.end()) return Error{Code::unreadable_file, "no such file"};
    return ResolvedFile{path, "wale 1\n" + found->second};
  }
  Result<ResolvedFile> file(const std::string& name, const std::string& from) override {
    if (!name.ends_with(".wale")) return Error{Code::unreadable_file, "no such file"};
    std::string path = name.substr(0, name.size() - 5);
    std::ranges::replace(path, '/', '.');
    return module(path, from);
  }
  std::vector<std::string> modules(const std::string&) override {
    ++listed;
    std::vector<std::string> all;
    for (const auto& [name, text] : modules_) all.push_back(name);
    return all;
  }

 private:
  std::map<std::string, std::string> modules_;
};

struct Checked {
  Shelf shelf;
  SourceSet sources;
  Diagnostics diagnostics;
  SourceId source;
  CheckedModule module;

  Checked(const std::string& text, std::map<std::string, std::string> modules)
      : shelf(std::move(modules)),
        source(sources.add("test.wale", "wale 1\n" + text)),
        module(check_source(sources, source, shelf, diagnostics)) {}

  std::string said() const {
    std::string all;
    for (const Diagnostic& each : diagnostics.all())
      all += (all.empty() ? "" : "\n") + code_name(each.code) + " " + each.message + "; " + each.help;
    return all;
  }

  /// The force of material `m` along x, in N, at x = 1 mm. For a spring it is the negated stiffness in N/mm.
  float force() {
    const auto program = compile_material(module, "m", default_device, sources, source, shelf, diagnostics);
    if (!program) throw std::runtime_error(said());
    Bank bank(*program);
    Hand hand;
    hand.position = {1e-3f, 0};
    return tick(bank, hand).x;
  }
};

std::string spring(const std::string& name, int newton_per_metre, const std::string& words = "") {
  return "material " + name + " { representative { " + words + " }\n physical { force = -" +
         std::to_string(newton_per_metre) + " N/m * hand } }\n";
}

std::string like(const std::string& what) { return "material m { representative { like " + what + " } }\n"; }

TEST(Likes, AreFoundByNameWithoutAnImport) {
  const std::map<std::string, std::string> files{
      {"cloth", "let k = 70 N/m\n" + spring("denim", 50) + "material stiff { physical { force = -k * hand } }\n"}};
  EXPECT_FLOAT_EQ(Checked(like("denim"), files).force(), -0.05f);
  // It keeps the constants of its own file.
  EXPECT_FLOAT_EQ(Checked("let k = 1 N\n" + like("stiff"), files).force(), -0.07f);
  // Declarations of the file come first.
  EXPECT_FLOAT_EQ(Checked(spring("denim", 20) + like("denim"), files).force(), -0.02f);
}

TEST(Likes, AreFoundByTheNamesPeopleUseAndByTheirKind) {
  const std::map<std::string, std::string> files{
      {"cloth", spring("denim", 50, "title \"Blue denim\"; called \"jeans\", \"Serge de Nimes\"; kind fabric.twill") +
                    spring("felt", 30, "kind fabric.felted")}};
  for (const char* words : {"\"jeans\"", "\"serge de nimes\"", "\"Blue Denim\"", "fabric.twill", "\"denim\""})
    EXPECT_FLOAT_EQ(Checked(like(words), files).force(), -0.05f) << words;
  EXPECT_FLOAT_EQ(Checked(like("fabric.felted"), files).force(), -0.03f);
  // They are found in the file itself too, and a material does not find itself.
  const std::string own =
      spring("loden", 10, "called \"jeans\"") + "material m { representative { called \"jeans\"; like \"jeans\" } }\n";
  EXPECT_FLOAT_EQ(Checked(own, files).force(), -0.01f);
}

TEST(Likes, AreFoundThroughOneAnother) {
  const std::map<std::string, std::string> files{{"a", "material denim { representative { like twill } }"},
                                                 {"b", "import c\nmaterial twill { representative { like cloth } }"},
                                                 {"c", spring("cloth", 40)}};
  EXPECT_FLOAT_EQ(Checked(like("denim"), files).force(), -0.04f);
}

TEST(Likes, AreFoundInTheModulesOfTheLanguage) {
  Checked bowl(like("Bowl"), {});
  EXPECT_EQ(bowl.said(), "");
  EXPECT_LT(bowl.force(), 0);
}

TEST(Likes, ThatMayBeSeveralAreAnErrorThatNamesThem) {
  const std::map<std::string, std::string> files{{"new.cloth", spring("denim", 50, "kind test.twill")},
                                                 {"old.cloth", spring("denim", 30, "kind test.twill")}};
  EXPECT_EQ(Checked(like("denim"), files).said(),
            "W0217 `denim` may be 2 materials of the library: `denim` of `new.cloth`, `denim` of `old.cloth`; name the "
            "one that you mean, as in `new.cloth.denim`");
  EXPECT_FLOAT_EQ(Checked(like("old.cloth"), files).force(), -0.03f);
  // An import decides as well.
  EXPECT_FLOAT_EQ(Checked("import old.cloth\n" + like("denim"), files).force(), -0.03f);
  EXPECT_FLOAT_EQ(Checked("import old.cloth\n" + like("test.twill"), files).force(), -0.03f);
}

TEST(Likes, OfUnknownNamesAreAnErrorWithTheNearestName) {
  const std::string said = Checked(like("corduroi"), {{"cloth", spring("corduroy", 50, "called \"cord\"")}}).said();
  EXPECT_EQ(said, "W0201 no material is called `corduroi`; did you mean `corduroy` of `cloth`?");
  EXPECT_NE(Checked(like("\"zzzzzz\""), {}).said().find("W0201 no material is called `zzzzzz`"), std::string::npos);
}

TEST(Likes, ThatComeBackToThemselvesAreAnError) {
  const std::map<std::string, std::string> files{{"a", "material one { representative { like two } }"},
                                                 {"b", "material two { representative { like one } }"}};
  const std::string said = Checked(like("one"), files).said();
  EXPECT_NE(said.find("W0413 `one` is made from itself"), std::string::npos) << said;
  const std::string itself = Checked("material m { representative { like m } }\n", files).said();
  EXPECT_NE(itself.find("W0413 `m` is made from itself"), std::string::npos) << itself;
}

TEST(Likes, ListNoModulesWhereNoSearchIsNeeded) {
  Checked file("import cloth\nmaterial m { representative { like denim } }\n", {{"cloth", spring("denim", 50)}});
  EXPECT_FLOAT_EQ(file.force(), -0.05f);
  EXPECT_EQ(file.shelf.listed, 0);
}

TEST(Likes, OfABrokenFileSayWhatIsWrongWithIt) {
  const Checked file(like("denim"), {{"cloth", "material denim { physical { force = } }"}});
  ASSERT_TRUE(file.diagnostics.has_errors());
  EXPECT_EQ(file.sources[file.diagnostics.all().front().span.source].name, "cloth");
}

const std::map<std::string, std::string> two_springs{
    {"cloth", spring("denim", 50, "called \"jeans\"") +
                  "material felt { physical { param k = 30 N/m in 0 N/m .. 90 N/m\n force = -k * hand } }\n"
                  "export function softened(k) = k / 2\n"}};

// Forces of springs add, so each expected force is the weighted sum of the stiffnesses, times 1 mm.
TEST(MaterialNames, MayStandInEveryWayToDeriveAMaterial) {
  const auto force = [](const std::string& what) {
    return Checked("material m = " + what + "\n", two_springs).force();
  };
  EXPECT_FLOAT_EQ(force("denim"), -0.05f);
  EXPECT_FLOAT_EQ(force("\"jeans\""), -0.05f);
  EXPECT_FLOAT_EQ(force("felt(k: 60 N/m)"), -0.06f);
  EXPECT_FLOAT_EQ(force("0.5 denim + 0.5 felt"), -0.04f);
  EXPECT_FLOAT_EQ(force("50 % denim + 0.5 * felt(k: 60 N/m)"), -0.055f);
  EXPECT_FLOAT_EQ(force("0.5 * \"jeans\" + 0.5 felt"), -0.04f);
  EXPECT_FLOAT_EQ(force("between(felt, felt(k: 60 N/m), 0.5)"), -0.045f);
  EXPECT_FLOAT_EQ(force("between(0.5 denim + 0.5 felt, 0.5 denim + 0.5 felt, 0.5)"), -0.04f);
}

TEST(MaterialNames, AreTheFilesOwnBeforeTheLibrarys) {
  EXPECT_FLOAT_EQ(Checked(spring("denim", 20) + "material m = 0.5 denim + 0.5 felt\n", two_springs).force(), -0.025f);
}

TEST(MaterialNames, ThatPeopleUseNameTheWeightAfterTheMaterial) {
  const Checked file("material m = 0.5 * \"jeans\" + 0.5 felt\n", two_springs);
  ASSERT_EQ(file.said(), "");
  EXPECT_EQ(file.module.material("m")->parameters.front().name, "denim_weight");
}

TEST(MaterialNames, ThatAreUnknownComeWithTheNearestThreeAndTheirImports) {
  const std::map<std::string, std::string> files{
      {"a", spring("quilt", 1)}, {"b", spring("quilp", 2)}, {"c.d", spring("quilts", 3)}, {"e", spring("quarts", 4)}};
  for (const char* what : {"quil", "quil(k: 1)", "0.5 quil", "2 * quil", "between(quil, quilt, 0.5)"})
    EXPECT_EQ(Checked(std::string("material m = ") + what + "\n", files).said(),
              "W0201 no material is called `quil`; did you mean `quilt` of `a`, `quilp` of `b` or `quilts` "
              "of `c.d`?")
        << what;
  // A material of the file needs no import, and comes first.
  EXPECT_TRUE(Checked(spring("quils", 1) + "material m = quil\n", {})
                  .said()
                  .starts_with("W0201 no material is called `quil`; did you mean `quils`"));
}

TEST(MaterialNames, MayBeGivenWithTheirModules) {
  const std::map<std::string, std::string> files{{"a.cloth", spring("quilt", 1)}, {"b.cloth", spring("quilt", 2)}};
  for (const char* what : {"a.cloth.quilt", "b.cloth", "0.5 a.cloth.quilt"})
    EXPECT_EQ(Checked(std::string("material m = ") + what + "\n", files).said(), "") << what;
}

TEST(MaterialNames, OfOtherDeclarationsSayTheirSort) {
  EXPECT_EQ(Checked("material m = softened\n", two_springs).said(),
            "W0201 no material is called `softened`; `softened` is a function of `cloth`, and no material; to use "
            "it, write `import cloth`");
}

TEST(Exports, OfTheLibraryComeBackWithTheirImport) {
  const std::map<std::string, std::string> files{
      {"own.rough", "export map roughness from amplitude {\n  name own.steep\n}\n"},
      {"own.units", "export unit thou = 25.4 um\nexport unit hidden = 1 m\n"},
      {"own.percepts", "export percept fizz {\n}\n"}};
  const struct {
    const char *text, *said;
  } cases[] = {
      {"material m { perceptual { roughness 0.5, by own.steep } }\n",
       "W0201 no map for roughness is called `own.steep`; `own.steep` is a map of `own.rough`; write `import "
       "own.rough`"},
      {"let width = 3 thou\n",
       "W0203 nothing declares a unit `thou`; `thou` is a unit of `own.units`; write `import own.units`"},
      {"function f(a: length) = a / 3 thou\n",
       "W0203 nothing declares a unit `thou`; `thou` is a unit of `own.units`; write `import own.units`"},
      {"material m { perceptual { fizz 0.5 } }\n",
       "W0201 nothing declares a percept `fizz`; `fizz` is a percept of `own.percepts`; write `import own.percepts`"}};
  for (const auto& each : cases) {
    const std::string said = Checked(each.text, files).said();
    EXPECT_TRUE(said.starts_with(each.said)) << said;
  }
}

TEST(MaterialNames, OnACommandLineFollowTheSameRule) {
  SourceSet sources;
  Diagnostics diagnostics;
  LibraryIndex index;
  const auto add = [&](const std::string& module, const std::string& text, Origin origin = Origin::own) {
    const SourceId source = sources.add(module, "wale 1\n" + text);
    index.add(module, module + ".wale", parse(sources, source, diagnostics), origin);
  };
  add("shipped", spring("denim", 1, "called \"jeans\"") + spring("felt", 1) + spring("oak", 1), Origin::shipped);
  add("own", spring("denim", 2));
  add("other", spring("oak", 2));
  add("third", spring("oak", 2));
  ASSERT_TRUE(meant_material(index, "denim"));
  EXPECT_EQ((*meant_material(index, "denim"))->module, "own");
  EXPECT_EQ((*meant_material(index, "Jeans"))->module, "shipped");
  EXPECT_EQ(meant_material(index, "oak").error().code, Code::ambiguous_material);
  EXPECT_EQ(meant_material(index, "oak").error().sentence,
            "`oak` may be 2 materials: `oak` of `other`, `oak` of `third`");
  // A name with its module is not ambiguous.
  ASSERT_TRUE(meant_material(index, "third.oak"));
  EXPECT_EQ((*meant_material(index, "third.oak"))->module, "third");
  ASSERT_TRUE(meant_material(index, "third"));
  EXPECT_EQ((*meant_material(index, "third"))->name, "oak");
  EXPECT_EQ(meant_material(index, "third.ok").error().code, Code::unknown_name);
  EXPECT_EQ(meant_material(index, "fellt").error().code, Code::unknown_name);
  EXPECT_EQ(meant_material(index, "fellt").error().mend, "the nearest: `felt` of `shipped`");
}

TEST(CommonModules, ThatAreBrokenSaySoInEveryCompilation) {
  SourceSet sources;
  Diagnostics diagnostics;
  Shelf nothing({});
  auto broken = std::make_shared<CommonModules>();
  broken->problems.report({.code = Code::unknown_unit, .span = {first_embedded_source, 0, 4}, .message = "broken"});
  const SourceId source = sources.add("test.wale", "wale 1\n");
  load_modules(parse(sources, source, diagnostics), sources, nothing, diagnostics, broken);
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all().front().message, "broken");
  EXPECT_EQ(sources[diagnostics.all().front().span.source].name, "schema/units.wale");
  EXPECT_TRUE(common_modules()->problems.all().empty());
}

}  // namespace
}  // namespace wale::compiling::likes_test
