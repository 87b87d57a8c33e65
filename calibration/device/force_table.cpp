#include "calibration/device/force_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "calibration/analysis/table.hpp"
#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using analysis::Table;

constexpr double standard_gravity = 9.80665;  // m/s^2, by definition (CGPM 1901)
constexpr double pound = 0.45359237;          // kg, by definition (1959)
constexpr const char* known_units = "N, mN, gf, kgf, lbf or ozf, or g or kg of hanging weight";

/// N of one of the unit.
std::optional<double> newtons_in(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 8> units{{{"N", 1},
                                                                      {"mN", 1e-3},
                                                                      {"gf", standard_gravity / 1e3},
                                                                      {"kgf", standard_gravity},
                                                                      {"lbf", pound * standard_gravity},
                                                                      {"ozf", pound / 16 * standard_gravity},
                                                                      {"g", standard_gravity / 1e3},
                                                                      {"kg", standard_gravity}}};
  const auto found = std::ranges::find(units, unit, &std::pair<std::string_view, double>::first);
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

std::string_view without_spaces(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

Error malformed(std::string sentence, std::string mend) {
  return Error{.code = Code::malformed_value, .sentence = std::move(sentence), .mend = std::move(mend)};
}

/// "reading (N)": the name of a column and its unit, which may be empty.
std::pair<std::string_view, std::string_view> name_and_unit(std::string_view header) {
  const auto open = header.find_first_of("([");
  if (open == std::string_view::npos) return {header, {}};
  const auto close = header.find_first_of(")]", open);
  const std::string_view unit = header.substr(open + 1, close == std::string_view::npos ? close : close - open - 1);
  return {without_spaces(header.substr(0, open)), without_spaces(unit)};
}

/// A column with the unit that its header gives, and the one that its cells have had so far.
struct UnitColumn {
  std::size_t index = 0;
  std::string header_unit, used_unit;
  std::size_t used_line = 0;
};

/// Reads the rows of one table.
class ForceTableReader {
 public:
  ForceTableReader(const Table& table, double peak) : table_(table), peak_(peak) {}

  Result<GaugeReadings> read() {
    if (auto problem = find_columns()) return *std::move(problem);
    GaugeReadings all;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      auto reading = read_row(row);
      if (!reading) return std::move(reading.error());
      if (grade_) {
        const std::string_view grade = table_.cell(row, *grade_);
        if (grade != "measured" && grade != "simulated")
          return error(row, found("expected measured or simulated", grade), "write one of the two");
        all.is_simulated = all.is_simulated || grade == "simulated";
      }
      const auto key = std::tuple(reading->way, reading->command, reading->repeat);
      if (const auto [before, is_new] = seen_.try_emplace(key, table_.line(row)); !is_new)
        return error(row,
                     readable("{} at {:.6g} N is here for the second time in round {}", in_words(reading->way),
                              reading->command, reading->repeat) +
                         fmt::format("; the first is in line {}", before->second),
                     "remove one of them, or number the rounds in a column `repeat`");
      all.readings.push_back(*reading);
    }
    return all;
  }

 private:
  Error error(std::size_t row, std::string sentence, std::string mend) const {
    return analysis::table_error(table_, row, std::move(sentence), std::move(mend));
  }

  static std::string found(const std::string& expected, std::string_view text) {
    return fmt::format("{}, found {}", expected,
                       text.empty() ? "nothing" : "\"" + visible_text(std::string(text)) + "\"");
  }

  std::optional<Error> find_columns() {
    std::optional<std::size_t> axis, direction, command, reading;
    const std::array<std::pair<std::string_view, std::optional<std::size_t>*>, 6> known{{{"axis", &axis},
                                                                                         {"direction", &direction},
                                                                                         {"command", &command},
                                                                                         {"reading", &reading},
                                                                                         {"repeat", &repeat_},
                                                                                         {"grade", &grade_}}};
    for (std::size_t i = 0; i < table_.columns().size(); ++i) {
      const auto [name, unit] = name_and_unit(table_.columns()[i]);
      const auto place = std::ranges::find(known, name, [](const auto& each) { return each.first; });
      const bool may_have_unit = name == "command" || name == "reading";
      if (place == known.end() || (!unit.empty() && !may_have_unit) || *place->second)
        return header_error(
            found("expected the columns axis, direction, command and reading, and perhaps repeat and "
                  "grade, each once",
                  table_.columns()[i]));
      *place->second = i;
      if (name == "command") command_ = {i, std::string(unit), {}, 0};
      if (name == "reading") reading_ = {i, std::string(unit), {}, 0};
    }
    for (const auto& [name, place] : known)
      if (!*place && name != "repeat" && name != "grade")
        return header_error(fmt::format("there is no column `{}`", name));
    axis_ = *axis;
    direction_ = *direction;
    return std::nullopt;
  }

  Error header_error(std::string sentence) const {
    return Error{.code = Code::malformed_value,
                 .sentence = std::move(sentence),
                 .mend = "begin the table with `axis,direction,command (N),reading (N),repeat`",
                 .place = {.name = table_.file(), .number = 1}};
  }

  Result<GaugeReading> read_row(std::size_t row) {
    GaugeReading reading{.line = table_.line(row)};
    const std::string_view axis = table_.cell(row, axis_), direction = table_.cell(row, direction_);
    if (axis != "x" && axis != "y")
      return error(row, found("expected the axis x or y", axis), "x is to the right, y away");
    const auto way = std::ranges::find(all_ways, direction, [](Way each) { return std::string_view(in_words(each)); });
    if (way == all_ways.end())
      return error(row, found("expected a direction: right, left, away or toward", direction),
                   "x has right and left, y has away and toward");
    if (axis_of(*way) != (axis == "x" ? 0 : 1))
      return error(row, fmt::format("{} is no direction of the axis {}", direction, axis),
                   "x has right and left, y has away and toward");
    reading.way = *way;
    const auto command = read_cell(row, command_, true);
    if (!command) return command.error();
    const auto force = read_cell(row, reading_, false);
    if (!force) return force.error();
    reading.command = command->is_share ? command->value * peak_ : command->value;
    reading.newton = force->value;
    if (!(reading.command >= 0 && reading.command <= peak_ * (1 + 1e-9)))
      return error(row,
                   readable("a command must be from 0 N to the device's force, {:.6g} N; found {:.6g} N", peak_,
                            reading.command),
                   "the direction says which way; commands have no sign");
    if (repeat_) {
      const auto round = analysis::number_in(table_.cell(row, *repeat_));
      if (!round || *round < 1 || *round > 1000 || *round != std::floor(*round))
        return error(row, found("expected the number of a round, from 1", table_.cell(row, *repeat_)), "write 1, 2, 3");
      reading.repeat = static_cast<int>(*round);
    }
    return reading;
  }

  Result<GaugeQuantity> read_cell(std::size_t row, UnitColumn& column, bool is_command) {
    const std::string_view cell = table_.cell(row, column.index);
    auto quantity = read_gauge_quantity(cell, column.header_unit, is_command);
    const char* name = is_command ? "command" : "reading";
    if (!quantity) return error(row, fmt::format("{}: {}", name, quantity.error().sentence), quantity.error().mend);
    if (!column.header_unit.empty() && quantity->unit != column.header_unit)
      return error(row,
                   fmt::format("the {} is in {}, and the header says {}", name, quantity->unit, column.header_unit),
                   "give one unit for the column");
    if (!column.used_unit.empty() && quantity->unit != column.used_unit)
      return error(row,
                   fmt::format("the {} is in {}, and that of line {} in {}", name, quantity->unit, column.used_line,
                               column.used_unit),
                   "give all of a column in one unit");
    if (column.used_unit.empty()) {
      column.used_unit = quantity->unit;
      column.used_line = table_.line(row);
    }
    return quantity;
  }

  const Table& table_;
  double peak_;
  std::size_t axis_ = 0, direction_ = 0;
  UnitColumn command_, reading_;
  std::optional<std::size_t> repeat_, grade_;
  std::map<std::tuple<Way, double, int>, std::size_t> seen_;
};

}  // namespace

Result<GaugeQuantity> read_gauge_quantity(std::string_view text, std::string_view unit, bool may_be_share) {
  text = without_spaces(text);
  const auto shown = [&] {
    return text.empty() ? std::string("nothing") : "\"" + visible_text(std::string(text)) + "\"";
  };
  const std::size_t end = text.find_last_of("0123456789.") + 1;  // 0 if there is no digit
  const auto number = analysis::number_in(without_spaces(text.substr(0, end)));
  if (!number) return malformed("expected a number with its unit, found " + shown(), "write, for example, 2.31 N");
  std::string_view own = without_spaces(text.substr(end));
  if (own.empty()) own = unit;
  const std::string units = std::string(known_units) + (may_be_share ? ", or %" : "");
  if (own.empty()) return malformed("the unit is missing in " + shown(), "write it after the number: " + units);
  GaugeQuantity quantity{.value = *number, .unit = std::string(own)};
  if (may_be_share && own == "%") {
    quantity.value /= 100;
    quantity.is_share = true;
    return quantity;
  }
  const auto newtons = newtons_in(own);
  if (!newtons)
    return malformed("\"" + visible_text(std::string(own)) + "\" is no unit of force that a gauge shows",
                     "use " + units);
  quantity.value *= *newtons;
  return quantity;
}

Result<GaugeReadings> read_force_table(std::string file, std::string text, double peak) {
  const auto table = analysis::read_table(std::move(file), std::move(text));
  if (!table) return table.error();
  if (table->rows() == 0)
    return Error{.code = Code::malformed_value,
                 .sentence = "the table has no readings",
                 .mend = "add one row for each reading of the gauge",
                 .place = {.name = table->file()}};
  return ForceTableReader(*table, peak).read();
}

std::string force_table_text(std::span<const GaugeReading> readings, bool is_simulated) {
  std::string text = "axis,direction,command (N),reading (N),repeat,grade\n";
  for (const GaugeReading& each : readings)
    text += fmt::format("{},{},{:.9g},{:.9g},{},{}\n", axis_of(each.way) == 0 ? "x" : "y", in_words(each.way),
                        each.command, each.newton, each.repeat, is_simulated ? "simulated" : "measured");
  return text;
}

}  // namespace wale
