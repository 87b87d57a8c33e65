// What many files are together, and what little memory or stack there may be. Work and memory are counted by the
// compiler, never timed here.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::totals_test {
namespace {

constexpr std::size_t megabyte = 1 << 20;

/// A module with a comment of that many bytes.
std::string long_module(std::size_t bytes) { return "wale 1\n// " + std::string(bytes, 'x') + "\n"; }

/// Runs `wale` after the shell has limited something, as by `ulimit -v 30000`.
Outcome wale_within(const std::string& limit, const std::string& words) {
  const TemporaryFolder folder;
  const std::string command = limit + "; XDG_CONFIG_HOME=/nonexistent " + quoted(WALE_BINARY) + " " + words +
                              " </dev/null >" + quoted(folder / "out") + " 2>" + quoted(folder / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, bytes_of(folder / "out"), bytes_of(folder / "err")};
}

TEST(Totals, OfImportsAreMetBeforeTheReading) {
  const TemporaryFolder folder;
  std::string text = "wale 1\n";
  for (int i = 0; i < 12; ++i) {
    const std::string name = "part" + std::to_string(i);
    folder.write(name + ".wale", long_module(megabyte));
    text += "import " + name + "\n";
  }
  const Outcome outcome = wale({"check", folder.write("all.wale", text)});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.out, "error[W0509]: expected at most 8 MB of imported files, found 8.0 MB with `" +
                                        (folder / "part7.wale") + "`"))
      << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "import part7")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "import fewer or smaller files")) << outcome.out;
}

TEST(Totals, OfImportsCountAFileOnce) {
  const TemporaryFolder folder;
  folder.write("part.wale", long_module(3 * megabyte));
  std::string text = "wale 1\n";
  for (int i = 0; i < 100; ++i) text += "import part\n";
  const Outcome outcome = wale({"check", folder.write("all.wale", text)});
  EXPECT_EQ(outcome.status, 0) << outcome.out.substr(0, 1000);
}

TEST(Totals, OfPicturesAndTablesAreMetBeforeTheReading) {
  const TemporaryFolder folder;
  // Nothing on the disk but their size: 200 MB each.
  std::string text = "wale 1\n\nmaterial many {\n  physical {\n";
  for (int i = 0; i < 12; ++i) {
    const std::string name = "hole" + std::to_string(i) + ".csv";
    folder.write(name, "");
    fs::resize_file(folder / name, 200 * megabyte);
    text += "    let a" + std::to_string(i) + " = table(\"" + name + "\")\n";
  }
  const Outcome outcome = wale({"check", folder.write("all.wale", text + "    force = -1 N/m * hand\n  }\n}\n")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.out,
                       "error[W0509]: expected at most 2048 MB of pictures and tables to read, "
                       "found 2200.0 MB with `"))
      << outcome.out.substr(0, 3000);
}

// The index of a library takes no more of a file than a compilation would.
TEST(Totals, OfALibraryLeaveOutFilesThatNoImportReads) {
  const TemporaryFolder folder;
  folder.write("huge.wale", "wale 1\nmaterial huge_one { physical { force = -1 N/m * hand } }\n" +
                                long_module(5 * megabyte).substr(7));
  folder.write("small.wale", "wale 1\nmaterial small_one { physical { force = -1 N/m * hand } }\n");
  const Outcome outcome = wale({"find", "--library", folder.path(), "one"});
  EXPECT_TRUE(contains(outcome.out, "small_one")) << outcome.out << outcome.err;
  EXPECT_FALSE(contains(outcome.out, "huge_one")) << outcome.out;
}

TEST(Totals, OfALibraryLeaveOutItsLastFilesAndSaySo) {
  const TemporaryFolder folder;
  for (char letter = 'a'; letter < 'a' + 20; ++letter)
    folder.write(std::string(1, letter) + ".wale", "wale 1\nmaterial own_" + std::string(1, letter) +
                                                       " { physical { force = -1 N/m * hand } }\n// " +
                                                       std::string(4 * megabyte - 1000, 'x') + "\n");
  const Outcome outcome = wale({"find", "--library", folder.path(), "own"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "own_a")) << outcome.out;
  EXPECT_FALSE(contains(outcome.out, "own_t")) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "not searched")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "64 MB")) << outcome.err;
}

TEST(Depth, OfImportsIsTheSameInEachOrder) {
  for (const bool deepest_first : {false, true})
    for (const int files : {63, 70}) {
      const TemporaryFolder folder;
      std::string text = "wale 1\n";
      for (int i = 0; i < files; ++i) {
        folder.write("m" + std::to_string(i) + ".wale",
                     i == 0 ? std::string("wale 1\n") : "wale 1\nimport m" + std::to_string(i - 1) + "\n");
        text += "import m" + std::to_string(deepest_first ? files - 1 - i : i) + "\n";
      }
      const Outcome outcome = wale({"check", folder.write("all.wale", text)});
      EXPECT_EQ(outcome.status, files > 64 ? 1 : 0) << deepest_first << outcome.out.substr(0, 500);
      EXPECT_EQ(contains(outcome.out, "error[W0108]: imports are nested more than 64 files deep"), files > 64)
          << deepest_first << outcome.out.substr(0, 500);
    }
}

/// A chain of functions, each with a call of the one before nested `nesting` deep in `opening`.
std::string nested_functions(const std::string& opening, const std::string& closing, int nesting) {
  std::string text = "wale 1\n";
  for (int i = 0; i < 60; ++i) {
    text += "function f" + std::to_string(i) + "(a) = ";
    for (int n = 0; n < nesting; ++n) text += opening;
    text += i == 0 ? "a" : "f" + std::to_string(i - 1) + "(a)";
    for (int n = 0; n < nesting; ++n) text += closing;
    text += "\n";
  }
  return text + "material m { physical { force = -1 N/m * f59(1) * hand } }\n";
}

// 64 functions deep, each 200 expressions deep, were more than the stack of a usual process.
TEST(Depth, OfExpressionsCountsThoseOfTheFunctionsCalled) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> kinds[] = {
      {"abs(-", ")"}, {"max(1, ", ")"}, {"if 1 < 2 then ", " else 1"}, {"(1 + ", ")"}};
  for (const auto& [opening, closing] : kinds) {
    const std::string deep = folder.write("deep.wale", nested_functions(opening, closing, 95));
    const std::string usual = folder.write("usual.wale", nested_functions(opening, closing, 4));
    for (const char* limit : {"true", "ulimit -s 128"}) {
      const Outcome refused = wale_within(limit, "check " + quoted(deep));
      EXPECT_EQ(refused.status, 1) << limit << opening;
      EXPECT_TRUE(contains(refused.out, "error[W0108]")) << limit << opening << refused.out.substr(0, 500);
      EXPECT_EQ(wale_within(limit, "check " + quoted(usual)).status, 0) << limit << opening;
    }
  }
}

TEST(Depth, OfASmallStackIsEnoughForWhatIsShipped) {
  const TemporaryFolder folder;
  for (const std::string& words : {std::string("describe "), std::string("build -o ") + quoted(folder / "o.wpp") + " "})
    EXPECT_EQ(wale_within("ulimit -s 128", words + quoted(corduroy)).status, 0) << words;
}

TEST(ShortMemory, IsNoErrorInWale) {
  for (int kilobytes = 16'000; kilobytes <= 60'000; kilobytes += 1'000) {
    const Outcome outcome = wale_within("ulimit -v " + std::to_string(kilobytes), "devices");
    EXPECT_FALSE(contains(outcome.err, "an error in Wale itself")) << kilobytes << outcome.err;
    EXPECT_NE(outcome.status, 3) << kilobytes << outcome.err;
  }
}

TEST(StandardInput, IsRefusedAtTheSizeOfATextAndNotReadFurther) {
  const TemporaryFolder folder;
  const std::string left = folder / "left";
  // What follows behind 5 MB would be read too, if it were read to its end.
  const std::string command = "{ head -c 20000000 /dev/zero; echo $? >" + quoted(left) + "; } 2>/dev/null | " +
                              quoted(WALE_BINARY) + " format - >" + quoted(folder / "out") + " 2>" +
                              quoted(folder / "err");
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_TRUE(contains(bytes_of(folder / "err"), "it has more than 4 MB, the most that Wale reads"));
  EXPECT_NE(bytes_of(left), "0\n") << "all was read";
}

}  // namespace
}  // namespace wale::command_line::totals_test
