// Fixes that the golden cases cannot express: whole lines that are removed, and errors that are not repeated.
#include <gtest/gtest.h>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/apply_fixes.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::checker_fixes_test {
namespace {

Diagnostics checked(const std::string& text, const std::string& name = "test.wale") {
  SourceSet sources;
  const auto resolver = file_resolver({});
  Diagnostics diagnostics;
  check_source(sources, sources.add(name, text), *resolver, diagnostics);
  return diagnostics;
}

/// The text with the first fix of its only diagnostic.
std::string fixed(const std::string& text) {
  const auto diagnostics = checked(text);
  if (diagnostics.all().size() != 1 || diagnostics.all()[0].fixes.empty()) return "no fix";
  return apply_fixes(text, 0, {diagnostics.all()[0].fixes[0]}).text;
}

TEST(CheckerFixes, UnusedImportGoesWithItsLine) {
  const std::string rest = "\nmaterial brick { physical { force = -1 N/m * hand } }\n";
  EXPECT_EQ(fixed("wale 1\nimport std.friction\n" + rest), "wale 1\n" + rest);
  EXPECT_EQ(fixed("wale 1\nimport  std.friction  \r\n" + rest), "wale 1\n" + rest);
  EXPECT_EQ(fixed("wale 1\nimport std.friction  // drag\n" + rest), "wale 1\n  // drag\n" + rest);
}

TEST(CheckerFixes, AppendAUnitOnlyToPlainNumbers) {
  EXPECT_EQ(fixed("wale 1\nlet a = 1 mm + 2\n"), "wale 1\nlet a = 1 mm + 2 mm\n");
  EXPECT_EQ(fixed("wale 1\nlet a = 1 mm + 50 %\n"), "no fix");
  EXPECT_EQ(fixed("wale 1\nlet a = 1 mm + (2 + 3)\n"), "no fix");
}

TEST(CheckerFixes, AreOfTheFileThatTheDiagnosticPointsTo) {
  // The error is found inside an embedded function, and the diagnostic points at the call.
  const auto diagnostics = checked("wale 1\nmaterial a { physical { force = lateral(1 N, amplitude: 2) } }\n");
  EXPECT_TRUE(diagnostics.has_errors());
  for (const auto& diagnostic : diagnostics.all())
    for (const auto& fix : diagnostic.fixes)
      for (const auto& edit : fix.edits) EXPECT_EQ(edit.span.source, diagnostic.span.source);
}

TEST(Imports, AreLookedForOnceInEachPlace) {
  const TemporaryFolder folder;
  folder.write(project_marker, "\n");
  const auto diagnostics = checked("wale 1\nimport nowhere\n", folder / "a.wale");
  ASSERT_EQ(diagnostics.all().size(), 1u);
  const std::string& message = diagnostics.all()[0].message;
  const auto first = message.find("nowhere.wale");
  EXPECT_NE(first, std::string::npos) << message;
  EXPECT_EQ(message.find("nowhere.wale", first + 1), std::string::npos) << message;
}

/// Supplies a module for every name but `devices`; each imports another, without end.
class Endless final : public Resolver {
 public:
  Result<ResolvedFile> module(const std::string& path, const std::string&) override {
    if (path == "devices") return Error{Code::unreadable_file, "no such file"};
    return ResolvedFile{path, "wale 1\nimport " + path + "x\n"};
  }
  Result<ResolvedFile> file(const std::string&, const std::string&) override {
    return Error{Code::unreadable_file, "no such file"};
  }
};

TEST(Imports, WithoutEndAreRefused) {
  SourceSet sources;
  Endless resolver;
  Diagnostics diagnostics;
  check_source(sources, sources.add("test.wale", "wale 1\nimport x\n"), resolver, diagnostics);
  ASSERT_EQ(diagnostics.error_count(), 1u);
  EXPECT_EQ(code_name(diagnostics.all()[0].code), "W0108");
}

}  // namespace
}  // namespace wale::checker_fixes_test
