// Ratings of materials by people, as CSV.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "library/drafts/draft.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// By what the cells of a table are parted: commas, or, as spreadsheets write in languages with a decimal comma, semicolons
/// or tabs. `names` is the first line.
char separator_of(std::string_view names) {
  for (const char each : {';', '\t'})
    if (names.find(each) != std::string_view::npos && names.find(',') == std::string_view::npos) return each;
  return ',';
}

/// The cells of one line; within quotation marks a separator is a letter as others, and two marks are one.
Result<std::vector<std::string>> cells_of(const std::string& path, std::size_t row, std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += c, ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  if (quoted) return error_in_row(path, row, "a quotation mark is not closed", "write \" behind the cell");
  for (std::string& each : cells) {
    const std::size_t begin = each.find_first_not_of(" \t\r");
    each = begin == each.npos ? "" : each.substr(begin, each.find_last_not_of(" \t\r") - begin + 1);
  }
  return cells;
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

struct Rated {
  std::string title;
  std::map<std::string, std::pair<double, int>> sums;  ///< of the levels, and how many, by percept
};

}  // namespace

Result<std::vector<Draft>> rating_drafts(const std::string& path, const std::string& text,
                                         const std::vector<std::string>& percepts, const std::set<std::string>& taken,
                                         const DraftOptions& options) {
  std::vector<std::string> columns;
  std::vector<Rated> all;
  std::map<std::string, std::size_t> known;
  std::string_view left = text;
  if (left.starts_with("\xEF\xBB\xBF")) left.remove_prefix(3);
  std::size_t row = 0;
  char separator = 0;
  std::vector<std::string> left_out;
  while (!left.empty()) {
    const std::size_t end = std::min(left.find('\n'), left.size());
    const std::string_view line = left.substr(0, end);
    if (columns.empty()) separator = separator_of(line);
    const auto cells = cells_of(path, ++row, line, separator);
    left.remove_prefix(std::min(end + 1, left.size()));
    if (!cells) return cells.error();
    if (cells->size() == 1 && cells->front().empty()) continue;
    if (columns.empty()) {
      columns = *cells;
      if (columns.size() < 2)
        return error_in_row(path, row, "expected a line of names: one for the material, and percepts", "for example, `material,roughness,stickiness`");
      for (std::size_t i = 1; i < columns.size(); ++i) {
        if (std::ranges::find(percepts, columns[i]) == percepts.end()) {
          if (const auto near = nearest_spelling(columns[i], percepts))
            return error_in_row(path, row, fmt::format("no percept is called \"{}\"", visible_text(columns[i])),
                                fmt::format("did you mean {}?", *near));
          left_out.push_back(columns[i]);
        }
        if (std::find(columns.begin() + 1, columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) != columns.begin() + static_cast<std::ptrdiff_t>(i))
          return error_in_row(path, row, fmt::format("{} is there twice", columns[i]), "leave one out");
      }
      if (left_out.size() + 1 == columns.size())
        return error_in_row(path, row, fmt::format("no percept is called \"{}\"", visible_text(left_out.front())),
                            fmt::format("percepts with levels are {}", fmt::join(percepts, ", ")));
      continue;
    }
    if (cells->size() != columns.size())
      return error_in_row(path, row, fmt::format("expected {} cells as in the first line, found {}", columns.size(), cells->size()),
                          fmt::format("\"{0}\" parts two cells; a cell with a \"{0}\" stands in quotation marks", separator));
    if (cells->front().empty()) return error_in_row(path, row, "the material has no name", "write it into the first cell");
    const auto [at, is_new] = known.try_emplace(cells->front(), all.size());
    if (is_new) all.push_back({cells->front(), {}});
    for (std::size_t i = 1; i < columns.size(); ++i) {
      std::string cell = (*cells)[i];
      if (cell.empty() || std::ranges::find(left_out, columns[i]) != left_out.end()) continue;
      if (separator != ',') std::ranges::replace(cell, ',', '.');  // a decimal comma
      double value = 0;
      const auto [stop, trouble] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (trouble != std::errc() || stop != cell.data() + cell.size() || !std::isfinite(value))
        return error_in_row(path, row, fmt::format("expected a number for {}, found \"{}\"", columns[i], visible_text(cell)),
                            "a cell without a rating is empty");
      if (value < options.least || value > options.most)
        return error_in_row(path, row, fmt::format("the {} of {:g} is outside {:g} .. {:g}", columns[i], value, options.least, options.most),
                            "state the ends of the scale, as in `--range 1,7`");
      auto& [sum, count] = all[at->second].sums[columns[i]];
      sum += (value - options.least) / (options.most - options.least), ++count;
    }
  }
  if (all.empty()) return error_in_row(path, row, "there is no material", "write a line for each below the names");
  std::vector<Draft> drafts;
  std::set<std::string> names = taken;
  const std::string file = std::filesystem::path(path).filename().string();
  for (const Rated& each : all) {
    Draft& draft = drafts.emplace_back(Draft{.name = wale_name(lower_case(each.title), names), .text = {}});
    names.insert(draft.name);
    std::string levels;
    for (const auto& [percept, rated] : each.sums)
      levels += fmt::format("    {} {:.3f} transferred\n", percept, rated.first / rated.second);
    draft.assumed.push_back(fmt::format("that {:g} .. {:g} is level 0 .. 1 in equal steps: a scale of ratings has no zero of its own", options.least, options.most));
    for (const std::string& column : left_out)
      draft.assumed.push_back(fmt::format("that the column \"{}\" may be left out, which is no percept with levels", visible_text(column)));
    draft.text = fmt::format("/// Ratings of \"{}\" in `{}`.\nmaterial {} {{\n{}{}}}\n", visible_text(each.title), visible_text(file), draft.name,
                             draft_names(each.title, "ratings, " + file, options.licence),
                             levels.empty() ? "" : "  perceptual {\n" + levels + "  }\n");
  }
  return drafts;
}

}  // namespace wale
