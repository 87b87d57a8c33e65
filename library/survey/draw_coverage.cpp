#include <fmt/format.h>

#include <algorithm>

#include "compiler/drawing/style.hpp"
#include "library/survey/coverage.hpp"

namespace wale {
namespace {

constexpr double page_margin = 40, label_width = 150, strip_width = 780, strip_height = 46;
constexpr double square = 220, square_gap = 56;
constexpr int coverage_width = 1060;
constexpr std::size_t squares_in_row = 3;

void draw_strip(Canvas& canvas, double y, const CoveredPercept& percept) {
  const double left = page_margin + label_width;
  const auto at = [&](double level) { return left + level * strip_width; };
  canvas.write({page_margin, y + 6}, percept.percept, style::heading);
  for (const EmptyRange& gap : percept.empty)
    canvas.fill({at(gap.low), y - 13, at(gap.high), y + 13}, style::field_strong);
  canvas.line({left, y}, {left + strip_width, y}, {1, style::rule});
  for (const CoveredLevel& each : percept.levels)
    canvas.line({at(each.means.low), y}, {at(each.means.high), y}, {5, style::moving, 0.25f});
  for (const CoveredLevel& each : percept.levels)
    canvas.line({at(each.reads), y - 9}, {at(each.reads), y + 9}, {1.6, style::force, 0.8f});
  canvas.write({left + strip_width + 14, y + 6}, std::to_string(percept.levels.size()), style::label);
}

const CoveredLevel* level_of(const CoveredPercept& percept, const std::string& material) {
  const auto found = std::ranges::find(percept.levels, material, &CoveredLevel::material);
  return found == percept.levels.end() ? nullptr : &*found;
}

void draw_pair(Canvas& canvas, PagePoint corner, const CoveredPercept& a, const CoveredPercept& b,
               const CoveredPair& pair) {
  const PageBox box = {corner.x, corner.y, corner.x + square, corner.y + square};
  const auto x = [&](double level) { return box.left + level * square; };
  const auto y = [&](double level) { return box.bottom - level * square; };
  canvas.fill({x(pair.empty_a.low), y(pair.empty_b.high), x(pair.empty_a.high), y(pair.empty_b.low)},
              style::field_strong);
  canvas.outline(box, {1, style::rule});
  canvas.clip(box);
  for (const CoveredLevel& one : a.levels) {
    const CoveredLevel* other = level_of(b, one.material);
    if (!other) continue;
    const PagePoint place(x(one.reads), y(other->reads));
    canvas.line({x(one.means.low), place.y}, {x(one.means.high), place.y}, {1, style::moving, 0.5f});
    canvas.line({place.x, y(other->means.low)}, {place.x, y(other->means.high)}, {1, style::moving, 0.5f});
    canvas.fill({place.x - 2.5, place.y - 2.5, place.x + 2.5, place.y + 2.5}, style::force);
  }
  canvas.unclip();
  canvas.write({box.left, box.top - 8}, b.percept, style::label);
  canvas.write({box.right, box.bottom + 19}, a.percept, style::label, Align::right);
}

}  // namespace

Result<std::unique_ptr<Canvas>> draw_coverage(const Coverage& coverage) {
  const double strips = 130, pairs = strips + strip_height * static_cast<double>(coverage.percepts.size()) + 60;
  std::vector<const CoveredPair*> shown;  // the text names the others
  for (const CoveredPair& each : coverage.pairs)
    if (each.materials > 0) shown.push_back(&each);
  const std::size_t rows = (shown.size() + squares_in_row - 1) / squares_in_row;
  const double height = pairs + static_cast<double>(rows) * (square + square_gap) + page_margin;
  auto page = new_canvas(coverage_width, static_cast<int>(height), style::paper);
  if (!page) return page;
  Canvas& canvas = **page;
  canvas.write({page_margin, 54}, fmt::format("What {} materials feel like", coverage.materials), {Face::serif, 34, style::ink});
  canvas.write({page_margin, 84}, "levels that they read, with 95 % of the means of other groups; shaded: nothing is there",
               style::label);
  for (const double level : {0.0, 0.25, 0.5, 0.75, 1.0})
    canvas.write({page_margin + label_width + level * strip_width, 112}, fmt::format("{:g}", level), style::label, Align::centre);
  for (std::size_t i = 0; i < coverage.percepts.size(); ++i)
    draw_strip(canvas, strips + strip_height * static_cast<double>(i) + 14, coverage.percepts[i]);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const CoveredPair& pair = *shown[i];
    const PagePoint corner(page_margin + static_cast<double>(i % squares_in_row) * (square + 2 * square_gap),
                           pairs + static_cast<double>(i / squares_in_row) * (square + square_gap));
    draw_pair(canvas, corner, coverage.percepts[pair.a], coverage.percepts[pair.b], pair);
  }
  return page;
}

}  // namespace wale
