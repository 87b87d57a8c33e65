#include "wale/result.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace wale::result_test {
namespace {

struct Stick {
  virtual ~Stick() = default;
};
struct Falcon : Stick {};

Result<std::unique_ptr<Stick>> open(bool is_there) {
  if (!is_there) return Error{.code = Code::absent_device, .sentence = "no stick is plugged in", .mend = "plug one in"};
  return std::make_unique<Falcon>();
}

TEST(Result, HoldsAValueOrAnError) {
  auto opened = open(true);
  ASSERT_TRUE(opened);
  EXPECT_NE(dynamic_cast<Falcon*>(opened->get()), nullptr);
  const auto absent = open(false);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, Code::absent_device);
  EXPECT_EQ(absent.error().mend, "plug one in");
}

TEST(Result, OfNothingIsDoneOrAnError) {
  const auto write = [](bool can) -> Result<> {
    if (can) return {};
    return Error{.code = Code::unwritable_file, .sentence = "the disk is full", .place = {.name = "a.wpp"}};
  };
  EXPECT_TRUE(write(true));
  ASSERT_FALSE(write(false));
  EXPECT_EQ(write(false).error().place.name, "a.wpp");
}

TEST(Result, MovesItsValueOut) {
  Result<std::string> text = std::string(100, 'x');
  const std::string moved = *std::move(text);
  EXPECT_EQ(moved, std::string(100, 'x'));
}

TEST(Result, ATextIsAValueAndNoError) {
  const Result<std::string> text = "corduroy";
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, "corduroy");
}

TEST(Codes, HaveNamesAndTitles) {
  EXPECT_EQ(code_name(Code::wrong_dimension), "W0301");
  EXPECT_EQ(code_name(Code::absent_device), "W0701");
  EXPECT_EQ(severity_of(Code::saturates), Severity::warning);
  EXPECT_FALSE(code_title(Code::other_device).empty());
}

TEST(Codes, OfNumbersThatNobodyKnowsHaveNoTitle) {
  for (const unsigned number : {999u, 10000u, 4000000000u}) {
    EXPECT_EQ(code_name(Code(number)), "W" + std::string(number < 1000 ? "0" : "") + std::to_string(number));
    EXPECT_EQ(code_title(Code(number)), "");
    EXPECT_EQ(severity_of(Code(number)), Severity::error);
  }
}

TEST(Errors, AreInWordsThatATerminalShows) {
  const std::string obeyed = "a\nb\x1b[31m\u202ec\xff\r";
  Error error{.code = Code::unreadable_file, .sentence = "s " + obeyed, .mend = obeyed, .place = {.name = obeyed, .number = 3}};
  error.led_to = {{.name = obeyed, .text = obeyed, .source = obeyed}};
  const std::string shown = "a\\u000ab\\u001b[31m\\u202ec\uFFFD\\u000d";
  // This project writes sentences and mends: a line break in a sentence becomes a blank, and a mend keeps the lines that
  // it has to copy.
  std::string sentence = shown, mend = shown;
  sentence.replace(sentence.find("\\u000a"), 6, " ");
  mend.replace(mend.find("\\u000a"), 6, "\n");
  EXPECT_EQ(in_words(error), shown + ":3: s " + sentence + "; " + mend);
  EXPECT_EQ(explained(error), in_words(error) + "\n  " + shown + "  " + shown + "  (" + shown + ")\n");
}

}  // namespace
}  // namespace wale::result_test
