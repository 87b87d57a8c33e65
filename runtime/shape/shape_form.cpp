#include "runtime/shape/shape_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wale {
namespace {

double square(double value) { return value * value; }

/// m; from a nearer edge the direction is the edge's own, since that of the point is only rounding.
constexpr double on_the_edge = 1e-12;

EdgeDistance distance(double metres, glm::dvec2 slope) noexcept {
  return {static_cast<float>(metres), glm::vec2(slope)};
}

}  // namespace

bool EllipseForm::contains(glm::dvec2 point) const noexcept {
  return square(point.x / half_.x) + square(point.y / half_.y) <= 1;
}

EdgeDistance EllipseForm::edge(glm::dvec2 point) const noexcept {
  // In the first quadrant with the major axis along x. The nearest point q of the ellipse is where its normal meets the
  // point p: p - q is a multiple of (q.x / a^2, q.y / b^2), so q = (a^2 p.x / (s + e), b^2 p.y / s) with e = a^2 - b^2,
  // and s is the greatest root of a function that is convex and falls. Newton's steps from its left never pass it
  // (Eberly 2013, Distance from a Point to an Ellipse).
  const bool wide = half_.x >= half_.y;
  const double a = wide ? half_.x : half_.y, b = wide ? half_.y : half_.x;
  const double x = std::abs(wide ? point.x : point.y), y = std::abs(wide ? point.y : point.x);
  const double e = square(a) - square(b), ax = a * x, by = b * y;
  constexpr int most_steps = 64;  // about 8 are taken
  double s = std::max(by, ax - e);
  glm::dvec2 nearest(0.0);
  if (s > 0) {
    for (int step = 0; step < most_steps; ++step) {
      const double u = ax / (s + e), v = by / s;
      const double value = square(u) + square(v) - 1;
      const double next = s + value / (2 * (square(u) / (s + e) + square(v) / s));
      if (!(next > s)) break;
      s = next;
    }
    nearest = {a * (ax / (s + e)), b * (by / s)};
  } else {  // on the major axis, near the middle
    const double share = e > 0 ? std::min(ax / e, 1.0) : 0.0;
    nearest = {a * share, b * std::sqrt(1 - square(share))};
  }
  const double metres = std::sqrt(square(x - nearest.x) + square(y - nearest.y));
  glm::dvec2 inward(-nearest.x / square(a), -nearest.y / square(b));
  inward /= std::sqrt(square(inward.x) + square(inward.y));
  if (!wide) std::swap(inward.x, inward.y);
  if (point.x < 0) inward.x = -inward.x;
  if (point.y < 0) inward.y = -inward.y;
  return distance(contains(point) ? metres : -metres, inward);
}

PolygonForm::PolygonForm(std::vector<glm::dvec2> corners) : corners_(std::move(corners)) {
  double area = 0;
  const auto next = [this](std::size_t i) { return corners_[i + 1 == corners_.size() ? 0 : i + 1]; };
  for (std::size_t i = 0; i < corners_.size(); ++i) area += corners_[i].x * next(i).y - corners_[i].y * next(i).x;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const glm::dvec2 along = next(i) - corners_[i];
    const double length_square = square(along.x) + square(along.y);
    const double left = (area > 0 ? 1 : -1) / std::sqrt(length_square);
    sides_.push_back({corners_[i], along, 1 / length_square, {-along.y * left, along.x * left}});
  }
}

PolygonForm PolygonForm::stretched(glm::dvec2 factors) const {
  std::vector<glm::dvec2> corners = corners_;
  for (glm::dvec2& corner : corners) corner *= factors;
  return PolygonForm(std::move(corners));
}

/// Whether a ray to the right crosses the edge an odd number of times.
bool PolygonForm::contains(glm::dvec2 point) const noexcept {
  bool inside = false;
  glm::dvec2 from = corners_.back();
  for (const glm::dvec2 to : corners_) {
    if ((from.y > point.y) != (to.y > point.y) &&
        point.x < from.x + (to.x - from.x) * ((point.y - from.y) / (to.y - from.y)))
      inside = !inside;
    from = to;
  }
  return inside;
}

EdgeDistance PolygonForm::edge(glm::dvec2 point) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  glm::dvec2 away(0.0), inward(0.0);
  for (const Side& side : sides_) {
    const glm::dvec2 from = point - side.from;
    const double share = std::clamp((from.x * side.along.x + from.y * side.along.y) * side.inverse_square, 0.0, 1.0);
    const glm::dvec2 to(from.x - share * side.along.x, from.y - share * side.along.y);
    const double distance_square = square(to.x) + square(to.y);
    if (distance_square >= least) continue;
    least = distance_square;
    away = to;
    inward = side.inward;
  }
  const double metres = std::sqrt(least);
  const double sign = contains(point) ? 1 : -1;
  if (metres <= on_the_edge) return distance(sign * metres, inward);
  return distance(sign * metres, away * (sign / metres));
}

MaskCells::MaskCells(std::span<const std::uint8_t> bits, std::size_t columns, std::size_t rows)
    : wide(columns + 2), high(rows + 2), cells(wide * high) {
  for (std::size_t row = 0; row < high; ++row) {
    const auto is_set = [&](std::size_t column) {
      if (column == 0 || row == 0 || column > columns || row > rows) return false;
      return bits[(rows - row) * columns + column - 1] != 0;
    };
    for (std::size_t first = 0; first < wide;) {
      std::size_t end = first + 1;
      while (end < wide && is_set(end) == is_set(first)) ++end;
      const Cell run{static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(end - 1), is_set(first)};
      for (; first < end; ++first) cells[row * wide + first] = run;
    }
  }
}

std::pair<std::size_t, std::size_t> MaskForm::cell_at(glm::dvec2 point) const noexcept {
  const auto within = [](double at, double side, std::size_t count) {
    const double cells = at / side + 0.5 * static_cast<double>(count);
    return cells > 0 ? std::min(static_cast<std::size_t>(std::min(cells, 1e6)), count - 1) : std::size_t{0};
  };
  return {within(point.x, cell_.x, cells_->wide), within(point.y, cell_.y, cells_->high)};
}

bool MaskForm::contains(glm::dvec2 point) const noexcept {
  const auto [column, row] = cell_at(point);
  return cells_->cell(column, row).is_set;
}

EdgeDistance MaskForm::edge(glm::dvec2 point) const noexcept {
  const MaskCells& all = *cells_;
  const double left = -0.5 * static_cast<double>(all.wide) * cell_.x,
               low = -0.5 * static_cast<double>(all.high) * cell_.y;
  const auto x_of = [&](std::size_t column) { return left + static_cast<double>(column) * cell_.x; };
  const auto y_of = [&](std::size_t row) { return low + static_cast<double>(row) * cell_.y; };
  const auto at = cell_at(point);
  const std::size_t column = at.first, row = at.second;  // clang 14 captures no structured bindings
  const bool inside = all.cell(column, row).is_set;
  double least = std::numeric_limits<double>::infinity();
  glm::dvec2 away(0.0), outward(0.0);
  // The nearest point of a cell of the other kind is so far along x and across. `direction` leads from here to there.
  const auto meet = [&](double along, double across, glm::dvec2 direction) {
    const double distance_square = square(along) + square(across);
    if (distance_square >= least) return;
    least = distance_square;
    away = {along, across};
    outward = direction;
  };
  const auto look = [&](std::size_t at, double across, glm::dvec2 up_or_down) {
    const MaskCells::Cell& cell = all.cell(column, at);
    if (cell.is_set != inside) {
      const double along = point.x - std::clamp(point.x, x_of(column), x_of(column + 1));
      return meet(along, across, up_or_down);
    }
    const bool same_row = across == 0;
    if (cell.first > 0)
      meet(std::max(point.x - x_of(cell.first), 0.0), across, same_row ? glm::dvec2(-1, 0) : up_or_down);
    if (cell.last + std::size_t{1} < all.wide)
      meet(std::min(point.x - x_of(cell.last + std::size_t{1}), 0.0), across, same_row ? glm::dvec2(1, 0) : up_or_down);
  };
  look(row, 0, {0, 1});
  for (std::size_t above = row + 1; above < all.high; ++above) {
    const double across = std::min(point.y - y_of(above), 0.0);
    if (square(across) >= least) break;
    look(above, across, {0, 1});
  }
  for (std::size_t below = row; below-- > 0;) {
    const double across = std::max(point.y - y_of(below + 1), 0.0);
    if (square(across) >= least) break;
    look(below, across, {0, -1});
  }
  const double metres = std::sqrt(least), sign = inside ? 1 : -1;
  if (metres <= on_the_edge) return distance(sign * metres, outward * -sign);
  return distance(sign * metres, away * (sign / metres));
}

}  // namespace wale
