// The table of exit statuses in compiler/README.md, for names that nothing has and for pipes whose reader leaves.
#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::statuses_test {
namespace {

using Words = std::vector<std::string>;

void expect_status(int status, const std::vector<Words>& commands) {
  for (const Words& words : commands) {
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, status) << testing::PrintToString(words) << outcome.err;
    EXPECT_EQ(outcome.out, "") << testing::PrintToString(words);
    EXPECT_TRUE(contains(outcome.err, "nope")) << testing::PrintToString(words) << outcome.err;
  }
}

TEST(Statuses, AnUnknownNameInAnOptionIsWrongUsage) {
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp", picture = folder / "p.png";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  expect_status(2, {{"build", corduroy, "--material", "nope", "-o", folder / "x.wpp"},
                    {"build", corduroy, "--material", "nope", "--emit", "ir"},
                    {"describe", corduroy, "--material", "nope"},
                    {"describe", corduroy, "--material", "nope", "--device", "all"},
                    {"describe", program, "--material", "nope"},
                    {"preview", corduroy, "--material", "nope", "-o", picture},
                    {"sample", corduroy, "--material", "nope", "--at", "1 mm, 1 mm"},
                    {"feel", corduroy, "--material", "nope", "--virtual-time"},
                    {"find", "--kind", "nope"},
                    {"find", "--library", folder / "nope"},
                    {"check", corduroy, "--library", folder / "nope"},
                    {"feel", corduroy, "--against", "nope", "--blind"},
                    {"feel", corduroy, "--against", corduroy + ":nope", "--blind"},
                    {"feel", corduroy, "--hand", "nope", "--virtual-time"},
                    {"feel", corduroy, "--device", "nope"},
                    {"feel", corduroy, "--built-for", "nope", "--virtual-time"},
                    {"devices", "--identify", "nope"},
                    {"build", corduroy, "--device", "nope", "-o", folder / "x.wpp"},
                    {"compare", corduroy, "denim", "--device", "nope"},
                    {"levels", "roughness", "--device", "nope"},
                    {"describe", corduroy, "--set", "nope=1"}});
}

TEST(Statuses, AnUnknownNameInAnArgumentCannotBeCarriedOut) {
  expect_status(1, {{"describe", "nope"},
                    {"describe", corduroy + ":nope"},
                    {"compare", corduroy + ":nope", "denim"},
                    {"compare", "nope", "denim"},
                    {"feel", "nope", "--virtual-time"},
                    {"find", "nope"},
                    {"levels", "nope"},
                    {"explain", "nope"}});
}

TEST(Statuses, AMissingFileCannotBeReadWhereverItIsNamed) {
  expect_status(1, {{"describe", "nope.wale"},
                    {"describe", corduroy, "--devices", "nope.wale"},
                    {"feel", corduroy, "--devices", "nope.wale", "--virtual-time"},
                    {"feel", corduroy, "--against", "nope.wale", "--blind"},
                    {"feel", corduroy, "--hand", "nope.csv", "--virtual-time"},
                    {"sample", corduroy, "--trace", "nope.csv"}});
}

/// The status of `wale find`, whose output of tens of kilobytes fits a pipe, before this command in a pipe.
int status_before(const std::string& reader) {
  const TemporaryFolder folder;
  const std::string status = folder / "status";
  std::system(("{ " + quoted(WALE_BINARY) + " find fabric 2>" + quoted(folder / "err") + "; echo $? >" + quoted(status) +
               "; } | " + reader + " >/dev/null")
                  .c_str());
  EXPECT_EQ(bytes_of(folder / "err"), "");
  return std::stoi(bytes_of(status));
}

TEST(Statuses, AReaderThatLeavesAfterItsFirstLineDoesNotMatter) {
  constexpr int runs = 20;
  for (int run = 0; run < runs; ++run) EXPECT_EQ(status_before("head -n 1"), 0);
}

TEST(Statuses, AReaderThatHasLeftIsAFailure) {
  // The pipe's only reader closes it, and `wale` begins after that.
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe", status = folder / "status";
  std::system(("mkfifo " + quoted(pipe) + "; { : <" + quoted(pipe) + "; } & { wait $!; " + quoted(WALE_BINARY) +
               " find fabric 2>" + quoted(folder / "err") + "; echo $? >" + quoted(status) + "; } >" + quoted(pipe))
                  .c_str());
  EXPECT_EQ(bytes_of(status), "1\n");
  EXPECT_EQ(bytes_of(folder / "err"), "");
}

TEST(Statuses, AFolderThatCannotBeReadIsSaid) {
  const TemporaryFolder folder;
  const std::string closed = folder / "closed";
  fs::create_directory(closed);
  fs::permissions(closed, fs::perms::none);
  if (geteuid() == 0) GTEST_SKIP() << "root may read anything";
  for (const Words& words : {Words{"find", "corduroy", "--library", folder / "."},
                             {"describe", "corduroy", "--library", folder / "."},
                             {"compare", "corduroy", "denim", "--library", folder / "."}}) {
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "closed` cannot be read")) << outcome.err;
  }
  fs::permissions(closed, fs::perms::owner_all);  // so that it can be removed
}

}  // namespace
}  // namespace wale::command_line::statuses_test
