#include "wale/trace.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

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

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// Takes the text up to `separator` from the front of `rest`.
std::string_view take(std::string_view& rest, char separator) {
  const auto end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return part;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const bool last = line.find(',') == std::string_view::npos;
    std::string_view cell = trimmed(take(line, ','));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (last) return cells;
  }
}

/// `line` counts from 1; 0: the text as a whole.
Error unlike(std::size_t line, const std::string& expected, const std::string& found) {
  Error error{Code::unreadable_table, "expected " + expected + ", found " + found};
  if (line > 0) error.place.number = line;
  return error;
}

std::string quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

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

/// The quantity and unit of a column named "vx (m/s)", "vx [m/s]", "vx_m/s" or "vx"; nothing for a column to ignore,
/// such as "x_target".
std::optional<Heading> read_heading(std::string_view text) {
  const auto end = text.find_first_of("([_");
  const auto quantity = quantity_called(trimmed(text.substr(0, end)));
  if (!quantity) return std::nullopt;
  if (end == std::string_view::npos) return Heading{*quantity, {}};
  std::string_view unit = text.substr(end + 1);
  if (text[end] == '_') {
    if (!size_of(unit, *quantity)) return std::nullopt;
  } else if (unit.ends_with(text[end] == '(' ? ')' : ']')) {
    unit.remove_suffix(1);
  }
  return Heading{*quantity, trimmed(unit)};
}

Result<Columns> read_header(std::string_view line, std::size_t line_number) {
  Columns columns;
  const std::vector<std::string_view> headings = cells_of(line);
  for (std::size_t number = 0; number < headings.size(); ++number) {
    const auto heading = read_heading(headings[number]);
    if (!heading) continue;
    const auto [quantity, unit] = *heading;
    const std::string name = quoted(names[quantity]);
    if (columns[quantity]) {
      const std::string first = std::to_string(columns[quantity]->number + 1), second = std::to_string(number + 1);
      return unlike(line_number, "one column " + name, "two, columns " + first + " and " + second);
    }
    const std::optional<double> in_si = size_of(unit, quantity);
    if (!in_si) {
      std::string known;
      for (const Unit& one : units_of(quantity)) known += (known.empty() ? "" : ", ") + std::string(one.name);
      return unlike(line_number, "column " + name + " in one of " + known, quoted(unit));
    }
    columns[quantity] = Column{number, *in_si};
  }
  for (const Quantity quantity : {time, x, y}) {
    if (!columns[quantity]) {
      return unlike(line_number, "a header with the columns t, x, y; missing " + quoted(names[quantity]),
                    quoted(trimmed(line)));
    }
  }
  if (columns[vx].has_value() != columns[vy].has_value()) {
    return unlike(line_number, "both vx and vy, or neither", columns[vx] ? "vx alone" : "vy alone");
  }
  return columns;
}

Result<TracePoint> read_point(std::string_view line, std::size_t line_number, const Columns& columns) {
  const std::vector<std::string_view> cells = cells_of(line);
  std::array<double, quantities> values{};
  for (std::size_t i = 0; i < quantities; ++i) {
    if (!columns[i]) continue;
    const auto [number, in_si] = *columns[i];
    const std::string expected = "a finite number for " + quoted(names[i]) + " in column " + std::to_string(number + 1);
    if (number >= cells.size()) {
      const std::string count = std::to_string(cells.size());
      return unlike(line_number, expected, "only " + count + (cells.size() == 1 ? " column" : " columns"));
    }
    std::string_view cell = cells[number];
    if (cell.starts_with('+')) cell.remove_prefix(1);
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), values[i]);
    if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(values[i])) {
      return unlike(line_number, expected, cells[number].empty() ? "nothing" : quoted(cells[number]));
    }
    values[i] *= in_si;
  }
  return TracePoint{values[time], {values[x], values[y]}, {values[vx], values[vy]}};
}

glm::dvec2 slope(const TracePoint& from, const TracePoint& to) {
  return (to.position - from.position) / (to.time - from.time);
}

/// Each point gets the slope of the parabola through it and its neighbours; the ends get that of the outermost stretch.
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
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());

  Trace trace;
  std::optional<Columns> columns;
  for (std::size_t line_number = 1; !text.empty(); ++line_number) {
    const std::string_view line = trimmed(take(text, '\n'));
    if (line.empty() || line.starts_with('#')) continue;
    if (!columns) {
      auto header = read_header(line, line_number);
      if (!header) return std::move(header.error());
      columns = *header;
      trace.velocities_given = (*columns)[vx].has_value();
      continue;
    }
    auto read = read_point(line, line_number, *columns);
    if (!read) return std::move(read.error());
    const TracePoint& point = *read;
    if (!trace.points.empty() && point.time <= trace.points.back().time) {
      return unlike(line_number, "a time after " + shortest(trace.points.back().time) + " s",
                    shortest(point.time) + " s");
    }
    trace.points.push_back(point);
  }
  if (!columns) return unlike(0, "a header with the columns t, x, y", "nothing");
  if (trace.points.empty()) return unlike(0, "at least one line of numbers after the header", "none");
  if (!trace.velocities_given) derive_velocities(trace.points);
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
