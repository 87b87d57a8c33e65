#include "calibration/analysis/table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "schema/utf8.hpp"
#include "schema/visible_text.hpp"

namespace wale::analysis {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\r')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

std::string count_of(std::size_t count, const char* one, const char* more) {
  return std::to_string(count) + " " + (count == 1 ? one : more);
}

}  // namespace

/// Reads one table from front to back.
class TableReader {
 public:
  TableReader(std::string file, std::string text) {
    table_.file_ = std::move(file);
    table_.text_ = std::make_unique<std::string>(std::move(text));
    rest_ = *table_.text_;
  }

  Result<Table> read() {
    if (rest_.starts_with("\xFF\xFE") || rest_.starts_with("\xFE\xFF") || rest_.find('\0') != std::string_view::npos)
      return error(1, "this is no text in UTF-8", "save the table as CSV or TSV in UTF-8");
    // Names in Latin-1 would all become the same: those of people too.
    std::size_t line = 1;
    for (std::size_t at = 0; at < rest_.size();) {
      const Character each = decode(rest_, at);
      if (!each.valid)
        return error(line, "expected text in UTF-8, found a byte that is none, as of Latin-1", "save the table as CSV or TSV in UTF-8");
      line += each.code == '\n' ? 1 : 0;
      at += each.bytes;
    }
    if (rest_.starts_with(byte_order_mark)) {
      rest_.remove_prefix(byte_order_mark.size());
      table_.notes_.push_back("the byte-order mark at the beginning is skipped");
    }
    skip_before_header();
    if (rest_.empty()) return error(line_, "the table is empty", "its first line names the columns");
    choose_separator();
    if (const auto header = read_header(); !header) return header.error();
    if (const auto rows = read_rows(); !rows) return rows.error();
    if (table_.lines_.empty()) return error(line_, "the table has a header and no rows", "");
    drop_nameless_columns();
    if (nameless_) return std::move(*nameless_);
    if (stray_quotes_ > 0)
      table_.notes_.push_back(count_of(stray_quotes_, "cell has a quote", "cells have quotes") +
                              " that are not doubled; they are taken as part of the text");
    if (empty_lines_ > 0) table_.notes_.push_back(count_of(empty_lines_, "empty line is", "empty lines are") + " skipped");
    if (longer_rows_ > 0)
      table_.notes_.push_back(count_of(longer_rows_, "row ends", "rows end") +
                              " with separators beyond the last column, which are skipped");
    return std::move(table_);
  }

 private:
  Error error(std::size_t line, std::string sentence, std::string mend) const {
    return Error{.code = Code::malformed_value,
                 .sentence = std::move(sentence),
                 .mend = std::move(mend),
                 .place = {.name = table_.file_, .number = line}};
  }

  bool at_line_end() const { return rest_.empty() || rest_.front() == '\n' || rest_.starts_with("\r\n"); }
  void take_line_end() {
    if (rest_.starts_with("\r\n")) rest_.remove_prefix(2);
    else if (!rest_.empty()) rest_.remove_prefix(1);
    ++line_;
  }

  void skip_before_header() {
    while (!rest_.empty()) {
      const std::string_view line = rest_.substr(0, rest_.find('\n'));
      if (!line.starts_with('#') && !trimmed(line).empty()) return;
      rest_.remove_prefix(std::min(rest_.size(), line.size() + 1));
      ++line_;
    }
  }

  void choose_separator() {
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    std::size_t most = 0;
    for (const char each : {'\t', ';', ','}) {
      bool quoted = false;
      std::size_t count = 0;
      for (const char c : line) {
        if (c == '"') quoted = !quoted;
        if (c == each && !quoted) ++count;
      }
      if (count > most) most = count, separator_ = each;
    }
    table_.comma_separates_ = separator_ == ',';
  }

  /// Takes a cell, and not what ends it. Nothing if a quote never ends.
  std::optional<std::string_view> take_cell() {
    std::size_t begin = 0;
    while (begin < rest_.size() && rest_[begin] == ' ') ++begin;
    if (begin == rest_.size() || rest_[begin] != '"') {
      std::size_t end = 0;
      while (end < rest_.size() && rest_[end] != separator_ && rest_[end] != '\n') ++end;
      const std::string_view cell = rest_.substr(0, end);
      rest_.remove_prefix(end > 0 && end < rest_.size() && rest_[end] == '\n' && cell.back() == '\r' ? end - 1 : end);
      return trimmed(cell);
    }
    bool doubled = false, stray = false;
    std::size_t lines = 0;
    for (std::size_t at = begin + 1; at < rest_.size(); ++at) {
      if (rest_[at] == '\n') ++lines;
      if (rest_[at] != '"') continue;
      std::size_t next = at + 1;
      while (next < rest_.size() && (rest_[next] == ' ' || rest_[next] == '\r')) ++next;
      if (next == rest_.size() || rest_[next] == separator_ || rest_[next] == '\n') {
        std::string_view cell = rest_.substr(begin + 1, at - begin - 1);
        rest_.remove_prefix(next);
        line_ += lines;
        stray_quotes_ += stray ? 1 : 0;
        if (!doubled) return cell;
        auto own = std::make_unique<std::string>();
        for (std::size_t i = 0; i < cell.size(); ++i) {
          *own += cell[i];
          if (cell[i] == '"' && i + 1 < cell.size() && cell[i + 1] == '"') ++i;
        }
        table_.own_.push_back(std::move(own));
        return *table_.own_.back();
      }
      if (rest_[at + 1] == '"') {
        doubled = true;
        ++at;
      } else {
        stray = true;
      }
    }
    return std::nullopt;
  }

  Result<> read_header() {
    const std::size_t line = line_;
    for (;;) {
      const auto cell = take_cell();
      if (!cell) return error(line, "a quote begins in the header and never ends", "close it, or remove it");
      table_.columns_.emplace_back(*cell);
      if (at_line_end()) break;
      rest_.remove_prefix(1);
    }
    take_line_end();
    std::unordered_map<std::string_view, std::size_t> seen;
    for (std::size_t i = 0; i < table_.columns_.size(); ++i) {
      const std::string& name = table_.columns_[i];
      if (name.empty()) continue;
      if (!seen.try_emplace(name, i).second)
        return error(line, "two columns are called `" + visible_text(name) + "`", "rename one of them");
    }
    if (seen.empty()) return error(line, "no column has a name", "the first line names the columns");
    header_line_ = line;
    return {};
  }

  Result<> read_rows() {
    const std::size_t width = table_.columns_.size();
    while (!rest_.empty()) {
      const std::size_t line = line_;
      if (at_line_end()) {
        take_line_end();
        empty_lines_ += rest_.empty() ? 0 : 1;
        continue;
      }
      const std::size_t first = table_.cells_.size();
      bool beyond = false;
      for (std::size_t count = 0;; ++count) {
        const auto cell = take_cell();
        if (!cell) return error(line, "a quote begins in this row and never ends", "close it, or remove it");
        if (count < width) table_.cells_.push_back(*cell);
        else if (cell->empty()) beyond = true;
        else
          return error(line,
                       "this row has more cells than the header, which names " +
                           count_of(width, "column", "columns"),
                       "put cells that hold a separator into quotes");
        if (at_line_end()) break;
        rest_.remove_prefix(1);
      }
      const std::size_t found = table_.cells_.size() - first;
      if (found < width) {
        const bool blank = found == 1 && table_.cells_.back().empty();
        if (!blank)
          return error(line, "this row has " + count_of(found, "cell", "cells") + ", and the header names " +
                                 count_of(width, "column", "columns"),
                       "write n/a for a missing value");
        table_.cells_.resize(first);
        ++empty_lines_;
      } else {
        table_.lines_.push_back(line);
        longer_rows_ += beyond ? 1 : 0;
      }
      take_line_end();
    }
    return {};
  }

  /// Columns without a name at the end are dropped if they are empty.
  void drop_nameless_columns() {
    const std::size_t width = table_.columns_.size();
    std::size_t kept = width;
    while (kept > 0 && table_.columns_[kept - 1].empty()) --kept;
    for (std::size_t column = 0; column < width; ++column) {
      if (!table_.columns_[column].empty()) continue;
      for (std::size_t row = 0; row < table_.rows(); ++row)
        if (!table_.cell(row, column).empty() || column < kept) {
          nameless_ = error(column < kept ? header_line_ : table_.line(row),
                            "column " + std::to_string(column + 1) + " has no name", "name it in the header");
          return;
        }
    }
    if (kept == width) return;
    std::vector<std::string_view> cells;
    cells.reserve(table_.rows() * kept);
    for (std::size_t row = 0; row < table_.rows(); ++row)
      for (std::size_t column = 0; column < kept; ++column) cells.push_back(table_.cell(row, column));
    table_.cells_ = std::move(cells);
    table_.columns_.resize(kept);
    table_.notes_.push_back(count_of(width - kept, "empty column", "empty columns") + " at the end without a name " + (width - kept == 1 ? "is" : "are") + " skipped");
  }

  Table table_;
  std::string_view rest_;
  char separator_ = ',';
  std::size_t line_ = 1, header_line_ = 1, stray_quotes_ = 0, empty_lines_ = 0, longer_rows_ = 0;
  std::optional<Error> nameless_;
};

std::optional<std::size_t> Table::column(std::string_view name) const {
  const auto found = std::ranges::find(columns_, name);
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

Result<Table> read_table(std::string file, std::string text) {
  return TableReader(std::move(file), std::move(text)).read();
}

bool is_missing(std::string_view cell) {
  if (cell.size() > 4) return false;
  std::string lower(cell);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower.empty() || lower == "n/a" || lower == "na" || lower == "nan" || lower == "none" || lower == "null";
}

std::optional<double> number_in(std::string_view cell) {
  std::array<char, 64> copy{};
  if (cell.empty() || cell.size() >= copy.size()) return std::nullopt;
  const char* begin = cell.data();
  const char* end = begin + cell.size();
  if (const auto comma = cell.find(','); comma != std::string_view::npos) {
    if (cell.find(',', comma + 1) != std::string_view::npos || cell.find('.') != std::string_view::npos)
      return std::nullopt;
    std::memcpy(copy.data(), begin, cell.size());
    copy[comma] = '.';
    begin = copy.data(), end = begin + cell.size();
  }
  if (*begin == '+' && end - begin > 1 && begin[1] != '-') ++begin;
  double value = 0;
  const auto [stop, trouble] = std::from_chars(begin, end, value);
  if (trouble != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

Error table_error(const Table& table, std::size_t row, std::string sentence, std::string mend, std::string_view text) {
  return Error{.code = Code::malformed_value,
               .sentence = std::move(sentence),
               .mend = std::move(mend),
               .place = {.name = table.file(), .number = table.line(row), .text = std::string(text)}};
}

}  // namespace wale::analysis
