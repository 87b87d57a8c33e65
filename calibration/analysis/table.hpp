#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale::analysis {

/// A table of text: named columns, and rows of cells. It is what spreadsheets, BIDS (tabs, `n/a`) and PsychoPy's wide
/// files are: the separator is the tab, semicolon or comma that the first line has.
class Table {
 public:
  const std::string& file() const { return file_; }
  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t rows() const { return lines_.size(); }
  /// The cell without its quotes and without spaces around it. It points into the table, also after a move.
  std::string_view cell(std::size_t row, std::size_t column) const { return cells_[row * columns_.size() + column]; }
  /// The line of the file that a row begins in, from 1.
  std::size_t line(std::size_t row) const { return lines_[row]; }
  /// The column with that name, or nothing.
  std::optional<std::size_t> column(std::string_view name) const;
  /// The separator is a comma, so that no cell without quotes has a decimal comma.
  bool comma_separates() const { return comma_separates_; }
  /// What was mended while reading, one sentence each: a byte-order mark, empty columns at the end, stray quotes.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  friend class TableReader;
  std::string file_;
  std::unique_ptr<std::string> text_;              // that most cells point into
  std::vector<std::unique_ptr<std::string>> own_;  // texts of cells that have doubled quotes
  std::vector<std::string> columns_;
  std::vector<std::string_view> cells_;
  std::vector<std::size_t> lines_;
  std::vector<std::string> notes_;
  bool comma_separates_ = true;
};

/// Reads a table from the bytes of a file. Lines that begin with `#` before the header are comments; empty lines are
/// skipped. A quote inside a quoted cell that is neither doubled nor before a separator belongs to the cell.
///
/// Errors (W0801), with file and line: no header, no rows, columns without a name or with the same one, a row with more
/// or fewer cells than the header, a quote that never ends, bytes that are no UTF-8 text.
Result<Table> read_table(std::string file, std::string text);

/// Whether a cell says that there is no value: empty, `n/a`, `NA`, `NaN`, `None`, `null` in any case.
bool is_missing(std::string_view cell);

/// The number that a cell is, "12.5", "1e-3", with decimal comma "12,5"; nothing for any other text. Infinity and
/// not-a-number are no numbers.
std::optional<double> number_in(std::string_view cell);

/// An error W0801 at a row of a table.
Error table_error(const Table& table, std::size_t row, std::string sentence, std::string mend = {},
                  std::string_view text = {});

}  // namespace wale::analysis
