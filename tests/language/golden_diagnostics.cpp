// Every case under tests/language/diagnostics/Wnnnn/ states the expected diagnostics on its own lines:
//
//     force = k * hand * wale       // error W0301: expected force, found energy; drop `* wale`
//
//     roughness = 0.6               // error W0103: a percept's level has no `=`   // fix: roughness 0.6
//     let b = (a + 1                // error W0103: expected `)`   // unsafe fix: let b = (a + 1)   // also: opened
//     here
//
// The file is compiled as `wale check` compiles it. Each expectation must match a diagnostic on its line with its code,
// and each part of its text (separated by "; ") must be in the diagnostic's message, expected, found or help. There may
// be no other diagnostics. `fix` follows the diagnostic that offers it and gives a line, without comments, after that
// fix alone is applied. `also` stands on the line of a secondary span and is part of its label. Fixes and secondary
// spans need not be expected. Lines are read as plain text, so an expectation may stand inside an unterminated text or
// comment.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include "compiler/legibility/check_legibility.hpp"
#include "compiler/compile.hpp"
#include "compiler/compile_workspace.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/solve/level_scale.hpp"

namespace wale::golden_diagnostics_test {
namespace {

namespace fs = std::filesystem;

const fs::path folder = fs::path(WALE_SOURCE_DIR) / "tests/language/diagnostics";

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> split(std::string text, const std::string& at) {
  std::vector<std::string> parts;
  for (std::size_t found; (found = text.find(at)) != std::string::npos; text.erase(0, found + at.size()))
    parts.push_back(text.substr(0, found));
  parts.push_back(text);
  return parts;
}

/// A line of the text after a fix.
struct ExpectedFix {
  bool safe;
  std::string line;
};

/// One expected diagnostic of a line of a case, or, without a code, the label of a secondary span on the line.
struct Expectation {
  SourceId source;
  unsigned line;
  std::string severity, code;
  std::vector<std::string> parts;
  std::vector<ExpectedFix> fixes;
};

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

/// The lines of a text, trimmed and without comments, with their number of occurrences.
std::map<std::string, int> lines_of(const std::string& text) {
  std::map<std::string, int> lines;
  for (const std::string& line : split(text, "\n")) ++lines[trimmed(line.substr(0, line.find("//")))];
  return lines;
}

/// Whether the diagnostic offers a fix of that safety that produces the line.
bool offers(const Diagnostic& diagnostic, const ExpectedFix& expected, const std::string& text) {
  return std::ranges::any_of(diagnostic.fixes, [&](const Fix& fix) {
    const FixedText fixed = apply_fixes(text, diagnostic.span.source, {fix});
    return fix.safe == expected.safe && !fixed.applied.empty() &&
           lines_of(fixed.text)[expected.line] > lines_of(text)[expected.line];
  });
}

std::vector<Expectation> expectations(const SourceSet& sources, SourceId source) {
  static const std::regex pattern("// (?:(error|warning) (W[0-9]{4})|also|(fix|unsafe fix)):");
  std::vector<Expectation> result;
  unsigned line = 0;
  for (const std::string& text : split(sources[source].text, "\n")) {
    ++line;
    std::vector<std::smatch> found;
    for (std::sregex_iterator each(text.begin(), text.end(), pattern), end; each != end; ++each) found.push_back(*each);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto from = static_cast<std::size_t>(found[i].position() + found[i].length());
      const auto to = i + 1 < found.size() ? static_cast<std::size_t>(found[i + 1].position()) : text.size();
      std::string parts = text.substr(from, to - from);
      parts = trimmed(parts);
      if (!found[i][3].matched)
        result.push_back({source, line, found[i][1], found[i][2], split(parts, "; "), {}});
      else if (!result.empty() && result.back().line == line)
        result.back().fixes.push_back({found[i][3] == "fix", parts});
      else
        ADD_FAILURE() << sources[source].name << ":" << line << ": a fix without a diagnostic";
    }
  }
  return result;
}

/// Whether one of the diagnostics has such a secondary span.
bool is_secondary(const std::vector<Diagnostic>& diagnostics, const Expectation& expected, const SourceSet& sources) {
  return std::ranges::any_of(diagnostics, [&](const Diagnostic& diagnostic) {
    return std::ranges::any_of(diagnostic.secondary, [&](const SecondarySpan& each) {
      return each.span.source == expected.source && sources.place(each.span).line == expected.line &&
             each.label.find(expected.parts.front()) != std::string::npos;
    });
  });
}

bool meets(const Diagnostic& diagnostic, const Expectation& expected, const SourceSet& sources) {
  const bool error = severity_of(diagnostic.code) == Severity::error;
  return diagnostic.span.source == expected.source && sources.place(diagnostic.span).line == expected.line &&
         code_name(diagnostic.code) == expected.code && expected.severity == (error ? "error" : "warning") &&
         std::ranges::all_of(expected.parts, [&](const std::string& part) {
           return std::ranges::any_of(
               std::initializer_list<const std::string*>{&diagnostic.message, &diagnostic.expected, &diagnostic.found,
                                                         &diagnostic.help},
               [&](const std::string* text) { return text->find(part) != std::string::npos; });
         });
}

/// All diagnostics of the file, as `wale check` reports them.
std::vector<Diagnostic> checked(SourceSet& sources, SourceId source) {
  const auto resolver = file_resolver({});
  Diagnostics diagnostics;
  const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
  if (!diagnostics.has_errors()) check_levels(module.declarations(), source, default_device, diagnostics);
  std::vector<Diagnostic> all = diagnostics.all();
  if (diagnostics.has_errors()) return all;
  for (const auto& material : module.materials) {
    Diagnostics of_material;
    compile_material(module, material.name, default_device, sources, source, *resolver, of_material);
    all.insert(all.end(), of_material.all().begin(), of_material.all().end());
  }
  for (const auto& workspace : module.workspaces) {
    Diagnostics of_workspace;
    const auto laid =
        compile_workspace(workspace, module, default_device, sources, source, *resolver, of_workspace);
    if (laid) check_legibility(workspace, *laid, module.declarations(), default_device, of_workspace);
    all.insert(all.end(), of_workspace.all().begin(), of_workspace.all().end());
  }
  return all;
}

std::vector<fs::path> cases() {
  std::vector<fs::path> all;
  for (const auto& code : fs::directory_iterator(folder))
    for (const auto& file : fs::directory_iterator(code))
      if (file.path().extension() == ".wale") all.push_back(file.path());
  std::ranges::sort(all);
  return all;
}

std::string case_name(const testing::TestParamInfo<fs::path>& info) {
  std::string name = info.param.parent_path().filename().string() + "_" + info.param.stem().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

class GoldenDiagnostics : public testing::TestWithParam<fs::path> {};

TEST_P(GoldenDiagnostics, AreThoseThatTheLinesSay) {
  SourceSet sources;
  const SourceId source = sources.add(GetParam().string(), bytes_of(GetParam()));
  std::vector<Diagnostic> diagnostics = checked(sources, source);

  std::vector<Expectation> expected;
  for (SourceId each = 0; each < sources.size(); ++each)
    if (fs::path(sources[each].name).string().starts_with(folder.string()))
      std::ranges::copy(expectations(sources, each), std::back_inserter(expected));
  const std::string code = GetParam().parent_path().filename();
  EXPECT_TRUE(std::ranges::any_of(expected, [&](const auto& each) { return each.code == code; }))
      << "no line expects " << code;

  for (const auto& each : expected)
    if (each.code.empty() && !is_secondary(diagnostics, each, sources))
      ADD_FAILURE() << sources[each.source].name << ":" << each.line
                    << ": no secondary span on this line has the label " << each.parts.front();
  for (const auto& each : expected) {
    if (each.code.empty()) continue;
    const auto found =
        std::ranges::find_if(diagnostics, [&](const auto& diagnostic) { return meets(diagnostic, each, sources); });
    if (found == diagnostics.end())
      ADD_FAILURE() << sources[each.source].name << ":" << each.line << ": expected " << each.code << ": "
                    << each.parts.front() << (each.parts.size() > 1 ? "; …" : "") << ", found none";
    else {
      for (const auto& fix : each.fixes)
        EXPECT_TRUE(offers(*found, fix, sources[each.source].text))
            << sources[each.source].name << ":" << each.line << ": no " << (fix.safe ? "safe" : "unsafe")
            << " fix gives the line `" << fix.line << "`";
      diagnostics.erase(found);
    }
  }
  for (const auto& diagnostic : diagnostics)
    ADD_FAILURE() << "not expected:\n" << render_text(diagnostic, sources, false);
}

TEST_P(GoldenDiagnostics, SayWhatToDo) {
  SourceSet sources;
  const SourceId source = sources.add(GetParam().string(), bytes_of(GetParam()));
  for (const auto& diagnostic : checked(sources, source)) {
    const auto shown = render_text(diagnostic, sources, false);
    EXPECT_FALSE(diagnostic.message.empty()) << shown;
    EXPECT_FALSE(diagnostic.help.empty() && diagnostic.expected.empty()) << shown;
    EXPECT_LE(diagnostic.span.begin, diagnostic.span.end) << shown;
    EXPECT_LE(diagnostic.span.end, sources[diagnostic.span.source].text.size()) << shown;
  }
}

TEST_P(GoldenDiagnostics, AreFewerOnceTheirSafeFixesAreApplied) {
  SourceSet sources;
  const std::string text = bytes_of(GetParam());
  const SourceId source = sources.add(GetParam().string(), text);
  const auto before = checked(sources, source);
  const FixedText fixed = apply_fixes(text, source, safe_fixes(before));
  if (fixed.applied.empty()) return;
  SourceSet after_sources;
  const auto after = checked(after_sources, after_sources.add(GetParam().string(), fixed.text));
  EXPECT_LT(safe_fixes(after).size(), safe_fixes(before).size()) << fixed.text;
  EXPECT_LT(after.size(), before.size()) << fixed.text;
}

INSTANTIATE_TEST_SUITE_P(Cases, GoldenDiagnostics, testing::ValuesIn(cases()), case_name);

TEST(DiagnosticCodes, EachHasACase) {
  // Codes that no short Wale file can show.
  const std::map<std::string, std::string> without_cases{
      {"W0109", "a file of more than 4 MB: LargeFiles.AreRefused below"},
      {"W0601", "the device is named on the command line: Choices.NearestDeviceIsProposed below"},
      {"W0602", "the material is named on the command line: Choices.NearestMaterialIsProposed below"},
      {"W0505", "of no Wale text: writing files, tests/command_line"},
      {"W0506", "of no Wale text: programs and recordings, tests/schema and tests/runtime"},
      {"W0507", "of no Wale text: programs and recordings, tests/schema and tests/runtime"},
      {"W0508", "of no Wale text: outputs, tests/compiler/output_files.cpp"},
      {"W0509", "megabytes of files: tests/command_line/totals.cpp"},
      {"W0606", "of no Wale text: the verifier, tests/machine"},
      {"W0607", "of no Wale text: stages and devices, tests/runtime and tests/usb_mock"},
      {"W0608", "of no Wale text: programs on plugged devices, tests/device and tests/usb_mock"},
      {"W0609", "the workspace is named on the command line: tests/command_line/workspaces.cpp"},
  };
  std::set<std::string> codes;
#define WALE_CODE(number, name, severity, title) codes.insert(code_name(Code::name));
#include "wale/codes.def"
  // Plugged devices and measured values have no text of Wale: tests/usb_mock, tests/runtime and tests/command_line.
  std::erase_if(codes, [](const std::string& code) { return code >= "W0700"; });
  for (const auto& code : codes)
    EXPECT_NE(fs::exists(folder / code), without_cases.contains(code))
        << code << " needs a folder of cases, or a reason";
  for (const auto& each : fs::directory_iterator(folder))
    EXPECT_TRUE(codes.contains(each.path().filename())) << each.path() << " is not the name of a code";
}

TEST(LargeFiles, AreRefused) {
  SourceSet sources;
  const SourceId source = sources.add("large.wale", "wale 1\n" + std::string(5 << 20, '\n'));
  const auto diagnostics = checked(sources, source);
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_EQ(diagnostics[0].code, Code::too_long);
  EXPECT_FALSE(diagnostics[0].help.empty());
}

Diagnostics choosing(const std::string& material, const std::string& device, const std::string& text) {
  SourceSet sources;
  const auto resolver = file_resolver({});
  Diagnostics diagnostics;
  compile(sources, sources.add("test.wale", text), material, device, *resolver, diagnostics);
  return diagnostics;
}

const char* const brick = "wale 1\nmaterial brick { physical { force = -1 N/m * hand } }\n";

TEST(Choices, NearestDeviceIsProposed) {
  const auto diagnostics = choosing("brick", "sandpapre", brick);
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(code_name(diagnostics.all()[0].code), "W0601");
  EXPECT_EQ(diagnostics.all()[0].help, "did you mean `sandpaper`?");
}

TEST(Choices, NearestMaterialIsProposed) {
  const auto diagnostics = choosing("birck", "sandpaper", brick);
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(code_name(diagnostics.all()[0].code), "W0602");
  EXPECT_EQ(diagnostics.all()[0].help, "did you mean `brick`?");
}

TEST(Choices, AFileWithoutMaterialsSaysSo) {
  const auto diagnostics = choosing("", "sandpaper", "wale 1\n");
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all()[0].message, "`test.wale` has no material");
}

TEST(Helps, SayHowAModuleIsImportedAndWhatAMaterialTakes) {
  const std::pair<const char*, const char*> cases[] = {
      {"import fabric.corduroy (corduroy)\n", "all that it exports is then known by its own name"},
      {"import fabric.corduroy {corduroy}\n", "all that it exports is then known by its own name"},
      {"import fabric.corduroy: corduroy\n", "all that it exports is then known by its own name"},
      {"import fabric.corduroy as cord\n", "all that it exports is then known by its own name"},
      {"import fabric.corduroy, fabric.denim\n", "each import is a line of its own"},
      {"import fabric/corduroy\n", "`import fabric.corduroy`"},
      {"material x = corduroy(roughnes: 0.3)\n", "did you mean `roughness`?"},
      {"material x = denim(yarm: 1 mm)\n", "did you mean `yarn`?"},
      {"material x = denim(colour: 1 mm)\n", "it has: yarn, roughness"},
  };
  for (const auto& [text, help] : cases) {
    SourceSet sources;
    const SourceId source = sources.add("test.wale", std::string("wale 1\n") + text);
    const auto diagnostics = checked(sources, source);
    ASSERT_FALSE(diagnostics.empty()) << text;
    EXPECT_NE(diagnostics[0].help.find(help), std::string::npos) << text << diagnostics[0].help;
  }
}

}  // namespace
}  // namespace wale::golden_diagnostics_test
