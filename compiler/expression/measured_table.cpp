#include "compiler/expression/measured_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compiler/expression/check_expression.hpp"
#include "compiler/parse/parse.hpp"
#include "schema/csv.hpp"
#include "schema/spelling.hpp"

namespace wale {

namespace {

constexpr std::size_t most_rows = 1'000'000;
constexpr double most_samples = 8192;
/// Spacings with a relative difference below this count as equal, since files hold rounded numbers.
constexpr double equal_spacing = 1e-4;

struct Point {
  double place, value;
};

/// The declared unit of that name, or nothing.
std::optional<Unit> unit_of(std::string_view text, const Declarations& declarations) {
  if (text.empty()) return Unit{};
  SourceSet sources;
  Diagnostics diagnostics;
  SyntaxTree tree;
  const SourceId source = sources.add("unit", fmt::format("1 {}", text));
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

/// A column to be read: its index from 0, its name and its unit.
struct Column {
  std::size_t number = 0;
  std::string_view name;
  Unit unit;
};

/// The nearest declared unit, in the column's own heading; else how to declare one.
std::string mend_of_unit(const CsvHeading& heading, const Declarations& declarations) {
  const std::string unit(heading.unit);
  if (const auto near = nearest_spelling(unit, declarations.units.spellings()))
    return fmt::format("did you mean `{} ({})`?", heading.name, *near);
  return fmt::format("name a unit of schema/units.wale in `{} (…)`", heading.name);
}

Result<Column> column_called(const CsvRow& headings, const std::string& name, std::size_t otherwise,
                             const Declarations& declarations) {
  Column column{.number = otherwise};
  if (!name.empty()) {
    const auto found =
        find_column(headings, name, [&](std::string_view heading) { return heading_of(heading).name == name; });
    if (!found) return found.error();
    if (!*found) {
      std::vector<std::string_view> known;
      for (const std::string_view cell : headings.cells) known.push_back(heading_of(cell).name);
      return unlike_csv(headings.line, fmt::format("a column `{}`", name), fmt::format("{}", fmt::join(known, ", ")),
                        "name one of the columns that there are");
    }
    column.number = **found;
  }
  const CsvHeading heading = heading_of(headings.cells[column.number]);
  const auto unit = unit_of(heading.unit, declarations);
  if (!unit)
    return unlike_csv(headings.line, fmt::format("a declared unit for `{}`", heading.name),
                      fmt::format("`{}`", heading.unit), mend_of_unit(heading, declarations));
  column.name = heading.name;
  column.unit = *unit;
  return column;
}

struct Columns {
  Column place, value;
  std::size_t count = 0;  ///< number of all columns of the table
};

Result<Columns> find_columns(const CsvRow& headings, const std::string& from, const std::string& to,
                             const Declarations& declarations) {
  if (headings.cells.size() < 2)
    return unlike_csv(headings.line, "two columns or more", "one",
                      "separate them by commas, as in `x (mm), force (N)`");
  if (number_in(headings, 0, ""))
    return unlike_csv(headings.line, "the names of the columns", fmt::format("`{}`", headings.cells[0]),
                      "begin with a line such as `x (mm), force (N)`");
  auto place = column_called(headings, from, 0, declarations);
  if (!place) return place.error();
  auto value = column_called(headings, to, 1, declarations);
  if (!value) return value.error();
  return Columns{*place, *value, headings.cells.size()};
}

Result<Point> read_point(const CsvRow& row, const Columns& columns) {
  if (row.cells.size() != columns.count)
    return unlike_csv(row.line, fmt::format("{} values", columns.count), fmt::format("{}", row.cells.size()),
                      "give one for each column; write numbers with a point, as in 0.25");
  const auto place = number_in(row, columns.place.number, columns.place.name);
  if (!place) return place.error();
  const auto value = number_in(row, columns.value.number, columns.value.name);
  if (!value) return value.error();
  return Point{*place * columns.place.unit.factor, *value * columns.value.unit.factor};
}

}  // namespace

Result<MeasuredTable> read_measured_table(std::string_view text, const std::string& from, const std::string& to,
                                          const Declarations& declarations) {
  CsvReader reader(text);
  const auto headings = read_headings(reader, "a line of headings, such as `x (mm), force (N)`");
  if (!headings) return headings.error();
  const auto columns = find_columns(*headings, from, to, declarations);
  if (!columns) return columns.error();
  std::vector<Point> points;
  const auto taken = each_row(reader, [&](const CsvRow& row) -> Result<> {
    const auto point = read_point(row, *columns);
    if (!point) return point.error();
    if (!points.empty() && !(point->place > points.back().place))
      return unlike_csv(row.line, "places that rise from line to line",
                        fmt::format("`{}`", row.cells[columns->place.number]),
                        "sort the lines, and keep one value for each place");
    if (points.size() == most_rows)
      return unlike_csv(row.line, fmt::format("at most {} points", most_rows), "more", "keep every tenth, for example");
    points.push_back(*point);
    return {};
  });
  if (!taken) return taken.error();
  if (points.size() < 2)
    return unlike_csv(0, "two points or more", fmt::format("{}", points.size()), "add a line for each point");
  MeasuredTable measured = sampled(points);
  measured.from = columns->place.unit.dimension;
  measured.to = columns->value.unit.dimension;
  return measured;
}

}  // namespace wale
