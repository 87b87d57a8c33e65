// Height maps as plain text.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

#include "library/drafts/draft.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr std::size_t least_side = 4, most_cells = std::size_t{1} << 24;

/// Heights row by row, in the file's unit; not a number where nothing was measured.
struct HeightMap {
  std::size_t width = 0, height = 0, bad = 0;
  std::vector<double> cells;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view between = " \t\r,;";
  for (std::size_t at = 0; (at = line.find_first_not_of(between, at)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(between, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

Result<HeightMap> read_map(const std::string& path, std::string_view text, const DraftOptions& options) {
  HeightMap map;
  std::size_t row = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++row;
    line = line.substr(0, line.find('#'));
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (map.height == 0) map.width = words.size();
    if (words.size() != map.width)
      return error_in_row(path, row, fmt::format("expected {} numbers as in the rows before, found {}", map.width, words.size()),
                          "each line is one row of the grid");
    if (map.cells.size() + words.size() > most_cells)
      return error_in_row(path, row, "the grid has more than 2^24 numbers", "cut it, or leave out every other row and column");
    for (const std::string_view word : words) {
      double value = 0;
      const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
      const auto [stop, trouble] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      const bool is_bad = std::ranges::find(options.bad, word) != options.bad.end();
      if (!is_bad && (trouble != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value)))
        return error_in_row(path, row, fmt::format("expected a number, found \"{}\"", visible_text(word)),
                            fmt::format("if it stands for a value that was not measured, write `--bad {}`", visible_text(word)));
      map.bad += is_bad;
      map.cells.push_back(is_bad ? std::numeric_limits<double>::quiet_NaN() : value);
    }
    ++map.height;
  }
  if (map.width < least_side || map.height < least_side)
    return error_in_row(path, row, fmt::format("expected 4 by 4 numbers or more, found {} by {}", map.width, map.height),
                        "a relief needs them");
  if (map.bad == map.cells.size()) return error_in_row(path, row, "no value was measured", "look at what --bad names");
  return map;
}

/// Fills what was not measured by the mean of the measured neighbours, ring by ring from the edge of each gap.
void fill_gaps(HeightMap& map) {
  std::vector<std::size_t> gaps;
  for (std::size_t i = 0; i < map.cells.size(); ++i)
    if (std::isnan(map.cells[i])) gaps.push_back(i);
  while (!gaps.empty()) {
    std::vector<std::pair<std::size_t, double>> filled;
    std::vector<std::size_t> left;
    for (const std::size_t at : gaps) {
      const std::size_t x = at % map.width, y = at / map.width;
      double sum = 0;
      int count = 0;
      for (std::size_t v = y == 0 ? 0 : y - 1; v <= std::min(y + 1, map.height - 1); ++v)
        for (std::size_t u = x == 0 ? 0 : x - 1; u <= std::min(x + 1, map.width - 1); ++u)
          if (const double value = map.cells[v * map.width + u]; !std::isnan(value)) sum += value, ++count;
      if (count > 0)
        filled.emplace_back(at, sum / count);
      else
        left.push_back(at);
    }
    for (const auto& [at, value] : filled) map.cells[at] = value;
    gaps = std::move(left);
  }
}

}  // namespace

Result<Draft> height_map_draft(const std::string& path, const std::string& text, const std::string& name,
                               const DraftOptions& options) {
  if (!options.unit)
    return missing_option("--unit", fmt::format("expected the unit of the heights in `{}`", visible_text(path)),
                          "for example, `--unit \"1 um\"`");
  if (!options.scale)
    return missing_option("--scale", fmt::format("expected the distance of two numbers of `{}`", visible_text(path)),
                          "for example, `--scale \"0.1 mm\"`");
  auto map = read_map(path, text, options);
  if (!map) return map.error();
  fill_gaps(*map);
  const auto [least, most] = std::ranges::minmax_element(map->cells);
  const double low = *least, range = *most - *least;
  if (range <= 0)
    return Error{.code = Code::flat_height,
                 .sentence = "all heights are the same, so it cannot push",
                 .mend = "name another file",
                 .place = {.name = path}};
  std::string picture = fmt::format("P5\n{} {}\n65535\n", map->width, map->height);
  picture.reserve(picture.size() + 2 * map->cells.size());
  for (const double cell : map->cells) {
    const auto code = static_cast<unsigned>(std::lround((cell - low) / range * 65535));
    picture += static_cast<char>(code >> 8), picture += static_cast<char>(code & 255);
  }
  const double scale = 1000 * *options.scale, height = 1000 * range * *options.unit;
  const double amplitude = options.amplitude.value_or(1);
  const std::string file = std::filesystem::path(path).filename().string();
  Draft draft{.name = name, .text = {}};
  draft.files.push_back({name + ".pgm", std::move(picture)});
  if (!options.amplitude)
    draft.assumed.push_back(fmt::format("how hard it pushes, {:.6g} N (--amplitude)", amplitude));
  if (map->bad > 0)
    draft.assumed.push_back(fmt::format("{} of {} heights, which were not measured: the mean of their neighbours", map->bad,
                                        map->cells.size()));
  draft.text = fmt::format(
      "/// The height map `{}`, {} by {} values {:.6g} mm apart, over {:.6g} mm.\nmaterial {} {{\n{}  physical {{\n"
      "    patch {:.6g} mm, {:.6g} mm\n"
      "    param amplitude = {:.6g} N in {:.6g} N .. {:.6g} N \"largest lateral force\"\n"
      "    height surface = image(\"{}.pgm\", scale: {:.6g} mm/px, height: {:.6g} mm)\n"
      "    force = lateral(surface, amplitude: amplitude)\n  }}\n}}\n",
      visible_text(file), map->width, map->height, scale, height, name,
      draft_names(name, "a height map, " + file, options.licence), scale * static_cast<double>(map->width),
      scale * static_cast<double>(map->height), amplitude, amplitude / 10, 2 * amplitude, name, scale, height);
  return draft;
}

}  // namespace wale
