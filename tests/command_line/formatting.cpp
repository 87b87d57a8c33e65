// `wale format`: which files it writes, its output and its status.

#include <gtest/gtest.h>

#include <chrono>

#include "tests/command_line/running.hpp"

namespace wale::command_line::formatting_test {
namespace {

const std::string untidy = "wale 1\nlet a=1//one\n", tidy = "wale 1\nlet a = 1   // one\n";

TEST(Formatting, WritesOnlyFilesThatChange) {
  const TemporaryFolder folder;
  const std::string one = folder.write("one.wale", untidy), two = folder.write("two.wale", tidy);
  fs::permissions(one, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  const auto written = fs::last_write_time(two) - std::chrono::hours(1);
  fs::last_write_time(two, written);
  const Outcome outcome = wale({"format", one, two});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_EQ(bytes_of(one), tidy);
  EXPECT_EQ(fs::status(one).permissions(), fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  EXPECT_EQ(fs::last_write_time(two), written);
  EXPECT_EQ(std::distance(fs::directory_iterator(fs::path(one).parent_path()), {}), 2);  // no temporary file is left
}

TEST(Formatting, FollowsALinkAndLeavesItALink) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file.wale", untidy), link = folder / "link.wale";
  fs::create_symlink(file, link);
  EXPECT_EQ(wale({"format", link}).status, 0);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(bytes_of(file), tidy);
}

TEST(Formatting, ACheckListsFilesThatWouldChangeAndWritesNothing) {
  const TemporaryFolder folder;
  const std::string one = folder.write("one.wale", untidy), two = folder.write("two.wale", tidy);
  const Outcome outcome = wale({"format", "--check", one, two});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.out, one + "\n");
  EXPECT_EQ(bytes_of(one), untidy);
  EXPECT_EQ(wale({"format", "--check", two}).status, 0);
}

TEST(Formatting, AFileWithErrorsIsLeftAloneAndTheOthersAreNot) {
  const TemporaryFolder folder;
  const std::string wrong = folder.write("wrong.wale", "wale 1\nlet a=(\n"), one = folder.write("one.wale", untidy);
  const Outcome outcome = wale({"format", wrong, folder / "none.wale", one});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "W0103") && contains(outcome.err, "wrong.wale:2:8")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "none.wale: no such file")) << outcome.err;
  EXPECT_EQ(bytes_of(wrong), "wale 1\nlet a=(\n");
  EXPECT_EQ(bytes_of(one), tidy);
}

TEST(Formatting, ADashIsStandardInputToStandardOutput) {
  const TemporaryFolder folder;
  const std::string file = folder.write("in.wale", untidy);
  const std::string command = quoted(WALE_BINARY) + " format - <" + quoted(file) + " >" + quoted(folder / "out");
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(bytes_of(folder / "out"), tidy);
  EXPECT_EQ(bytes_of(file), untidy);
}

}  // namespace
}  // namespace wale::command_line::formatting_test
