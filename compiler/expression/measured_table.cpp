#include "compiler/expression/measured_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compiler/expression/check_expression.hpp"
#include "compiler/parse/parse.hpp"

namespace wale {

namespace {

constexpr std::size_t most_rows = 1'000'000;
constexpr double most_samples = 8192;
/// Spacings that differ by less than this share are the rounding of whoever wrote the file.
constexpr double equal_spacing = 1e-4;

struct Column {
  std::string name;
  std::string unit;  ///< as written; empty for plain numbers
};

struct Point {
  double place, value;
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> all;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    all.push_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  return all;
}

Column column_of(std::string_view heading) {
  const auto open = heading.find('(');
  if (open == std::string_view::npos || !heading.ends_with(')')) return {std::string(heading), ""};
  return {std::string(trimmed(heading.substr(0, open))),
          std::string(trimmed(heading.substr(open + 1, heading.size() - open - 2)))};
}

std::optional<double> number(std::string_view text) {
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (copy.empty() || end != copy.c_str() + copy.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// What one of a unit is, or nothing.
std::optional<Unit> unit_of(const std::string& text, const Declarations& declarations) {
  if (text.empty()) return Unit{};
  SourceSet sources;
  Diagnostics diagnostics;
  SyntaxTree tree;
  const SourceId source = sources.add("unit", "1 " + text);
  const auto expressions = parse_expressions(sources, source, tree, diagnostics);
  if (expressions.size() != 1) return std::nullopt;
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker({sources, declarations, diagnostics}, terms, tables);
  Scope scope;
  const Value value = checker.check(tree, expressions[0], scope);
  const auto factor = value.type == Value::Type::number ? constant_value(terms, value.x) : std::nullopt;
  if (!factor || !(*factor > 0)) return std::nullopt;
  return Unit{*factor, value.dimension};
}

double interpolated(const std::vector<Point>& points, double place) {
  const auto after = std::ranges::upper_bound(points, place, {}, &Point::place);
  if (after == points.begin()) return points.front().value;
  if (after == points.end()) return points.back().value;
  const auto& [x0, y0] = *(after - 1);
  const auto& [x1, y1] = *after;
  return y0 + (y1 - y0) * (place - x0) / (x1 - x0);
}

MeasuredTable sampled(const std::vector<Point>& points) {
  const double first = points.front().place, length = points.back().place - first;
  double least = length, most = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    least = std::min(least, points[i].place - points[i - 1].place);
    most = std::max(most, points[i].place - points[i - 1].place);
  }
  const bool equal = most - least <= equal_spacing * most && static_cast<double>(points.size()) <= most_samples;
  const double count = equal ? static_cast<double>(points.size())
                             : std::clamp(std::ceil(length / least - equal_spacing) + 1, 64.0, most_samples);

  MeasuredTable measured;
  measured.first = first;
  measured.step = length / (count - 1);
  measured.low = std::ranges::min_element(points, {}, &Point::value)->value;
  measured.high = std::ranges::max_element(points, {}, &Point::value)->value;
  const double span = measured.high > measured.low ? measured.high - measured.low : 1;
  HeightTable& table = measured.table;
  table.width = static_cast<std::uint32_t>(count);
  table.height = 2;
  for (std::uint32_t row = 0; row < table.height; ++row)
    for (std::uint32_t i = 0; i < table.width; ++i) {
      const double value = equal ? points[i].value : interpolated(points, first + i * measured.step);
      table.heights.push_back(static_cast<std::uint16_t>(std::lround(65535 * (value - measured.low) / span)));
    }
  return measured;
}

/// Reads line by line; what is wrong is thrown to `read_measured_table` and goes no further.
class TableReader {
 public:
  TableReader(std::string_view text, const std::string& from, const std::string& to, const Declarations& declarations)
      : text_(text), from_(from), to_(to), declarations_(declarations) {}

  MeasuredTable read() {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    while (next_line())
      if (columns_.empty())
        read_heading();
      else
        read_point();
    line_ = 0;
    if (columns_.empty()) fail("is empty", "give it a line of headings, such as `x (mm), force (N)`, and two points");
    if (points_.size() < 2) fail("has fewer than two points", "a relation needs two or more");
    MeasuredTable measured = sampled(points_);
    measured.from = place_unit_.dimension;
    measured.to = value_unit_.dimension;
    return measured;
  }

 private:
  bool next_line() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      current_ = trimmed(text_.substr(at_, end - at_));
      at_ = end + 1;
      ++line_;
      if (!current_.empty() && current_[0] != '#') return true;
    }
    return false;
  }

  void read_heading() {
    for (const auto& cell : cells(current_)) columns_.push_back(column_of(cell));
    if (columns_.size() < 2) fail("a relation has two columns", "separate them by commas, as in `x (mm), force (N)`");
    if (number(columns_[0].name)) fail("the first line names the columns", "write, for example, `x (mm), force (N)`");
    place_column_ = find(from_, 0);
    value_column_ = find(to_, 1);
    place_unit_ = unit(columns_[place_column_]);
    value_unit_ = unit(columns_[value_column_]);
  }

  std::size_t find(const std::string& name, std::size_t otherwise) const {
    if (name.empty()) return otherwise;
    const auto found = std::ranges::find(columns_, name, &Column::name);
    if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
    std::vector<std::string> known;
    for (const auto& column : columns_) known.push_back(column.name);
    fail(fmt::format("no column is called `{}`", name), fmt::format("there are: {}", fmt::join(known, ", ")));
  }

  Unit unit(const Column& column) const {
    const auto known = unit_of(column.unit, declarations_);
    if (!known) fail(fmt::format("nothing declares the unit `{}`", column.unit), "write, for example, `x (mm)`");
    return *known;
  }

  void read_point() {
    const auto values = cells(current_);
    if (values.size() != columns_.size())
      fail(fmt::format("{} values for {} columns", values.size(), columns_.size()), "give one for each column");
    const auto place = number(values[place_column_]), value = number(values[value_column_]);
    if (!place || !value)
      fail(fmt::format("`{}` is no number", values[place ? value_column_ : place_column_].substr(0, 40)),
           "numbers are written with a point, such as 0.25");
    const Point point{*place * place_unit_.factor, *value * value_unit_.factor};
    if (!points_.empty() && !(point.place > points_.back().place))
      fail("the places do not rise from line to line", "sort the lines, and keep one value for each place");
    if (points_.size() == most_rows) fail(fmt::format("more than {} points", most_rows), "keep every tenth, say");
    points_.push_back(point);
  }

  [[noreturn]] void fail(std::string reason, std::string mend) const {
    throw TableProblem{line_, std::move(reason), std::move(mend)};
  }

  std::string_view text_, current_;
  const std::string &from_, &to_;
  const Declarations& declarations_;
  std::size_t at_ = 0, line_ = 0;
  std::vector<Column> columns_;
  std::size_t place_column_ = 0, value_column_ = 1;
  Unit place_unit_, value_unit_;
  std::vector<Point> points_;
};

}  // namespace

std::variant<MeasuredTable, TableProblem> read_measured_table(std::string_view text, const std::string& from,
                                                              const std::string& to, const Declarations& declarations) {
  try {
    return TableReader(text, from, to, declarations).read();
  } catch (const TableProblem& problem) {
    return problem;
  }
}

}  // namespace wale
