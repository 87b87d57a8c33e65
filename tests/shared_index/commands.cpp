// The verbs with a shared index, as people type them.
#include <nlohmann/json.hpp>

#include "tests/command_line/running.hpp"
#include "tests/shared_index/server.hpp"

namespace wale::shared_index::commands_test {
namespace {

using command_line::contains;
using command_line::Outcome;
using command_line::wale;

class Commands : public Server {
 protected:
  void SetUp() override {
    Server::SetUp();
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    write_library("shelf");
    for (int i = 1; i <= 5; ++i)
      write("shelf/ribs" + std::to_string(i) + ".wale", "wale 1\n" + ribs("ribs" + std::to_string(i), 0.2 + 0.1 * i, 2.5, "Ribs."));
  }
  Outcome give(std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"library", "index", folder_ / "shelf", "--index", address()};
    words.insert(words.end(), more.begin(), more.end());
    return wale(words);
  }
  void expect_no_password(const Outcome& outcome) const {
    const std::string password = of_environment("PGPASSWORD");
    ASSERT_FALSE(password.empty());
    EXPECT_FALSE(contains(outcome.out, password)) << outcome.out;
    EXPECT_FALSE(contains(outcome.err, password)) << outcome.err;
  }
};

TEST_F(Commands, GiveAndFind) {
  const Outcome made = give();
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(made.out, "5 files named, 5 read anew, 0 gone; the shared index has 5 materials\n")) << made.out;
  EXPECT_TRUE(contains(made.out, ":***@")) << made.out;
  expect_no_password(made);
  const Outcome again = give({"--json"});
  EXPECT_EQ(again.json().at("read"), 0);
  expect_no_password(again);
  ASSERT_EQ(wale({"library", "index", folder_ / "shelf", "-o", folder_ / "an.index"}).status, 0);
  // Each verb says of both the same, but for the files' names.
  const std::vector<std::vector<std::string>> questions = {
      {"find", "--near", "ribs3"}, {"find", "gröber", "--near", "ribs3", "--most", "2"}, {"find", "--roughness", "0.4..0.6"},
      {"find", "--smoothness", "0.5", "--kind", "trial"}, {"between", "ribs1", "ribs5"}, {"show", "ribbed ribs4"}};
  for (std::vector<std::string> question : questions) {
    question.insert(question.end(), {"--json", "--index", folder_ / "an.index"});
    const Outcome in_file = wale(question);
    question.back() = address();
    const Outcome shared = wale(question);
    ASSERT_EQ(in_file.status, 0) << in_file.err;
    ASSERT_EQ(shared.status, 0) << shared.err;
    std::string text = in_file.out;
    for (std::size_t at; (at = text.find(folder_ / "shelf")) != std::string::npos;) text.replace(at, (folder_ / "shelf").size(), "shelf");
    EXPECT_EQ(shared.out, text) << question[0] << " " << question[1];
    expect_no_password(shared);
  }
}

TEST_F(Commands, SayWhatIsNotTakenAndWhatIsGone) {
  write("shelf/bound.wale", "wale 1\n" + ribs("bound", 0.5, 3, "Bound.", "    licence \"CC-BY-NC-4.0\"\n"));
  const Outcome refused = give();
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(contains(refused.err, "`bound` of shelf/bound.wale is not in the shared index: its licence, CC-BY-NC-4.0")) << refused.err;
  std::filesystem::remove(folder_ / "shelf/bound.wale");
  std::filesystem::remove(folder_ / "shelf/ribs1.wale");
  const Outcome told = give();
  EXPECT_EQ(told.status, 0);
  EXPECT_TRUE(contains(told.err, "1 material of the shared index lie")) << told.err;
  EXPECT_TRUE(contains(give({"--forget"}).out, "1 gone; the shared index has 4 materials"));
  const Outcome part = wale({"library", "index", folder_ / "shelf/ribs2.wale", "--index", address(), "--forget"});
  EXPECT_EQ(part.status, 2);
  EXPECT_TRUE(contains(part.err, "whole libraries")) << part.err;
}

TEST_F(Commands, GiveTheRolesThatTheyPrint) {
  ASSERT_EQ(give().status, 0);
  const Outcome roles = wale({"library", "index", "--roles"});
  ASSERT_EQ(roles.status, 0);
  ASSERT_TRUE(open(database_)->run_all(roles.out));
  const auto members = open(database_)->ask("SELECT count(*) FROM pg_catalog.pg_roles WHERE rolname LIKE 'wale\\_%' AND NOT rolcanlogin");
  ASSERT_TRUE(members);
  EXPECT_EQ(members->number(0, 0), 3);
}

TEST_F(Commands, SayWhatIsWrong) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"find", "--near", "ribs3", "--index", address()},
           {"show", "ribs3", "--index", "postgresql://anna:secret@127.0.0.1:1/x"},
           {"library", "index", folder_ / "shelf", "-o", "postgresql://anna:secret@127.0.0.1:1/x"},
           {"library", "index", folder_ / "shelf", "-o", folder_ / "x", "--index", address()},
           {"library", "index", folder_ / "shelf", "--forget"}}) {
    const Outcome outcome = wale(words);
    EXPECT_TRUE(outcome.status == 1 || outcome.status == 2) << words[0];
    EXPECT_TRUE(outcome.err.starts_with("wale: ")) << outcome.err;
    EXPECT_FALSE(contains(outcome.err, "secret")) << outcome.err;
    expect_no_password(outcome);
  }
}

}  // namespace
}  // namespace wale::shared_index::commands_test
