// `wale check --fix`: the files that it writes, the files that it leaves alone, and its exit status.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>

#include "tests/command_line/running.hpp"

namespace wale::command_line::mending_test {
namespace {

const char* const wrong =
    "materail ribs {\n"
    "  representative { title = “Ribs” }\n"
    "  physical {\n"
    "    param wale 2,5 mm in 1 mm .. 5 mm  // between ribs\n"
    "    height h = grating(x, period: wale)\n"
    "    force = lateral(h, amplitude: 2 × 0.5 N)\n"
    "  }\n";

const char* const right =
    "wale 1\n"
    "material ribs {\n"
    "  representative { title \"Ribs\" }\n"
    "  physical {\n"
    "    param wale = 2.5 mm in 1 mm .. 5 mm  // between ribs\n"
    "    height h = grating(x, period: wale)\n"
    "    force = lateral(h, amplitude: 2 * 0.5 N)\n"
    "  }\n"
    "}\n";

mode_t permissions(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

std::size_t entries(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder / "."), fs::directory_iterator()));
}

TEST(CheckFix, AppliesSafeFixesAndListsThem) {
  const TemporaryFolder folder;
  const std::string file = folder.write("ribs.wale", wrong);
  const Outcome outcome = wale({"check", "--fix", file});
  EXPECT_EQ(bytes_of(file), right);
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_EQ(outcome.out, "1 file: 0 errors, 0 warnings\n");
  EXPECT_TRUE(contains(outcome.err, "mended " + file + ":2:25: remove the `=`")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, ": write `material`\n")) << outcome.err;
  EXPECT_EQ(entries(folder), 1u) << "a temporary file is left";
}

TEST(CheckFix, IsProposedByCheck) {
  const TemporaryFolder folder;
  const std::string file = folder.write("ribs.wale", wrong);
  const Outcome outcome = wale({"check", file});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.out, "`wale check --fix` mends ")) << outcome.out;
  EXPECT_EQ(bytes_of(file), wrong);
  EXPECT_FALSE(contains(wale({"check", corduroy}).out, "--fix"));
}

TEST(CheckFix, KeepsPermissionsLinksAndUnchangedFiles) {
  const TemporaryFolder folder;
  const std::string file = folder.write("ribs.wale", wrong), link = folder / "link.wale";
  ASSERT_EQ(chmod(file.c_str(), 0640), 0);
  fs::create_symlink(file, link);
  EXPECT_EQ(wale({"check", "--fix", link}).status, 0);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(bytes_of(file), right);
  EXPECT_EQ(permissions(file), 0640u);
  const auto before = fs::last_write_time(file) - std::chrono::hours(1);
  fs::last_write_time(file, before);
  const Outcome again = wale({"check", "--fix", file});
  EXPECT_EQ(again.err, "");
  EXPECT_EQ(fs::last_write_time(file), before);
}

TEST(CheckFix, LeavesErrorsWithoutASafeFixAndFails) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("a.wale", "wale 1\nmaterial a { physical { param k = 3 × 2 N\n force = k hand } }\n");
  const Outcome outcome = wale({"check", "--fix", file});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(bytes_of(file), "3 * 2 N\n force = k hand }")) << bytes_of(file);
  EXPECT_TRUE(contains(outcome.out, "to multiply, write `k * hand`")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "1 file: 1 error,")) << outcome.out;
}

TEST(CheckFix, LeavesImportedFilesAlone) {
  const TemporaryFolder folder;
  const std::string imported = folder.write("half.wale", "wale 1\nexport let half 0.5\n");
  const std::string file =
      folder.write("a.wale", "wale 1\nimport half\nmaterial a { physical { force = -1 N/m × hand * half } }\n");
  const Outcome outcome = wale({"check", "--fix", file});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(bytes_of(imported), "wale 1\nexport let half 0.5\n");
  EXPECT_TRUE(contains(bytes_of(file), "-1 N/m * hand")) << bytes_of(file);
  EXPECT_EQ(wale({"check", "--fix", file, imported}).status, 0);
  EXPECT_EQ(bytes_of(imported), "wale 1\nexport let half = 0.5\n");
}

TEST(CheckFix, AFileThatCannotBeWrittenIsAnError) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write anything";
  const TemporaryFolder folder;
  const std::string file = folder.write("ribs.wale", wrong);
  ASSERT_EQ(chmod(file.c_str(), 0440), 0);
  const Outcome outcome = wale({"check", "--fix", file});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "error[W0505]: " + file + ": cannot write this file: ")) << outcome.err;
  EXPECT_EQ(bytes_of(file), wrong);
}

TEST(CheckFix, LeavesOtherFilesAlone) {
  const TemporaryFolder folder;
  const std::string text = "Things to buy\n\neggs × 6\n";
  const std::string file = folder.write("list.txt", text);
  EXPECT_EQ(wale({"check", "--fix", file}).status, 1);
  const std::string bytes(
      "\x7f"
      "ELF\0\1\2",
      7);
  const std::string binary = folder.write("binary", bytes);
  EXPECT_EQ(wale({"check", "--fix", binary, folder / "missing.wale", "/dev/null"}).status, 1);
  EXPECT_EQ(bytes_of(binary), bytes);
}

TEST(CheckFix, WritesTheRestAsJson) {
  const TemporaryFolder folder;
  const std::string file = folder.write("ribs.wale", wrong);
  const Outcome outcome = wale({"check", "--fix", "--json", file});
  EXPECT_EQ(outcome.json(), nlohmann::json::array());
  EXPECT_EQ(bytes_of(file), right);
}

TEST(CheckJson, FixesCanBeAppliedByTheirBytes) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.wale", "wale 1\nmaterial a { physical { force = -1 N/m × hand } }\n");
  const auto diagnostics = wale({"check", "--json", file}).json();
  ASSERT_EQ(diagnostics.size(), 1u);
  const auto& edit = diagnostics[0].at("fixes").at(0).at("edits").at(0);
  std::string text = bytes_of(file);
  const std::size_t begin = edit.at("begin_byte"), end = edit.at("end_byte");
  text.replace(begin, end - begin, edit.at("replacement").get<std::string>());
  EXPECT_EQ(wale({"check", folder.write("a.wale", text)}).status, 0) << text;
}

TEST(Check, ReportsErrorsOfASharedImportOnce) {
  const TemporaryFolder folder;
  const std::string wrong_one = folder.write("half.wale", "wale 1\nlet half = \n");
  const std::string a =
      folder.write("a.wale", "wale 1\nimport half\nmaterial a { physical { force = -1 N/m * hand } }\n");
  const std::string b =
      folder.write("b.wale", "wale 1\nimport half\nmaterial b { physical { force = -1 N/m * hand } }\n");
  EXPECT_TRUE(contains(wale({"check", a, b, wrong_one}).out, "3 files: 1 error,"));
}

TEST(Explain, ExplainsACodeInEverySpelling) {
  const Outcome outcome = wale({"explain", "W0301"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(outcome.out.starts_with("W0301, an error: a quantity of another dimension was expected\n\n"))
      << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "\nWrong:\n\n    wale 1\n")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "\nMended:\n\n    wale 1\n")) << outcome.out;
  for (const char* name : {"w0301", "W301", "301"}) EXPECT_EQ(wale({"explain", name}).out, outcome.out) << name;
}

TEST(Explain, ListsAllCodes) {
  const Outcome outcome = wale({"explain"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* line : {"W0101  error    a character that Wale does not use\n", "W0408  warning  more than"})
    EXPECT_TRUE(contains(outcome.out, line)) << outcome.out;
}

TEST(Explain, ProposesTheNearestCode) {
  const Outcome outcome = wale({"explain", "W031"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "wale: error[W0201]: no diagnostic has the code `W031`\n  = help: did you mean `W0301`?\n");
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace wale::command_line::mending_test
