#include "compiler/preview/marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/drawing/style.hpp"

namespace wale {
namespace {

constexpr double stroke_width = 3;        // pixels; of lines, rings and springs
constexpr double wire_width = 2;          // pixels; of springs, whose coils may be close together
constexpr double halo = 3.5;              // pixels; the light edge behind a line is wider by this
constexpr double least_diameter = 6;      // pixels; of a point, so that it can be seen
constexpr double largest_dot = 24;        // pixels; larger points are rings
constexpr int coils = 8;                  // a spring keeps its number of coils when it is stretched
constexpr double lead = 0.1;              // of a spring's length: the straight part at either end
constexpr double farthest = 1000;         // sides of the picture; farther marks are left out
constexpr int fading_steps = 24;          // steps of colour along a trajectory, from old to new
constexpr PagePoint shadow = {2.5, 3.5};  // pixels; the light comes from the upper left
constexpr float shadow_opacity = 0.2f;

Colour colour_of(std::uint32_t code) {
  const auto part = [code](int shift) { return static_cast<float>(code >> shift & 0xff) / 255; };
  return {part(16), part(8), part(0)};
}

class MarkPainter {
 public:
  MarkPainter(Canvas& canvas, const PageBox& box, const Exhibit& exhibit)
      : canvas_(canvas), box_(box), centre_(exhibit.centre), pixels_per_metre_(box.width() / exhibit.side) {}

  PagePoint page(double x, double y) const {
    return {(box_.left + box_.right) / 2 + (x - centre_.x) * pixels_per_metre_,
            (box_.top + box_.bottom) / 2 - (y - centre_.y) * pixels_per_metre_};
  }

  bool is_somewhere(double x, double y) const {
    const double most = farthest * box_.width() / pixels_per_metre_;
    return std::abs(x) <= most && std::abs(y) <= most;
  }

  void draw(const ShownMark& mark, const std::vector<glm::vec2>& path) {
    const auto& v = mark.values;
    const Colour colour = colour_of(mark.colour);
    for (std::size_t i = 0; i < mark_operands(mark.kind); ++i) {
      if (!std::isfinite(v[i])) return;
    }
    if (!is_somewhere(v[0], v[1])) return;
    const PagePoint at = page(v[0], v[1]);
    switch (mark.kind) {
      case MarkKind::point: return disc(at, pixels(v[2]), colour);
      case MarkKind::circle: return ring(at, pixels(v[2]), colour);
      case MarkKind::box:
        if (is_somewhere(v[2], v[3])) rectangle(at, pixels(v[2]), pixels(v[3]), v[4], colour);
        return;
      case MarkKind::line:
        if (is_somewhere(v[2], v[3])) edged(std::array{at, page(v[2], v[3])}, colour);
        return;
      case MarkKind::spring:
        if (is_somewhere(v[2], v[3]) && is_somewhere(v[4], 0)) spring(at, page(v[2], v[3]), pixels(v[4]), colour);
        return;
      case MarkKind::trajectory: return trajectory(path, at, colour);
    }
  }

  /// The hand: a ring, which hides little of the surface.
  void draw_hand(glm::vec2 place) {
    const PagePoint at = page(place.x, place.y);
    circle(at, 11, {4.5, style::paper, 0.7f});
    circle(at, 11, {2, style::ink});
  }

 private:
  double pixels(double length) const { return std::abs(length) * pixels_per_metre_; }

  void circle(PagePoint at, double radius, const Pen& pen) {
    std::vector<PagePoint> points;
    const int count = std::clamp(static_cast<int>(radius * 1.5), 48, 720);
    for (int i = 0; i <= count; ++i) {
      const double angle = 6.283185307179586 * i / count;
      points.push_back(at + PagePoint(std::cos(angle), std::sin(angle)) * radius);
    }
    canvas_.stroke(points, pen);
  }

  void ring(PagePoint at, double radius, Colour colour) {
    if (radius > farthest * box_.width()) return;
    circle(at, radius, {stroke_width + halo, style::paper, 0.6f});
    circle(at, radius, {stroke_width, colour});
  }

  void dot(PagePoint at, double diameter, Colour colour, float opacity) {
    canvas_.line(at, at, {diameter, colour, opacity});
  }

  /// A dot; a large one is a ring with a dot in its middle, so that it covers nothing.
  void disc(PagePoint at, double diameter, Colour colour) {
    if (diameter > farthest * box_.width()) return;
    diameter = std::max(diameter, least_diameter);
    if (diameter > largest_dot) return ring(at, diameter / 2, colour), dot(at, least_diameter, colour, 1);
    dot(at + shadow, diameter, style::ink, shadow_opacity);
    dot(at, diameter + 2.5, style::paper, 0.75f);
    dot(at, diameter, colour, 1);
  }

  /// An outline: what the box marks stays visible inside.
  void rectangle(PagePoint at, double width, double height, double angle, Colour colour) {
    // Counterclockwise on the patch: its y points up, and that of the page down.
    const PagePoint along = PagePoint(std::cos(angle), -std::sin(angle)) * (width / 2),
                    across = PagePoint(std::sin(angle), std::cos(angle)) * (height / 2);
    const std::array corners = {at - along - across, at + along - across, at + along + across, at - along + across};
    edged(std::array{corners[0], corners[1], corners[2], corners[3], corners[0]}, colour);
  }

  void edged(std::span<const PagePoint> points, Colour colour, double width = stroke_width) {
    canvas_.stroke(points, {width + halo, style::paper, 0.6f});
    canvas_.stroke(points, {width, colour});
  }

  void spring(PagePoint from, PagePoint to, double width, Colour colour) {
    const PagePoint along = to - from;
    const double length = std::hypot(along.x, along.y);
    const PagePoint way = length > 0 ? along / length : PagePoint(1, 0), side(-way.y, way.x);
    std::vector<PagePoint> points = {from};
    constexpr int swings = 2 * coils;  // turns to one side and the other
    for (int i = 0; i <= swings + 1; ++i) {
      const double part = lead + (1 - 2 * lead) * i / (swings + 1);
      const double aside = i == 0 || i > swings ? 0 : (i % 2 == 1 ? 0.5 : -0.5) * width;
      points.push_back(from + along * part + side * aside);
    }
    points.push_back(to);
    edged(points, colour, wire_width);
    dot(from, 7, colour, 1);
    dot(to, 7, colour, 1);
  }

  /// Old parts are pale. The colour is mixed and not transparent, so that overlapping pieces leave no beads.
  void trajectory(const std::vector<glm::vec2>& path, PagePoint now, Colour colour) {
    std::vector<PagePoint> points;
    for (glm::vec2 place : path) {
      if (is_somewhere(place.x, place.y)) points.push_back(page(place.x, place.y));
    }
    const std::size_t count = points.size();
    for (int step = 0; step < fading_steps && count > 1; ++step) {
      const std::size_t first = (count - 1) * static_cast<std::size_t>(step) / fading_steps,
                        last = (count - 1) * static_cast<std::size_t>(step + 1) / fading_steps;
      const float age = 1 - static_cast<float>(step + 1) / fading_steps;
      canvas_.stroke(std::span(points).subspan(first, last - first + 1),
                     {1.4 + 1.6 * (1 - age), mixed(colour, style::paper, 0.75f * age)});
    }
    dot(now, least_diameter, colour, 1);
  }

  Canvas& canvas_;
  const PageBox& box_;
  glm::dvec2 centre_;
  double pixels_per_metre_;
};

}  // namespace

void draw_marks(Canvas& canvas, const PageBox& box, const Exhibit& exhibit, const Rehearsal& rehearsal) {
  canvas.clip(box);
  MarkPainter painter(canvas, box, exhibit);
  if (remembers(rehearsal.memory.program().description())) painter.draw_hand(rehearsal.hand.position);
  for (std::size_t i = 0; i < rehearsal.marks.size(); ++i) painter.draw(rehearsal.marks[i], rehearsal.paths[i]);
  canvas.unclip();
}

}  // namespace wale
