#include "wale/trace.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "schema/csv.hpp"

namespace wale {
namespace {

struct Unit {
  std::string_view name;
  double in_si;
};

constexpr std::array<Unit, 2> times{{{"s", 1}, {"ms", 1e-3}}};
constexpr std::array<Unit, 3> lengths{{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}}};
constexpr std::array<Unit, 3> speeds{{{"m/s", 1}, {"cm/s", 1e-2}, {"mm/s", 1e-3}}};

enum Quantity : std::size_t { time, x, y, vx, vy, quantities };
constexpr std::array<std::string_view, quantities> names{"t", "x", "y", "vx", "vy"};

std::span<const Unit> units_of(Quantity quantity) {
  if (quantity == time) return times;
  if (quantity == x || quantity == y) return lengths;
  return speeds;
}

struct Column {
  std::size_t number;  ///< from 0
  double in_si;
};

using Columns = std::array<std::optional<Column>, quantities>;

std::string in_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

/// The unit's size in SI, 1 for no unit, or nothing for a unit that the quantity does not have.
std::optional<double> size_of(std::string_view unit_name, Quantity quantity) {
  if (unit_name.empty()) return 1;
  for (const Unit& unit : units_of(quantity)) {
    if (unit.name == unit_name) return unit.in_si;
  }
  return std::nullopt;
}

std::optional<Quantity> quantity_called(std::string_view name) {
  if (name == "time") return time;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Quantity>(found - names.begin());
}

struct Heading {
  Quantity quantity;
  std::string_view unit;
};

/// The quantity and unit of a column named "vx (m/s)", "vx [m/s]", "vx_m/s" or "vx"; empty for a column to ignore,
/// such as "x_target".
std::optional<Heading> read_heading(std::string_view text) {
  const auto underscore = text.find('_');
  if (underscore != std::string_view::npos) {
    const auto quantity = quantity_called(text.substr(0, underscore));
    const std::string_view unit = text.substr(underscore + 1);
    return quantity && size_of(unit, *quantity) ? std::optional(Heading{*quantity, unit}) : std::nullopt;
  }
  const auto [name, unit] = heading_of(text);
  const auto quantity = quantity_called(name);
  return quantity ? std::optional(Heading{*quantity, unit}) : std::nullopt;
}

std::string joined(const std::vector<std::string_view>& cells) {
  std::string all;
  for (const std::string_view cell : cells) all.append(all.empty() ? "" : ",").append(cell);
  return all;
}

Result<Columns> find_columns(const CsvRow& headings) {
  Columns columns;
  for (const Quantity quantity : {time, x, y, vx, vy}) {
    const auto number = find_column(headings, names[quantity], [&](std::string_view text) {
      const auto heading = read_heading(text);
      return heading && heading->quantity == quantity;
    });
    if (!number) return number.error();
    if (!*number) continue;
    const std::string_view unit = read_heading(headings.cells[**number])->unit;
    const std::optional<double> in_si = size_of(unit, quantity);
    if (!in_si) {
      std::string known;
      for (const Unit& one : units_of(quantity)) known += (known.empty() ? "" : ", ") + std::string(one.name);
      return unlike_csv(headings.line, "column " + in_quotes(names[quantity]) + " in one of " + known, in_quotes(unit));
    }
    columns[quantity] = Column{**number, *in_si};
  }
  for (const Quantity quantity : {time, x, y}) {
    if (!columns[quantity]) {
      return unlike_csv(headings.line, "a header with the columns t, x, y; missing " + in_quotes(names[quantity]),
                        in_quotes(joined(headings.cells)));
    }
  }
  if (columns[vx].has_value() != columns[vy].has_value()) {
    return unlike_csv(headings.line, "both vx and vy, or neither", columns[vx] ? "vx alone" : "vy alone");
  }
  return columns;
}

Result<TracePoint> read_point(const CsvRow& row, const Columns& columns) {
  std::array<double, quantities> values{};
  for (std::size_t i = 0; i < quantities; ++i) {
    if (!columns[i]) continue;
    const auto value = number_in(row, columns[i]->number, names[i]);
    if (!value) return value.error();
    values[i] = *value * columns[i]->in_si;
  }
  return TracePoint{values[time], {values[x], values[y]}, {values[vx], values[vy]}};
}

glm::dvec2 slope(const TracePoint& from, const TracePoint& to) {
  return (to.position - from.position) / (to.time - from.time);
}

/// Gives each point the slope of the parabola through it and its neighbours, and each end the slope of the straight
/// line to its neighbour.
void derive_velocities(std::vector<TracePoint>& points) {
  const std::size_t n = points.size();
  if (n < 2) return;
  points[0].velocity = slope(points[0], points[1]);
  points[n - 1].velocity = slope(points[n - 2], points[n - 1]);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = points[i].time - points[i - 1].time, after = points[i + 1].time - points[i].time;
    points[i].velocity =
        (slope(points[i - 1], points[i]) * after + slope(points[i], points[i + 1]) * before) / (before + after);
  }
}

std::string shortest(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace

Result<Trace> read_trace(std::string_view text) {
  CsvReader reader(text);
  const auto headings = read_headings(reader, "a header with the columns t, x, y");
  if (!headings) return headings.error();
  const auto columns = find_columns(*headings);
  if (!columns) return columns.error();
  Trace trace;
  trace.velocities_given = (*columns)[vx].has_value();
  const auto taken = each_row(reader, [&](const CsvRow& row) -> Result<> {
    const auto point = read_point(row, *columns);
    if (!point) return point.error();
    if (!trace.points.empty() && point->time <= trace.points.back().time) {
      return unlike_csv(row.line, "a time after " + shortest(trace.points.back().time) + " s",
                        shortest(point->time) + " s");
    }
    trace.points.push_back(*point);
    return {};
  });
  if (!taken) return taken.error();
  if (trace.points.empty()) return unlike_csv(0, "at least one line of numbers after the header", "none");
  if (!trace.velocities_given) derive_velocities(trace.points);
  // Programs compute in single precision, where a faster hand would have an infinite velocity.
  constexpr double fastest = std::numeric_limits<float>::max();
  for (const TracePoint& point : trace.points)
    if (!(std::abs(point.velocity.x) <= fastest && std::abs(point.velocity.y) <= fastest))
      return unlike_csv(0, "positions that a hand can reach", "an infinite velocity at " + shortest(point.time) + " s",
                        "times are in s, positions in m");
  return trace;
}

TracePoint at(const Trace& trace, double time) noexcept {
  const auto& points = trace.points;
  if (points.empty()) return {time, {}, {}};
  if (time < points.front().time) return {time, points.front().position, {}};
  const auto next = std::upper_bound(points.begin(), points.end(), time,
                                     [](double t, const TracePoint& point) { return t < point.time; });
  if (next == points.end()) {
    const bool on_last = time == points.back().time;
    return {time, points.back().position, on_last ? points.back().velocity : glm::dvec2(0)};
  }
  const TracePoint &a = *(next - 1), &b = *next;
  const double seconds = b.time - a.time, u = (time - a.time) / seconds;
  const glm::dvec2 line = slope(a, b);
  // The straight line plus the cubic that vanishes at both ends and turns the slopes there into the velocities.
  const glm::dvec2 from = a.velocity - line, to = b.velocity - line;
  const double rest = 1 - u;
  return {time, a.position + seconds * (u * line + u * rest * (rest * from - u * to)),
          line + rest * (1 - 3 * u) * from + u * (3 * u - 2) * to};
}

}  // namespace wale
