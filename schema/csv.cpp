#include "schema/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace wale {
namespace {

constexpr std::string_view blank = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  return '"' + std::string(text.substr(0, longest)) + (text.size() > longest ? "…\"" : "\"");
}

/// Takes one cell and the comma behind it from the front of `line`, and sets `more` if there was a comma. Returns
/// nullopt if a quote does not end.
std::optional<std::string_view> take_cell(std::string_view& line, bool& more) {
  line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
  std::size_t from = 0;
  if (line.starts_with('"')) {
    from = line.find('"', 1);
    if (from == std::string_view::npos) return std::nullopt;
  }
  const std::size_t comma = line.find(',', from);
  std::string_view cell = trimmed(line.substr(0, comma));
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
  more = comma != std::string_view::npos;
  line.remove_prefix(more ? comma + 1 : line.size());
  return cell;
}

}  // namespace

Error unlike_csv(std::size_t line, const std::string& expected, const std::string& found, std::string mend) {
  Error error{Code::unreadable_table, "expected " + expected + ", found " + found, std::move(mend)};
  if (line > 0) error.place.number = line;
  return error;
}

CsvReader::CsvReader(std::string_view text) : rest_(text) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

Result<std::optional<CsvRow>> CsvReader::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    std::string_view line = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    if (line.empty() || line.starts_with('#')) continue;
    CsvRow row{.line = line_};
    const std::string_view whole = line;
    for (bool more = true; more;) {
      const auto cell = take_cell(line, more);
      if (!cell) return unlike_csv(line_, "a quote at the end of the cell", quoted(whole), "close the cell with `\"`");
      row.cells.push_back(*cell);
    }
    return std::optional(std::move(row));
  }
  return std::optional<CsvRow>();
}

Result<> each_row(CsvReader& reader, const std::function<Result<>(const CsvRow& row)>& take) {
  while (true) {
    const auto row = reader.next();
    if (!row) return row.error();
    if (!*row) return {};
    if (auto taken = take(**row); !taken) return taken;
  }
}

Result<CsvRow> read_headings(CsvReader& reader, const std::string& expected) {
  auto row = reader.next();
  if (!row) return row.error();
  if (!*row) return unlike_csv(0, expected, "nothing");
  const std::string_view first = (*row)->cells.front();
  const bool alone = (*row)->cells.size() == 1;
  if (alone && first.find_first_of(";\t") != std::string_view::npos)
    return unlike_csv((*row)->line, "commas between the columns",
                      first.find(';') != std::string_view::npos ? "semicolons" : "tabs",
                      "save the table with commas, and its numbers with points, as in 0.25");
  return std::move(**row);
}

CsvHeading heading_of(std::string_view cell) {
  const std::size_t open = cell.find_first_of("([");
  if (open == std::string_view::npos) return {cell, {}};
  std::string_view unit = cell.substr(open + 1);
  if (unit.ends_with(cell[open] == '(' ? ')' : ']')) unit.remove_suffix(1);
  return {trimmed(cell.substr(0, open)), trimmed(unit)};
}

Result<std::optional<std::size_t>> find_column(const CsvRow& headings, std::string_view name,
                                               const std::function<bool(std::string_view heading)>& is_meant) {
  std::optional<std::size_t> found;
  for (std::size_t column = 0; column < headings.cells.size(); ++column) {
    if (!is_meant(headings.cells[column])) continue;
    if (found)
      return unlike_csv(headings.line, "one column " + quoted(name),
                        "two, columns " + std::to_string(*found + 1) + " and " + std::to_string(column + 1),
                        "rename or remove one of them");
    found = column;
  }
  return found;
}

Result<double> number_in(const CsvRow& row, std::size_t column, std::string_view name) {
  const std::string expected = "a finite number for " + quoted(name) + " in column " + std::to_string(column + 1);
  const char* mend = "write numbers with a point, as in 0.25";
  if (column >= row.cells.size()) {
    const std::string count = std::to_string(row.cells.size());
    return unlike_csv(row.line, expected, "only " + count + (row.cells.size() == 1 ? " column" : " columns"));
  }
  std::string_view cell = row.cells[column];
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  // Programs compute in single precision, where a larger number would be infinite.
  const bool fits = std::abs(value) <= std::numeric_limits<float>::max();
  if (error == std::errc{} && std::isfinite(value) && !fits) mend = "give a number below 3.4e38";
  if (error != std::errc{} || end != cell.data() + cell.size() || !fits)
    return unlike_csv(row.line, expected, row.cells[column].empty() ? "nothing" : quoted(row.cells[column]), mend);
  return value;
}

}  // namespace wale
