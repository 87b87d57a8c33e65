// `like` finds what no file imports: by name, by what people call it, by its kind.

#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/modules/library_index.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/parse/parse.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::compiling::likes_test {
namespace {

/// A library of files by module name, which can be listed, and how often that was done.
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

  /// N, on a hand 1 mm to the right: a spring's stiffness in N/mm, negated.
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
  // What the file itself declares comes first.
  EXPECT_FLOAT_EQ(Checked(spring("denim", 20) + like("denim"), files).force(), -0.02f);
}

TEST(Likes, AreFoundByWhatPeopleCallThemAndByTheirKind) {
  const std::map<std::string, std::string> files{
      {"cloth", spring("denim", 50, "title \"Blue denim\"; called \"jeans\", \"Serge de Nimes\"; kind fabric.twill") +
                    spring("felt", 30, "kind fabric.felted")}};
  for (const char* words : {"\"jeans\"", "\"serge de nimes\"", "\"Blue Denim\"", "fabric.twill", "\"denim\""})
    EXPECT_FLOAT_EQ(Checked(like(words), files).force(), -0.05f) << words;
  EXPECT_FLOAT_EQ(Checked(like("fabric.felted"), files).force(), -0.03f);
  // In the file itself too, where a material does not mean itself.
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
  EXPECT_EQ(
      Checked(like("denim"), files).said(),
      "W0217 `denim` may be 2 materials of the library: `denim` of `new.cloth`, `denim` of `old.cloth`; import the "
      "one that is meant, as in `import new.cloth`");
  // The mend does.
  EXPECT_FLOAT_EQ(Checked("import old.cloth\n" + like("denim"), files).force(), -0.03f);
  EXPECT_FLOAT_EQ(Checked("import old.cloth\n" + like("test.twill"), files).force(), -0.03f);
}

TEST(Likes, OfNothingAreAnErrorWithWhatIsNearest) {
  const std::string said = Checked(like("corduroi"), {{"cloth", spring("corduroy", 50, "called \"cord\"")}}).said();
  EXPECT_EQ(said, "W0201 no material is called `corduroi`; did you mean `corduroy`?");
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

TEST(Likes, CostNothingWhereNothingIsLookedFor) {
  Checked file("import cloth\nmaterial m { representative { like denim } }\n", {{"cloth", spring("denim", 50)}});
  EXPECT_FLOAT_EQ(file.force(), -0.05f);
  EXPECT_EQ(file.shelf.listed, 0);
}

TEST(Likes, OfABrokenFileSayWhatIsWrongWithIt) {
  const Checked file(like("denim"), {{"cloth", "material denim { physical { force = } }"}});
  ASSERT_TRUE(file.diagnostics.has_errors());
  EXPECT_EQ(file.sources[file.diagnostics.all().front().span.source].name, "cloth");
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
