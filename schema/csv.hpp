#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// One line of comma-separated values.
struct CsvRow {
  std::size_t line = 0;                 ///< from 1
  std::vector<std::string_view> cells;  ///< of the text, without the blanks and the quotes around them
};

/// Reads comma-separated values row by row. Takes a byte order mark, lines that end in CR LF, and cells in quotes,
/// which may hold commas. Skips lines that are empty or begin with `#`.
class CsvReader {
 public:
  /// The text must outlive the rows.
  explicit CsvReader(std::string_view text);

  /// The next row; empty after the last one. Errors: W0504 for a quote that does not end.
  Result<std::optional<CsvRow>> next();

 private:
  std::string_view rest_;
  std::size_t line_ = 0;
};

/// Calls `take` for each row that is left, until it gives an error. Errors: those of `next` and of `take`.
Result<> each_row(CsvReader& reader, const std::function<Result<>(const CsvRow& row)>& take);

/// The first row, which names the columns. Errors: W0504 if there is no row (the sentence names what was `expected`),
/// or if semicolons or tabs separate the columns.
Result<CsvRow> read_headings(CsvReader& reader, const std::string& expected);

/// A column's name and its unit, which may be empty: "x (mm)", "x [mm]" or "x".
struct CsvHeading {
  std::string_view name, unit;
};
CsvHeading heading_of(std::string_view cell);

/// The column, counted from 0, whose heading `is_meant`; none if there is no such column. `name` is the column's name
/// for errors. Error: W0504 if there are two.
Result<std::optional<std::size_t>> find_column(const CsvRow& headings, std::string_view name,
                                               const std::function<bool(std::string_view heading)>& is_meant);

/// The finite number in a column, counted from 0; `name` is the column's name for errors. Errors: W0504 if the row has
/// no such column, or if the cell is not a finite number.
Result<double> number_in(const CsvRow& row, std::size_t column, std::string_view name);

/// W0504: "expected …, found …". `line` counts from 1; 0 means the text as a whole.
Error unlike_csv(std::size_t line, const std::string& expected, const std::string& found, std::string mend = {});

}  // namespace wale
