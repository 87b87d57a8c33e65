// Every code has an explanation. If the code is about the text of a file, the wrong example yields exactly that code,
// and the mended example compiles without a diagnostic.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "compiler/legibility/check_legibility.hpp"
#include "compiler/compile.hpp"
#include "compiler/compile_workspace.hpp"
#include "compiler/diagnostics/explain.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/solve/level_scale.hpp"

namespace wale::explanations_test {
namespace {

/// Why the first example of a code does not yield it as it stands.
const std::map<std::string, std::string> not_as_one_file = {
    {"W0107", "the page itself is UTF-8 without NUL bytes"},
    {"W0108", "two hundred parentheses would not be readable"},
    {"W0109", "the file would have more than 4 MB"},
    {"W0215", "needs a second file that keeps a name to itself"},
    {"W0216", "needs a second file"},
    {"W0315", "needs a picture"},
    {"W0434", "needs a picture"},
    {"W0502", "needs a second file that is no picture"},
    {"W0503", "needs a picture of that size"},
    {"W0504", "needs a second file that is no table"},
    {"W0509", "needs files of megabytes"},
    {"W0601", "the device is named on the command line"},
};

/// Whether the code is about the text of a Wale file. Codes of files, devices and measurements are explained without
/// examples.
bool is_of_wale_text(Code code) {
  return code < Code::absent_device && code != Code::unwritable_file && code != Code::damaged_file &&
         code != Code::newer_file && code != Code::output_is_input && code != Code::refused_program &&
         code != Code::other_device && code != Code::other_figures && code != Code::unknown_workspace;
}

struct Example {
  std::string wrong, right;
};

Example example_of(Code code) {
  Example example;
  std::string kind;
  std::istringstream lines{std::string(explanation(code))};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```"))
      kind = kind.empty() ? line.substr(3) : "";
    else if (kind == "wale-error")
      example.wrong += line + "\n";
    else if (kind == "wale")
      example.right += line + "\n";
    else
      EXPECT_EQ(kind, "") << code_name(code);
  }
  return example;
}

/// A file that can import itself and nothing else.
class Itself final : public Resolver {
 public:
  explicit Itself(std::string text) : text_(std::move(text)) {}
  Result<ResolvedFile> module(const std::string& path, const std::string&) override {
    if (path != "wave") return Error{Code::unreadable_file, "no such file"};
    return ResolvedFile{"wave.wale", text_};
  }
  Result<ResolvedFile> file(const std::string&, const std::string&) override {
    return Error{Code::unreadable_file, "no such file"};
  }

 private:
  std::string text_;
};

/// The codes of all diagnostics, and the diagnostics as text.
struct Outcome {
  std::set<std::string> codes;
  std::string shown;
};

/// Compiles all materials of the file. In a file without any, it asks for one where `needs_material`.
Outcome outcome_of(const std::string& text, bool needs_material) {
  SourceSet sources;
  Diagnostics diagnostics;
  Itself resolver(text);
  const SourceId source = sources.add("wave.wale", text);
  const CheckedModule module = check_source(sources, source, resolver, diagnostics);
  std::vector<std::string> names;
  for (const auto& material : module.materials) names.push_back(material.name);
  if (names.empty() && needs_material) names.emplace_back();
  if (!diagnostics.has_errors()) check_levels(module.declarations(), source, default_device, diagnostics);
  std::vector<Diagnostic> all = diagnostics.all();
  for (const auto& name : names) {
    if (diagnostics.has_errors()) break;
    Diagnostics of_material;
    compile_material(module, name, default_device, sources, source, resolver, of_material);
    all.insert(all.end(), of_material.all().begin(), of_material.all().end());
  }
  for (const auto& workspace : module.workspaces) {
    if (diagnostics.has_errors()) break;
    Diagnostics of_workspace;
    const auto laid = compile_workspace(workspace, module, default_device, sources, source, resolver, of_workspace);
    if (laid) check_legibility(workspace, *laid, module.declarations(), default_device, of_workspace);
    all.insert(all.end(), of_workspace.all().begin(), of_workspace.all().end());
  }
  Outcome outcome;
  for (const auto& each : all) {
    outcome.codes.insert(code_name(each.code));
    outcome.shown += render_text(each, sources, false);
  }
  return outcome;
}

class Explanations : public testing::TestWithParam<Code> {};

TEST_P(Explanations, HaveAParagraphAndTwoExamples) {
  const std::string_view text = explanation(GetParam());
  const Example example = example_of(GetParam());
  EXPECT_GT(text.find("\n\n```wale-error\n"), 80u) << "a paragraph comes first";
  EXPECT_FALSE(example.wrong.empty());
  EXPECT_FALSE(example.right.empty());
  EXPECT_TRUE(text.ends_with("```\n"));
  const std::string shown = explanation_text(GetParam());
  EXPECT_TRUE(shown.starts_with(code_name(GetParam()) + ", ")) << shown;
  EXPECT_NE(shown.find(code_title(GetParam())), std::string::npos);
  EXPECT_NE(shown.find("\nWrong:\n\n    "), std::string::npos);
  EXPECT_NE(shown.find("\nMended:\n\n    "), std::string::npos);
  EXPECT_EQ(shown.find("```"), std::string::npos);
}

TEST_P(Explanations, TheWrongExampleYieldsTheCode) {
  const std::string code = code_name(GetParam());
  if (not_as_one_file.contains(code)) GTEST_SKIP() << not_as_one_file.at(code);
  const Outcome outcome = outcome_of(example_of(GetParam()).wrong, GetParam() == Code::unknown_material);
  EXPECT_EQ(outcome.codes, std::set<std::string>{code}) << outcome.shown;
}

TEST_P(Explanations, TheMendedExampleHasNoError) {
  const Outcome outcome = outcome_of(example_of(GetParam()).right, GetParam() == Code::unknown_material);
  EXPECT_EQ(outcome.codes, std::set<std::string>{}) << outcome.shown;
}

std::vector<Code> codes_of_wale_text() {
  std::vector<Code> codes = all_codes();
  std::erase_if(codes, [](Code code) { return !is_of_wale_text(code); });
  return codes;
}

INSTANTIATE_TEST_SUITE_P(Codes, Explanations, testing::ValuesIn(codes_of_wale_text()),
                         [](const auto& info) { return code_name(info.param); });

TEST(ExplanationsWithoutExamples, AreAParagraph) {
  for (const Code code : all_codes()) {
    if (is_of_wale_text(code)) continue;
    const std::string_view text = explanation(code);
    EXPECT_GT(text.size(), 80u) << code_name(code);
    EXPECT_EQ(text.find("```"), std::string_view::npos) << code_name(code);
    EXPECT_TRUE(explanation_text(code).starts_with(code_name(code) + ", ")) << code_name(code);
  }
}

TEST(CodesByName, AreFoundInEverySpelling) {
  for (const char* name : {"W0301", "w0301", "W301", "w301", "0301", "301"})
    EXPECT_EQ(*code_named(name), Code::wrong_dimension) << name;
  for (const char* name : {"", "W", "W9999", "W03011", "wrong", "W03O1", "-301", "W-301"})
    EXPECT_FALSE(code_named(name)) << name;
}

TEST(CodesByName, TheNearestIsProposed) {
  EXPECT_EQ(code_named("W031").error().sentence, "no diagnostic has the code `W031`");
  EXPECT_EQ(code_named("W031").error().mend, "did you mean `W0301`?");
  EXPECT_EQ(code_named("W0602x").error().mend, "did you mean `W0602`?");
  EXPECT_EQ(code_named("wrong").error().mend, "`wale explain` lists all codes");
}

TEST(CodesByName, AreListedWithTheirTitles) {
  const std::string list = codes_text();
  EXPECT_NE(list.find("W0101  error    a character that Wale does not use\n"), std::string::npos) << list;
  EXPECT_NE(list.find("W0209  warning  a name that nothing uses\n"), std::string::npos) << list;
}

}  // namespace
}  // namespace wale::explanations_test
