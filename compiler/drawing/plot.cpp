#include "compiler/drawing/plot.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/drawing/style.hpp"

namespace wale {
namespace {

struct AxisRange {
  double low = 0, high = 0;
};

/// The y axis of a plot, in shown units, with space above and below the curves.
AxisRange y_range(const Plot& plot) {
  double low = 1e300, high = -1e300;
  for (const Curve& curve : plot.curves) {
    for (double value : curve.profile.values) low = std::min(low, value), high = std::max(high, value);
  }
  if (plot.bound > 0) low = std::min(low, -plot.bound), high = std::max(high, plot.bound);
  low *= plot.y_notation.per_si, high *= plot.y_notation.per_si;
  if (plot.balanced) high = std::max(std::abs(low), std::abs(high)), low = -high;
  if (!(high - low > 1e-9 * std::max(std::abs(high), std::abs(low)))) low -= 1, high += 1;
  const double air = 0.1 * (high - low);
  return {low - air, high + air};
}

std::string with_unit(const std::string& name, const Notation& notation) {
  return notation.unit.empty() ? name : name + ", " + notation.unit;
}

/// The lengths of a key: of the line before each name, from there to the name, and of the gap between two.
struct KeyMeasure {
  double line = 26, before = 10, gap = 26;
};

double key_width(Canvas& canvas, const Plot& plot, const KeyMeasure& measure) {
  double width = 0;
  for (const Curve& curve : plot.curves)
    if (!curve.name.empty()) width += canvas.width_of(curve.name, style::label) + measure.before + measure.line + measure.gap;
  return width;
}

/// The names of the curves, each after a line in its colour, right-aligned with the title. On a narrow plot they stand
/// closer together, so that they do not run into the title.
void write_key(Canvas& canvas, const PageBox& box, const Plot& plot) {
  KeyMeasure measure;
  const double room = box.width() - canvas.width_of(plot.title, style::heading);
  if (key_width(canvas, plot, measure) > room) measure = {.line = 9, .before = 5, .gap = 9};
  double right = box.right;
  for (std::size_t i = plot.curves.size(); i-- > 0;) {
    const Curve& curve = plot.curves[i];
    if (curve.name.empty()) continue;
    canvas.write({right, box.top - 16}, curve.name, style::label, Align::right);
    right -= canvas.width_of(curve.name, style::label) + measure.before;
    canvas.line({right - measure.line, box.top - 21}, {right, box.top - 21}, {2.6, curve.colour});
    right -= measure.line + measure.gap;
  }
}

}  // namespace

void draw_plot(Canvas& canvas, const PageBox& box, const Plot& plot) {
  const AxisRange y = y_range(plot);
  const Profile& first = plot.curves.front().profile;
  const AxisRange x = {first.at.front() * plot.x_notation.per_si, first.at.back() * plot.x_notation.per_si};
  const auto page_x = [&](double shown) { return box.left + (shown - x.low) / (x.high - x.low) * box.width(); };
  const auto page_y = [&](double shown) { return box.bottom - (shown - y.low) / (y.high - y.low) * box.height(); };

  canvas.write({box.left, box.top - 16}, plot.title, style::heading);
  write_key(canvas, box, plot);

  for (const Tick& tick : round_ticks(y.low, y.high, box.height() > 300 ? 9 : 5)) {
    const double at = page_y(tick.at);
    canvas.line({box.left, at}, {box.right, at}, {tick.at == 0 ? 1.2 : 0.8, tick.at == 0 ? style::quiet : style::rule});
    canvas.write({box.left - 12, at + 5.5}, tick.label, style::label, Align::right);
  }
  for (const Tick& tick : round_ticks(x.low, x.high, 10)) {
    const double at = page_x(tick.at);
    canvas.line({at, box.top}, {at, box.bottom}, {0.8, style::rule});
    if (!plot.x_name.empty()) canvas.write({at, box.bottom + 24}, tick.label, style::label, Align::centre);
  }
  if (!plot.x_name.empty()) {
    canvas.write({box.right, box.bottom + 49}, with_unit(plot.x_name, plot.x_notation), style::label, Align::right);
  }
  canvas.write({box.left - 12, box.top - 16}, plot.y_notation.unit, style::label, Align::right);

  if (plot.bound > 0) {
    for (double sign : {-1.0, 1.0}) {
      const double at = page_y(sign * plot.bound * plot.y_notation.per_si);
      canvas.line({box.left, at}, {box.right, at}, {1.2, style::quiet, 1, 7});
    }
  }
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const Curve& curve = plot.curves[i];
    std::vector<PagePoint> points;
    for (std::size_t k = 0; k < curve.profile.at.size(); ++k) {
      points.emplace_back(page_x(curve.profile.at[k] * plot.x_notation.per_si),
                          page_y(curve.profile.values[k] * plot.y_notation.per_si));
    }
    if (plot.shaded && i == 0) canvas.shade(points, box.bottom, curve.colour, 0.16f);
    canvas.stroke(points, {2.2, curve.colour});
  }
  canvas.outline(box, {1, style::rule});
}

}  // namespace wale
