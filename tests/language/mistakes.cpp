// Mistakes of people who come from other languages, made in shipped materials: each gives one error or warning, which
// says what was meant.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"

namespace wale::mistakes_test {
namespace {

namespace fs = std::filesystem;

struct Mistake {
  const char* name;
  const char* pattern;  ///< of a statement that is right
  const char* wrong;    ///< what stands in its place
  const char* help;     ///< a part of what is proposed
};

/// In the places where people make them; the first match in a file is changed.
const std::vector<Mistake>& mistakes() {
  static const std::vector<Mistake> all{
      {"percent twice", R"re((\n    (?:roughness|bumpiness|hardness|springiness|viscosity) )0\.(\d)(?: estimated)?\n)re",
       "$01$02"
       "0 %%\n",
       "write it once"},
      {"level as in CSS", R"re((\n    (?:roughness|bumpiness|hardness|springiness|viscosity)) (0\.\d+)(?: estimated)?\n)re",
       "$1: $2;\n", "write `"},
      {"level as in JSON", R"re(\n    (roughness|bumpiness|hardness|springiness|viscosity) (0\.\d+)(?: estimated)?\n)re",
       "\n    \"$1\": $2,\n", "without quotes"},
      {"level in newton", R"re((\n    roughness 0\.\d+)(?: estimated)?\n)re", "$1 N\n", "levels go from 0 to 1"},
      {"section as in JSON", R"re(\n  physical \{)re", "\n  \"physical\": {", "write `physical {`"},
      {"section as in YAML", R"re(\n  physical \{)re", "\n  physical: {", "write `physical {`"},
      {"misspelt section", R"re(\n  physical \{)re", "\n  physics {", "did you mean `physical`?"},
      {"title as in JSON", R"re(\n    title( +)")re", "\n    title: \"", "write `title"},
      {"colour as in CSS", R"re(\n  physical \{\n)re", "\n  physical {\n    color: #a0ff00;\n", "is named as in `let"},
      {"width as in CSS", R"re(\n  physical \{\n)re", "\n  physical {\n    width: 20px;\n", "is named as in `let"},
      {"name as in JSON", R"re(\n  physical \{\n)re", "\n  physical {\n    \"k\": 2,\n", "without quotes"},
      {"uniform of GLSL", R"re(\n    param )re", "\n    uniform float ", "write `param`"},
      {"slider", R"re(\n    param )re", "\n    slider ", "write `param`"},
      {"float of C", R"re(\n    let )re", "\n    float ", "write `let`"},
      {"vec2 of GLSL", R"re(\n    let )re", "\n    vec2 ", "write `let`"},
      {"const of C", R"re(\n    let )re", "\n    const float ", "write `let`"},
      {"force with a colon", R"re(\n    force = )re", "\n    force: ", "write `force = …`"},
      {"force added up", R"re(\n    force = )re", "\n    force += ", "a name"},
      {"range in brackets", R"re( in ([\d.]+ mm) \.\. ([\d.]+ mm)( |\n))re", " in [$1, $2]$3", "`in 1 mm .. 5 mm`"},
      {"range with a dash", R"re( in ([\d.]+ mm) \.\. ([\d.]+ mm)( |\n))re", " in $1 - $2$3", "`in 1 mm .. 5 mm`"},
      {"range with words", R"re( in ([\d.]+ mm) \.\. ([\d.]+ mm)( |\n))re", " from $1 to $2$3", "`in 1 mm .. 5 mm`"},
      {"comment of Python", R"re(\n  physical \{\n)re", "\n  physical {\n    # the ribs\n", "comments begin with `//`"},
      {"comment of Lua", R"re(\n  physical \{\n)re", "\n  physical {\n    -- the ribs\n", "comments begin with `//`"},
      {"definition of C", R"re(\nmaterial )re", "\n#define K 2.5\nmaterial ", "is named as in `let"},
      {"inclusion of C", R"re(\nmaterial )re", "\n#include \"std.wale\"\nmaterial ", "`import`"},
      {"function of C", R"re(\nmaterial )re", "\nfloat hill(float t) { return sin(t); }\nmaterial ",
       "write `function hill"},
      {"function of Python", R"re(\nmaterial )re", "\ndef hill(t): return sin(t)\nmaterial ", "write `function"},
      {"braces of JSON", R"re(\nmaterial )re", "\n{ material ", "without braces"},
      {"capital keyword", R"re(\nmaterial )re", "\nMaterial ", "did you mean `material`?"},
      {"newtons", R"re((\d) N([,)\n]))re", "$1 Newtons$2", "write `N`"},
      {"float suffix", R"re((duty|smooth): (0\.\d+)([,)]))re", "$1: $2f$3", "numbers have no suffix"},
      {"argument with an equals sign", R"re(, (period|amplitude|duty|face): ([\d.]))re", ", $1 = $2", "named with `:`"},
      {"missing comma", R"re(, (period|amplitude|duty|face): ([\d.]))re", " $1: $2", "put a comma before"},
      {"no comma between texts", R"re(\n    called( +)"([^"\n]+)", ")re", "\n    called$1\"$2\" \"",
       "parted by commas"},
      {"single quotes", R"re(\n    title( +)"([^"'\n]+)"\n)re", "\n    title$1'$2'\n", "double quotes"},
      {"duty in hundreds", R"re(duty: 0\.(\d)([,)]))re",
       "duty: $01"
       "0$2",
       "percentages have their sign"},
      {"duty in percent of percent", R"re(duty: 0\.(\d)([,)]))re",
       "duty: $01"
       "0 %%$2",
       "write it once"},
      {"period in hertz", R"re(period: [a-z]\w*([,)]))re", "period: 300 Hz$1", "write a length"},
      {"frequency of a grating", R"re((grating\(.*)period: )re", "$1frequency: ", "did you mean `period`?"},
      {"self of Python", R"re(period: ([a-z]\w*)([,)]))re", "period: self.$1$2", "write `"},
  };
  return all;
}

struct Found {
  std::vector<Diagnostic> all;
  std::string shown;
};

/// All errors and warnings of a text, as `wale check` gives them.
Found found_in(const std::string& name, const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  const SourceId source = sources.add(name, text);
  const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
  for (const auto& material : module.materials)
    if (!diagnostics.has_errors())
      compile_material(module, material.name, default_device, sources, source, *resolver, diagnostics);
  Found found{diagnostics.all(), {}};
  for (const Diagnostic& each : found.all) found.shown += render_text(each, sources, false);
  return found;
}

TEST(Mistakes, OfOtherLanguagesGiveOneErrorThatSaysWhatWasMeant) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(WALE_SOURCE_DIR) / "library"))
    if (entry.path().extension() == ".wale") paths.push_back(entry.path());
  std::ranges::sort(paths);
  constexpr std::size_t files_a_mistake = 4;
  for (const Mistake& mistake : mistakes()) {
    const std::regex pattern(mistake.pattern);
    std::size_t made = 0;
    for (std::size_t i = 0; i < paths.size() && made < files_a_mistake; ++i) {
      std::ifstream stream(paths[(i * 37) % paths.size()], std::ios::binary);
      const std::string name = paths[(i * 37) % paths.size()].string();
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      const bool of_functions =
          name.find("/std/") != std::string::npos || name.find("/sandpaper/") != std::string::npos;
      if (of_functions || text.size() > 4000 || !std::regex_search(text, pattern)) continue;
      ++made;
      const std::string wrong =
          std::regex_replace(text, pattern, mistake.wrong, std::regex_constants::format_first_only);
      const Found found = found_in(name, wrong);
      const bool helps = std::ranges::any_of(
          found.all, [&](const Diagnostic& each) { return each.help.find(mistake.help) != std::string::npos; });
      EXPECT_EQ(found.all.size(), 1u) << mistake.name << " in " << name << "\n" << found.shown;
      EXPECT_TRUE(helps) << mistake.name << " in " << name << "\n" << found.shown;
    }
    EXPECT_GT(made, 0u) << mistake.name << " can be made in no file";
  }
}

}  // namespace
}  // namespace wale::mistakes_test
