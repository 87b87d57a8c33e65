// Readings as people type them: in a table, of which every wrong row is named, and in a terminal, where an answer can
// be taken back.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "calibration/device/ask_for_forces.hpp"
#include "calibration/device/force_table.hpp"

namespace wale::measuring::tables_test {
namespace {

/// A table as rows of cells, the header first.
using Rows = std::vector<std::vector<std::string>>;

Rows good_rows() {
  Rows rows{{"axis", "direction", "command (N)", "reading (N)", "repeat"}};
  for (const char* way : {"right", "left", "away", "toward"})
    for (const char* command : {"0", "0.5", "1", "2", "4", "8"})
      for (const char* repeat : {"1", "2"})
        rows.push_back({*way == 'r' || *way == 'l' ? "x" : "y", way, command, command, repeat});
  return rows;
}

std::string text_of(const Rows& rows) {
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + row[i];
    text += '\n';
  }
  return text;
}

TEST(ForceTables, AreRead) {
  const auto table = read_force_table("t.csv", text_of(good_rows()), 10);
  ASSERT_TRUE(table) << table.error().sentence;
  ASSERT_EQ(table->readings.size(), 48u);
  EXPECT_EQ(table->readings[13].way, Way::left);
  EXPECT_FALSE(table->is_simulated);
  const auto other =
      read_force_table("t.csv", "axis;direction;command;reading\nx;right;20 %;102 gf\ny;toward;50 %;1000 gf\n", 10);
  ASSERT_TRUE(other) << other.error().sentence;
  EXPECT_DOUBLE_EQ(other->readings[0].command, 2);
  EXPECT_NEAR(other->readings[0].newton, 1.0003, 1e-4);
  const auto weights = read_force_table("t.csv", "axis,direction,command (N),reading (kg)\ny,toward,9,1\n", 10);
  ASSERT_TRUE(weights);
  EXPECT_DOUBLE_EQ(weights->readings[0].newton, 9.80665);
  const auto again = read_force_table("t.csv", force_table_text(table->readings, true), 10);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->is_simulated) << "what came from a simulation stays so";
  EXPECT_EQ(again->readings.size(), 48u);
}

/// Each way to make a table wrong, at every row that it can be done to.
TEST(ForceTables, EachWrongRowIsNamed) {
  struct Mistake {
    const char* name;
    std::function<void(std::vector<std::string>&)> make;
    const char* says;
  };
  const std::vector<Mistake> mistakes{
      {"a word", [](auto& row) { row[3] = "strong"; }, "expected a number with its unit, found \"strong\""},
      {"nothing", [](auto& row) { row[3] = ""; }, "expected a number with its unit, found nothing"},
      {"not a number", [](auto& row) { row[2] = "nan"; }, "expected a number with its unit"},
      {"infinity", [](auto& row) { row[3] = "inf"; }, "expected a number with its unit"},
      {"another unit", [](auto& row) { row[3] += " gf"; }, "the reading is in gf, and the header says N"},
      {"an unknown unit", [](auto& row) { row[3] += " stone"; }, "\"stone\" is no unit of force"},
      {"a wrong axis", [](auto& row) { row[0] = "z"; }, "expected the axis x or y, found \"z\""},
      {"a wrong direction", [](auto& row) { row[1] = "up"; }, "expected a direction"},
      {"the other axis", [](auto& row) { row[0] = row[0] == "x" ? "y" : "x"; }, "is no direction of the axis"},
      {"a negative command", [](auto& row) { row[2] = "-1"; }, "a command must be from 0 N"},
      {"too large a command", [](auto& row) { row[2] = "11"; }, "a command must be from 0 N"},
      {"half a round", [](auto& row) { row[4] = "1.5"; }, "expected the number of a round"},
      {"no round", [](auto& row) { row[4] = "0"; }, "expected the number of a round"},
      {"a cell too few", [](auto& row) { row.pop_back(); }, "cells, and the header names"},
      {"a cell too many", [](auto& row) { row.push_back("7"); }, "more cells than the header"},
      {"a terminal's escape", [](auto& row) { row[3] = "\x1b[2J"; }, "\\u001b[2J"}};
  const Rows good = good_rows();
  for (const Mistake& mistake : mistakes)
    for (std::size_t row = 1; row < good.size(); row += 5) {
      Rows rows = good;
      mistake.make(rows[row]);
      const auto table = read_force_table("t.csv", text_of(rows), 10);
      ASSERT_FALSE(table) << mistake.name << ", row " << row;
      EXPECT_EQ(table.error().code, Code::malformed_value) << mistake.name;
      EXPECT_EQ(table.error().place.name, "t.csv") << mistake.name;
      EXPECT_EQ(table.error().place.number, row + 1) << mistake.name;
      EXPECT_NE(table.error().sentence.find(mistake.says), std::string::npos)
          << mistake.name << ": " << table.error().sentence;
      EXPECT_FALSE(table.error().mend.empty()) << mistake.name;
    }
  for (std::size_t row = 1; row < good.size(); row += 7) {
    Rows rows = good;
    rows.push_back(good[row]);
    const auto table = read_force_table("t.csv", text_of(rows), 10);
    ASSERT_FALSE(table);
    EXPECT_EQ(table.error().place.number, good.size() + 1);
    EXPECT_NE(table.error().sentence.find("the first is in line " + std::to_string(row + 1)), std::string::npos)
        << table.error().sentence;
  }
}

TEST(ForceTables, WrongHeadersAreRefused) {
  const auto refused = [](const std::string& header) {
    const auto table = read_force_table("t.csv", header + "\nx,right,1,1\n", 10);
    return table ? std::string("it is read") : table.error().sentence;
  };
  EXPECT_EQ(refused("axis,direction,command (N),reading (N)"), "it is read");
  EXPECT_NE(refused("axis,direction,command,reading (N)").find("the unit is missing"), std::string::npos);
  EXPECT_NE(refused("axis,direction,command (N),force (N)").find("found \"force (N)\""), std::string::npos);
  EXPECT_NE(refused("axis,direction,command (N),comment").find("found \"comment\""), std::string::npos);
  EXPECT_NE(refused("axis,way,command (N),reading (N)").find("found \"way\""), std::string::npos);
  EXPECT_NE(refused("axis (m),direction,command (N),reading (N)").find("axis (m)"), std::string::npos);
  EXPECT_NE(refused("axis,direction,command (N),command (%)").find("command (%)"), std::string::npos);
  EXPECT_NE(refused("axis,direction,command (N),axis").find("two columns"), std::string::npos);
  EXPECT_FALSE(read_force_table("t.csv", "", 10));
  EXPECT_FALSE(read_force_table("t.csv", "axis,direction,command (N),reading (N)\n", 10));
  EXPECT_FALSE(read_force_table("t.csv", "axis,direction,command (N)\nx,right,1\n", 10));
}

TEST(ForceTables, UnitsMayNotBeMixed) {
  const auto table =
      read_force_table("t.csv", "axis,direction,command,reading\nx,right,1 N,1 N\nx,right,2 N,204 gf\n", 10);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().sentence, "the reading is in gf, and that of line 2 in N");
  EXPECT_EQ(table.error().place.number, 3u);
}

/// Any bytes are an answer or an error, and never anything else.
TEST(ForceTables, AnyBytesAreRead) {
  std::uint32_t state = 12345;
  const auto next = [&] { return (state = state * 1664525 + 1013904223) >> 16; };
  const std::string good = text_of(good_rows());
  const std::string letters = "axyrightle,;\t\n\r\"0123456789.-+eNgf%() \xc3\xa9\x01";
  for (int round = 0; round < 2000; ++round) {
    std::string text = good;
    for (std::uint32_t changes = 1 + next() % 4; changes > 0; --changes) {
      const std::size_t at = next() % text.size();
      switch (next() % 3) {
        case 0: text[at] = letters[next() % letters.size()]; break;
        case 1: text.erase(at, 1 + next() % 20); break;
        default: text.insert(at, 1, letters[next() % letters.size()]);
      }
      if (text.empty()) text = good;
    }
    const auto table = read_force_table("t.csv", text, 10);
    if (!table) {
      EXPECT_EQ(table.error().place.name, "t.csv") << text;
      continue;
    }
    for (const GaugeReading& each : table->readings) {
      EXPECT_TRUE(std::isfinite(each.newton) && each.command >= 0 && each.command <= 10 * (1 + 1e-9)) << text;
      EXPECT_GE(each.repeat, 1);
    }
  }
}

TEST(AskingForForces, AMistypedAnswerIsTakenBack) {
  const std::vector<GaugeStep> steps{{Way::right, 0, 1}, {Way::right, 5, 1}, {Way::left, 1, 1}, {Way::left, 5, 1}};
  // The second answer is mistyped, taken back and given again; one has no number; the rest of the left is skipped.
  std::istringstream in("\n0.01 N\n\n50\nback\n\nfive\nagain\n\n4.9\n\n0.9\nskip\n");
  std::ostringstream out;
  int pushes = 0;
  const auto asked = ask_for_forces(steps, in, out, [&](const GaugeStep& step) -> Result<double> {
    ++pushes;
    return step.command;
  });
  ASSERT_TRUE(asked) << asked.error().sentence << out.str();
  ASSERT_EQ(asked->readings.size(), 3u) << out.str();
  EXPECT_DOUBLE_EQ(asked->readings[1].newton, 4.9) << "in the unit that was said first";
  EXPECT_DOUBLE_EQ(asked->readings[1].command, 5);
  EXPECT_EQ(asked->readings[2].way, Way::left);
  EXPECT_EQ(pushes, 5);
  EXPECT_NE(out.str().find("taken back: right at 5 N, 50 N"), std::string::npos) << out.str();
  EXPECT_NE(out.str().find("expected a number with its unit, found \"five\""), std::string::npos);
  EXPECT_NE(out.str().find("left, along x, round 1, command 1 N"), std::string::npos);
}

TEST(AskingForForces, AnAnswerNeedsAUnitOnce) {
  std::istringstream in("\n1\n102 gf\n\nq\n");
  std::ostringstream out;
  const auto asked = ask_for_forces(std::vector<GaugeStep>{{Way::right, 1, 1}, {Way::right, 2, 1}}, in, out,
                                    [](const GaugeStep& step) -> Result<double> { return step.command; });
  EXPECT_NE(out.str().find("the unit is missing in \"1\""), std::string::npos) << out.str();
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code, Code::stopped);
}

TEST(AskingForForces, EachWayHasFourteenCommandsTwice) {
  const auto steps = force_steps(8);
  ASSERT_EQ(steps.size(), 112u);
  EXPECT_EQ(steps.front().command, 0);
  EXPECT_EQ(steps[13].command, 8);
  EXPECT_EQ(steps[14].command, 8) << "then downward";
  EXPECT_EQ(steps[14].repeat, 2);
}

}  // namespace
}  // namespace wale::measuring::tables_test
