#include "schema/csv.hpp"

#include <gtest/gtest.h>

namespace wale::csv_test {
namespace {

std::vector<std::vector<std::string>> rows_of(std::string_view text) {
  CsvReader reader(text);
  std::vector<std::vector<std::string>> all;
  while (true) {
    const auto row = reader.next();
    if (!row) return {{row.error().sentence}};
    if (!*row) return all;
    all.emplace_back((*row)->cells.begin(), (*row)->cells.end());
  }
}

using Rows = std::vector<std::vector<std::string>>;

TEST(Csv, ReadsCellsWithoutBlanksAndQuotes) {
  EXPECT_EQ(rows_of("x, y\n1 ,\t2\n"), (Rows{{"x", "y"}, {"1", "2"}}));
  EXPECT_EQ(rows_of("\"x, of the hand\",\"2\""), (Rows{{"x, of the hand", "2"}}));
  EXPECT_EQ(rows_of("1,,\n"), (Rows{{"1", "", ""}}));
}

TEST(Csv, AcceptsByteOrderMarksWindowsLineEndsCommentsAndEmptyLines) {
  EXPECT_EQ(rows_of("\xef\xbb\xbfx,y\r\n\r\n# measured\r\n1,2\r\n"), (Rows{{"x", "y"}, {"1", "2"}}));
  EXPECT_EQ(rows_of(""), Rows{});
  EXPECT_EQ(rows_of("\xef\xbb\xbf"), Rows{});
}

TEST(Csv, SaysWhereAQuoteDoesNotEnd) {
  CsvReader reader("x,y\n\n\"1,2\n");
  ASSERT_TRUE(reader.next());
  const auto row = reader.next();
  ASSERT_FALSE(row);
  EXPECT_EQ(row.error().code, Code::unreadable_table);
  EXPECT_EQ(row.error().place.number, 3u);
  EXPECT_EQ(row.error().sentence, "expected a quote at the end of the cell, found \"\"1,2\"");
}

TEST(Csv, TellsOtherSeparatorsFromCommas) {
  const auto complaint = [](std::string_view text) {
    CsvReader reader(text);
    const auto headings = read_headings(reader, "headings");
    return headings ? "" : headings.error().sentence;
  };
  EXPECT_EQ(complaint("x;y\n1;2\n"), "expected commas between the columns, found semicolons");
  EXPECT_EQ(complaint("x\ty\n1\t2\n"), "expected commas between the columns, found tabs");
  EXPECT_EQ(complaint("# nothing else\n"), "expected headings, found nothing");
  EXPECT_EQ(complaint("x,y\n"), "");
}

TEST(Csv, FindsTheOneColumnThatIsMeant) {
  const CsvRow headings{.line = 3, .cells = {"t (s)", "x (mm)", "y", "x (m)"}};
  const auto called = [&](std::string_view name) {
    return find_column(headings, name, [&](std::string_view heading) { return heading_of(heading).name == name; });
  };
  EXPECT_EQ(*called("t"), 0u);
  EXPECT_EQ(*called("y"), 2u);
  EXPECT_EQ(*called("z"), std::nullopt);
  const auto two = called("x");
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().code, Code::unreadable_table);
  EXPECT_EQ(two.error().place.number, 3u);
  EXPECT_EQ(two.error().sentence, "expected one column \"x\", found two, columns 2 and 4");
}

TEST(Csv, ReadsFiniteNumbersOnly) {
  const CsvRow row{.line = 7, .cells = {"+1.5e-3", "two", "nan", "inf", "1e999", "", "0.5 mm", "-2"}};
  EXPECT_EQ(*number_in(row, 0, "x"), 1.5e-3);
  EXPECT_EQ(*number_in(row, 7, "x"), -2);
  for (std::size_t column = 1; column < 7; ++column) {
    const auto number = number_in(row, column, "x");
    ASSERT_FALSE(number) << column;
    EXPECT_EQ(number.error().place.number, 7u);
  }
  EXPECT_EQ(number_in(row, 1, "x").error().sentence, "expected a finite number for \"x\" in column 2, found \"two\"");
  EXPECT_EQ(number_in(row, 5, "x").error().sentence, "expected a finite number for \"x\" in column 6, found nothing");
  EXPECT_EQ(number_in(row, 8, "x").error().sentence,
            "expected a finite number for \"x\" in column 9, found only 8 columns");
}

TEST(Csv, SplitsHeadingsIntoNameAndUnit) {
  for (const char* text : {"x (mm)", "x [mm]", "x(mm)", "x ( mm )"}) {
    EXPECT_EQ(heading_of(text).name, "x") << text;
    EXPECT_EQ(heading_of(text).unit, "mm") << text;
  }
  EXPECT_EQ(heading_of("count").name, "count");
  EXPECT_EQ(heading_of("count").unit, "");
}

}  // namespace
}  // namespace wale::csv_test
