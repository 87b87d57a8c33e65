#include "compiler/read/bend.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace wale {
namespace {

constexpr double least_beyond = 0.012;  // of the places, on either side of a bend

/// Sorts places that lie about evenly along the line, as those of a patch do, in time proportional to their number:
/// into as many intervals as there are places, and each interval by itself.
std::vector<PlaceOnLine> sorted(const std::vector<PlaceOnLine>& line) {
  const auto ends_of_line = std::ranges::minmax(line, {}, &PlaceOnLine::at);
  const double low = ends_of_line.min.at;
  const double scale = static_cast<double>(line.size()) / (ends_of_line.max.at - low);
  std::vector<PlaceOnLine> result = line;
  if (!std::isfinite(scale)) return result;  // all are in one place
  const auto interval = [&](const PlaceOnLine& each) {
    return std::min(static_cast<std::size_t>((each.at - low) * scale), line.size() - 1);
  };
  std::vector<std::uint32_t> ends(line.size() + 1);
  for (const PlaceOnLine& each : line) ++ends[interval(each) + 1];
  for (std::size_t i = 1; i < ends.size(); ++i) ends[i] += ends[i - 1];
  std::vector<std::uint32_t> next(ends.begin(), ends.end() - 1);
  for (const PlaceOnLine& each : line) result[next[interval(each)]++] = each;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    if (ends[i + 1] - ends[i] > 1)
      std::sort(result.begin() + ends[i], result.begin() + ends[i + 1],
                [](const PlaceOnLine& a, const PlaceOnLine& b) { return a.at < b.at; });
  return result;
}

}  // namespace

Bend best_bend(const std::vector<PlaceOnLine>& line, BendKind kind, std::size_t every) {
  return line.empty() ? Bend{} : best_bend_of_sorted(sorted(line), kind, every);
}

Bend best_bend_of_sorted(std::vector<PlaceOnLine> line, BendKind kind, std::size_t every) {
  // Centred and in units of the line's length, so that the sums are well conditioned.
  const double low = line.front().at, length = line.back().at - low;
  if (!(length > 0)) return {};
  const auto count = static_cast<double>(line.size());
  double u1 = 0, u2 = 0, s1 = 0, us = 0, ss = 0;
  for (PlaceOnLine& each : line) {
    each.at = (each.at - low) / length;
    u1 += each.at, u2 += each.at * each.at, s1 += each.value, us += each.at * each.value, ss += each.value * each.value;
  }
  // Of the places beyond the bend.
  double n = count, v1 = u1, v2 = u2, t1 = s1, vt = us;
  const auto margin = std::max<std::size_t>(8, static_cast<std::size_t>(least_beyond * count));
  Bend best;
  for (std::size_t i = 0; i + margin < line.size(); ++i) {
    const double u = line[i].at, value = line[i].value;
    n -= 1, v1 -= u, v2 -= u * u, t1 -= value, vt -= u * value;
    if (i < margin || i % every != 0) continue;
    const double d = u, h1 = v1 - n * d, h2 = v2 - 2 * d * v1 + n * d * d, hu = v2 - d * v1, hs = vt - d * t1;
    std::array<double, 4> found{};
    if (kind == BendKind::bends_and_jumps) {
      std::array<std::array<double, 5>, 4> rows = {
          {{count, u1, h1, n, s1}, {u1, u2, hu, v1, us}, {h1, hu, h2, h1, hs}, {n, v1, h1, n, t1}}};
      if (!solve<4>(rows)) continue;
      found = {rows[0][4], rows[1][4], rows[2][4], rows[3][4]};
    } else if (kind == BendKind::bends) {
      std::array<std::array<double, 4>, 3> rows = {{{count, u1, h1, s1}, {u1, u2, hu, us}, {h1, hu, h2, hs}}};
      if (!solve<3>(rows)) continue;
      found = {rows[0][3], rows[1][3], rows[2][3], 0};
    } else {
      std::array<std::array<double, 4>, 3> rows = {{{count, u1, n, s1}, {u1, u2, v1, us}, {n, v1, n, t1}}};
      if (!solve<3>(rows)) continue;
      found = {rows[0][3], rows[1][3], 0, rows[2][3]};
    }
    const double explained = found[0] * s1 + found[1] * us + found[2] * hs + found[3] * t1;
    const double left = (ss - explained) / count;
    if (left < best.left) best = {low + length * d, found[2] / length, found[3], left};
  }
  return best;
}

std::optional<std::array<Bend, 2>> best_two_bends(const std::vector<PlaceOnLine>& line) {
  constexpr std::size_t parts = 48;
  if (line.size() < 4 * parts) return std::nullopt;
  const auto ends = std::ranges::minmax(line, {}, &PlaceOnLine::at);
  const double low = ends.min.at, length = ends.max.at - low;
  if (!(length > 0)) return std::nullopt;
  struct Part {
    double count = 0, at = 0, value = 0;
  };
  std::array<Part, parts> means{};
  for (const PlaceOnLine& each : line) {
    Part& part = means[std::min(static_cast<std::size_t>((each.at - low) / length * parts), parts - 1)];
    part.count += 1, part.at += (each.at - low) / length, part.value += each.value;
  }
  for (Part& each : means)
    if (each.count > 0) each.at /= each.count, each.value /= each.count;
  std::optional<std::array<Bend, 2>> best;
  double least = HUGE_VAL;
  for (std::size_t i = 1; i + 3 < parts; ++i)
    for (std::size_t k = i + 2; k + 1 < parts; ++k) {
      const double first = static_cast<double>(i) / parts, second = static_cast<double>(k) / parts;
      std::array<std::array<double, 5>, 4> rows{};
      double squares = 0;
      for (const Part& each : means) {
        const std::array<double, 5> columns = {1, each.at, std::max(0.0, each.at - first),
                                               std::max(0.0, each.at - second), each.value};
        for (std::size_t row = 0; row < 4; ++row)
          for (std::size_t column = 0; column < 5; ++column)
            rows[row][column] += each.count * columns[row] * columns[column];
        squares += each.count * each.value * each.value;
      }
      std::array<double, 4> right{};
      for (std::size_t row = 0; row < 4; ++row) right[row] = rows[row][4];
      if (!solve<4>(rows)) continue;
      double left = squares;
      for (std::size_t row = 0; row < 4; ++row) left -= rows[row][4] * right[row];
      if (!(left < least)) continue;
      least = left;
      best = {{{low + length * first, rows[2][4] / length, 0, left},
               {low + length * second, rows[3][4] / length, 0, left}}};
    }
  return best;
}

}  // namespace wale
