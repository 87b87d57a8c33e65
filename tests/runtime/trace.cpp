#include "wale/trace.hpp"

#include <gtest/gtest.h>

namespace wale::trace_test {
namespace {

Trace good(std::string_view text) {
  auto read = read_trace(text);
  if (!read) {
    ADD_FAILURE() << "line " << read.error().place.number.value_or(0) << ": " << read.error().sentence;
    return {};
  }
  return *read;
}

TEST(Trace, ReadsColumnsInAnyOrderAmongOthers) {
  const Trace trace = good("y,note,t,x\n2,a,0,1\n4,b,0.5,3\n");
  ASSERT_EQ(trace.points.size(), 2u);
  EXPECT_EQ(trace.points[1].time, 0.5);
  EXPECT_EQ(trace.points[1].position, glm::dvec2(3, 4));
  EXPECT_FALSE(trace.velocities_given);
}

TEST(Trace, ReadsEverySpellingOfAUnit) {
  for (const char* header : {"t (s),x (mm),y (cm)", "t [s],x [mm],y [cm]", "t_s,x_mm,y_cm", "time, x(mm) , y_cm"}) {
    const Trace trace = good(std::string(header) + "\n1,2,3\n");
    ASSERT_EQ(trace.points.size(), 1u) << header;
    EXPECT_EQ(trace.points[0].time, 1);
    EXPECT_DOUBLE_EQ(trace.points[0].position.x, 0.002) << header;
    EXPECT_DOUBLE_EQ(trace.points[0].position.y, 0.03) << header;
  }
  EXPECT_DOUBLE_EQ(good("t_ms,x,y,vx (mm/s),vy (m/s)\n250,0,0,7,8\n").points[0].velocity.x, 0.007);
}

TEST(Trace, SkipsMarksCommentsBlankLinesAndCarriageReturns) {
  const Trace trace = good("\xef\xbb\xbf# a hand\r\n\r\nt,x,y\r\n# begins\r\n0,+1e-3,2\r\n\r\n1, 3 ,\"4\"");
  ASSERT_EQ(trace.points.size(), 2u);
  EXPECT_EQ(trace.points[0].position, glm::dvec2(0.001, 2));
  EXPECT_EQ(trace.points[1].position, glm::dvec2(3, 4));
}

struct Bad {
  const char* text;
  std::size_t line;
  const char *expected, *found;
};

class BadTrace : public testing::TestWithParam<Bad> {};

TEST_P(BadTrace, TheErrorNamesThePlaceTheExpectedAndTheFound) {
  const auto read = read_trace(GetParam().text);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Code::unreadable_table);
  EXPECT_EQ(read.error().place.number.value_or(0), GetParam().line);
  EXPECT_EQ(read.error().sentence, std::string("expected ") + GetParam().expected + ", found " + GetParam().found);
}

INSTANTIATE_TEST_SUITE_P(
    Traces, BadTrace,
    testing::Values(Bad{"", 0, "a header with the columns t, x, y", "nothing"},
                    Bad{"# only\n\n", 0, "a header with the columns t, x, y", "nothing"},
                    Bad{"t,x,y\n", 0, "at least one line of numbers after the header", "none"},
                    Bad{"0,1,2\n", 1, "a header with the columns t, x, y; missing \"t\"", "\"0,1,2\""},
                    Bad{"# c\nt,x\n", 2, "a header with the columns t, x, y; missing \"y\"", "\"t,x\""},
                    Bad{"t,x,y,x\n", 1, "one column \"x\"", "two, columns 2 and 4"},
                    Bad{"t,x (inch),y\n", 1, "column \"x\" in one of m, cm, mm", "\"inch\""},
                    Bad{"t (h),x,y\n", 1, "column \"t\" in one of s, ms", "\"h\""},
                    Bad{"t,x,y,vx\n", 1, "both vx and vy, or neither", "vx alone"},
                    Bad{"t,x,y\n0,1,2\n\n1,two,3\n", 4, "a finite number for \"x\" in column 2", "\"two\""},
                    Bad{"t,x,y\n0,1\n", 2, "a finite number for \"y\" in column 3", "only 2 columns"},
                    Bad{"t,x,y\n0,,2\n", 2, "a finite number for \"x\" in column 2", "nothing"},
                    Bad{"t,x,y\n0,1 mm,2\n", 2, "a finite number for \"x\" in column 2", "\"1 mm\""},
                    Bad{"t,x,y\n0,nan,2\n", 2, "a finite number for \"x\" in column 2", "\"nan\""},
                    Bad{"t,x,y\n0,1,inf\n", 2, "a finite number for \"y\" in column 3", "\"inf\""},
                    Bad{"t,x,y\n0,1,1e999\n", 2, "a finite number for \"y\" in column 3", "\"1e999\""},
                    Bad{"t,x,y\n0.5,1,2\n0.5,1,2\n", 3, "a time after 0.5 s", "0.5 s"},
                    Bad{"t_ms,x,y\n2,1,2\n1,1,2\n", 3, "a time after 0.002 s", "0.001 s"}));

TEST(Trace, ColumnsWhoseNamesOnlyBeginTheSameAreIgnored) {
  EXPECT_EQ(good("t,x_target,x,y\n0,9,1,2\n").points[0].position, glm::dvec2(1, 2));
}

TEST(Trace, InterpolatesStraightLinesAndParabolasExactly) {
  Trace trace = good("t,x,y\n0,0,5\n0.5,1,5\n2,4,5\n");
  EXPECT_DOUBLE_EQ(at(trace, 0.3).position.x, 0.6);
  EXPECT_DOUBLE_EQ(at(trace, 1.7).position.x, 3.4);
  EXPECT_DOUBLE_EQ(at(trace, 1.7).velocity.x, 2);
  EXPECT_DOUBLE_EQ(at(trace, 1.7).position.y, 5);

  trace = good("t,x,y,vx,vy\n1,1,0,2,0\n3,9,0,6,0\n");  // x = t^2
  EXPECT_DOUBLE_EQ(at(trace, 2.2).position.x, 2.2 * 2.2);
  EXPECT_DOUBLE_EQ(at(trace, 2.2).velocity.x, 4.4);
}

TEST(Trace, DerivedVelocityIsOfParabolasInsideAndOfLinesAtTheEnds) {
  const Trace trace = good("t,x,y\n0,0,0\n1,1,0\n3,9,0\n");  // x = t^2
  EXPECT_DOUBLE_EQ(trace.points[0].velocity.x, 1);
  EXPECT_DOUBLE_EQ(trace.points[1].velocity.x, 2);
  EXPECT_DOUBLE_EQ(trace.points[2].velocity.x, 4);
}

TEST(Trace, RestsBeforeItsBeginningAndAfterItsEnd) {
  const Trace trace = good("t,x,y,vx,vy\n1,1,0,2,0\n3,9,0,6,0\n");
  EXPECT_EQ(at(trace, 0).position.x, 1);
  EXPECT_EQ(at(trace, 0).velocity.x, 0);
  EXPECT_EQ(at(trace, 3).position.x, 9);
  EXPECT_EQ(at(trace, 3).velocity.x, 6);
  EXPECT_EQ(at(trace, 4).position.x, 9);
  EXPECT_EQ(at(trace, 4).velocity.x, 0);
}

}  // namespace
}  // namespace wale::trace_test
