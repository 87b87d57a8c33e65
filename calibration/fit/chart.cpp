#include "calibration/fit/chart.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/drawing/axis.hpp"
#include "compiler/drawing/style.hpp"

namespace wale {
namespace {

constexpr int page_width = 900, page_height = 600;
constexpr PageBox frame = {100, 70, 860, 500};

/// One axis: values to pixels.
struct Scale {
  double low = 0, high = 1, from = 0, to = 1;
  bool log = false;

  bool holds(double value) const { return std::isfinite(value) && (!log || value > 0); }
  double shown(double value) const { return log ? std::log10(value) : value; }
  double pixel(double value) const { return from + (shown(value) - low) / (high - low) * (to - from); }
};

Scale scale_over(const Chart& chart, bool vertical) {
  Scale scale{.from = vertical ? frame.bottom : frame.left,
              .to = vertical ? frame.top : frame.right,
              .log = vertical ? chart.log_y : chart.log_x};
  bool any = false;
  for (const ChartSeries& series : chart.series)
    for (const glm::dvec2& point : series.points) {
      const double value = vertical ? point.y : point.x;
      if (!scale.holds(value)) continue;
      const double shown = scale.shown(value);
      scale.low = any ? std::min(scale.low, shown) : shown, scale.high = any ? std::max(scale.high, shown) : shown;
      any = true;
    }
  const double margin = std::max(0.06 * (scale.high - scale.low), 1e-9 + 0.01 * std::abs(scale.high));
  scale.low -= margin, scale.high += margin;
  return scale;
}

std::vector<Tick> ticks_of(const Scale& scale) {
  if (!scale.log) return round_ticks(scale.low, scale.high, 6);
  std::vector<Tick> ticks;
  for (const std::vector<int>& steps : {std::vector{1, 2, 5}, std::vector{1}}) {
    ticks.clear();
    for (int power = static_cast<int>(std::floor(scale.low)); power <= std::ceil(scale.high); ++power)
      for (const int step : steps) {
        const double value = step * std::pow(10, power);
        if (scale.shown(value) >= scale.low && scale.shown(value) <= scale.high)
          ticks.push_back({value, shown_number(value)});
      }
    if (ticks.size() <= 10) break;
  }
  return ticks;
}

/// Words beside points. Of points that lie on each other, the first has a word, and how many more there are.
void write_labels(Canvas& canvas, const ChartSeries& series, const std::vector<PagePoint>& points) {
  const auto is_near = [&](std::size_t a, std::size_t b) {
    return std::abs(points[a].x - points[b].x) < 40 && std::abs(points[a].y - points[b].y) < 12;
  };
  std::vector<std::size_t> shown, more;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = std::ranges::find_if(shown, [&](std::size_t each) { return is_near(each, i); });
    if (at == shown.end()) shown.push_back(i), more.push_back(0);
    else ++more[static_cast<std::size_t>(at - shown.begin())];
  }
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const PagePoint at = points[shown[k]];
    const bool is_right = at.x > frame.right - 120;
    const std::string label =
        series.labels[shown[k]] + (more[k] > 0 ? " and " + std::to_string(more[k]) + " more" : std::string());
    canvas.write({at.x + (is_right ? -8 : 8), at.y - 6}, label, {Face::sans, 13.5, series.colour},
                 is_right ? Align::right : Align::left);
  }
}

}  // namespace

Result<std::unique_ptr<Canvas>> draw_chart(const Chart& chart) {
  auto page = new_canvas(page_width, page_height, style::paper);
  if (!page) return page.error();
  Canvas& canvas = **page;
  const Scale across = scale_over(chart, false), up = scale_over(chart, true);
  canvas.write_within({frame.left, 40}, frame.width(), chart.title, {Face::serif, 24, style::ink});
  const Pen rule{1, style::rule};
  if (chart.x_words.empty()) {
    for (const Tick& tick : ticks_of(across)) {
      canvas.line({across.pixel(tick.at), frame.top}, {across.pixel(tick.at), frame.bottom}, rule);
      canvas.write({across.pixel(tick.at), frame.bottom + 22}, tick.label, style::label, Align::centre);
    }
  } else {
    const double room = frame.width() / static_cast<double>(chart.x_words.size());
    for (std::size_t i = 0; i < chart.x_words.size(); ++i)
      canvas.write_within({across.pixel(static_cast<double>(i)), frame.bottom + (i % 2 == 0 ? 22 : 42)}, 2 * room,
                          chart.x_words[i], style::label, Align::centre);
  }
  for (const Tick& tick : ticks_of(up)) {
    canvas.line({frame.left, up.pixel(tick.at)}, {frame.right, up.pixel(tick.at)}, rule);
    canvas.write({frame.left - 8, up.pixel(tick.at) + 5}, tick.label, style::label, Align::right);
  }
  canvas.outline(frame, {1, style::quiet});
  canvas.clip(frame);
  for (const ChartSeries& series : chart.series) {
    std::vector<PagePoint> points;
    for (const glm::dvec2& point : series.points)
      if (across.holds(point.x) && up.holds(point.y)) points.push_back({across.pixel(point.x), up.pixel(point.y)});
    if (series.line) {
      canvas.stroke(points, {2, series.colour});
      continue;
    }
    if (series.labels.size() == points.size()) write_labels(canvas, series, points);
    for (const PagePoint& at : points) {
      const PagePoint corners[] = {{at.x - 4, at.y}, {at.x, at.y - 4}, {at.x + 4, at.y}, {at.x, at.y + 4}};
      canvas.area(corners, series.colour, 0.75f);
    }
  }
  canvas.unclip();
  canvas.write_within({frame.left, page_height - 30}, frame.width(), chart.x_name, style::heading);
  canvas.write_within({frame.left, 62}, frame.width() / 2, chart.y_name, style::heading);
  double key = frame.left;
  std::size_t named = 0;
  for (const ChartSeries& series : chart.series) {
    if (series.name.empty() || ++named > 6) continue;
    canvas.write_within({key, page_height - 8}, 150, series.name, {Face::sans, 15.5, series.colour});
    key += std::min(150.0, canvas.width_of(series.name, style::label)) + 24;
  }
  return std::move(*page);
}

}  // namespace wale
