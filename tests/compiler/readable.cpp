// Numbers as people write them.
#include "compiler/text/readable.hpp"

#include <gtest/gtest.h>

namespace wale::readable_test {
namespace {

TEST(Readable, GroupsFiveDigitsAndMore) {
  EXPECT_EQ(readable("{:.4g} N in {:.0f} steps", 20.0, 32767.0), "20 N in 32 767 steps");
  EXPECT_EQ(readable("{} {} {}", 9999, 10000, -1234567L), "9999 10 000 -1 234 567");
  EXPECT_EQ(readable("{:.1f} {:.3f}", 12345.67, 0.123456), "12 345.7 0.123");
}

TEST(Readable, HasNoExponents) {
  EXPECT_EQ(readable("{:.4g}", 32767.0), "32 767") << "a whole number has all its digits";
  EXPECT_EQ(readable("{:.3g}", 367891.2), "368 000");
  EXPECT_EQ(readable("{:.2g} {:.3g}", 0.00002, 0.0000123), "0.00002 0.0000123");
  EXPECT_EQ(readable("{:.3g} {:.3g}", 1e20, 1e-9), "1e+20 1e-09") << "nobody writes these out";
  EXPECT_EQ(readable("{:.3g}", HUGE_VAL), "inf");
}

TEST(Readable, KeepsColumns) {
  EXPECT_EQ(readable("|{:>9}|{:<9}|{:^9}|", 12345, 12345, 12345), "|   12 345|12 345   |  12 345 |");
  EXPECT_EQ(readable("|{:>6}|", 12345), "|12 345|");
  EXPECT_EQ(readable("|{:>5}|", 12345), "|12 345|") << "as wide as it must be";
}

TEST(Readable, LeavesTextsAlone) {
  EXPECT_EQ(readable("{} {} {:<7}|", std::string("12345"), true, "ab"), "12345 true ab     |");
  EXPECT_EQ(readable("{:06x}", 0x12345), "012345");
}

}  // namespace
}  // namespace wale::readable_test
