#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "schema/result.hpp"

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

  /// The next row; none at the end. Errors: W0504 for a quote that does not end.
  Result<std::optional<CsvRow>> next();

 private:
  std::string_view rest_;
  std::size_t line_ = 0;
};

/// The first row, which names the columns. Errors: W0504 where there is none (the sentence says what was `expected`),
/// and where the columns are separated by semicolons or tabs.
Result<CsvRow> read_headings(CsvReader& reader, const std::string& expected);

/// "x (mm)", "x [mm]" or "x" as a name and a unit, which may be empty.
struct CsvHeading {
  std::string_view name, unit;
};
CsvHeading heading_of(std::string_view cell);

/// The column, counted from 0, whose heading `is_meant`; none where there is no such column. `name` is what people call
/// it. Error: W0504 where there are two.
Result<std::optional<std::size_t>> find_column(const CsvRow& headings, std::string_view name,
                                               const std::function<bool(std::string_view heading)>& is_meant);

/// The finite number in a column, counted from 0, whose name is `name`. Errors: W0504 where the row has no such column
/// or the cell is not a finite number.
Result<double> number_in(const CsvRow& row, std::size_t column, std::string_view name);

/// W0504: "expected …, found …", at a line or, with 0, in the text as a whole.
Error unlike_csv(std::size_t line, const std::string& expected, const std::string& found, std::string mend = {});

}  // namespace wale
