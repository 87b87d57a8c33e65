#include "compiler/preview/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "schema/utf8.hpp"

namespace wale {
namespace {

constexpr std::array<std::string_view, 5> sans_fonts = {"DejaVuSans.ttf", "LiberationSans-Regular.ttf",
                                                        "NotoSans-Regular.ttf", "FreeSans.ttf", "Arial.ttf"};
constexpr std::array<std::string_view, 4> serif_fonts = {"DejaVuSerif.ttf", "LiberationSerif-Regular.ttf",
                                                         "NotoSerif-Regular.ttf", "FreeSerif.ttf"};

/// The text as a font can draw it: control characters become spaces, and bytes that are not UTF-8 question marks.
std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const Character letter = decode(text, at);
    if (!letter.valid) {
      result += '?';
    } else if (letter.code < 0x20 || (letter.code >= 0x7f && letter.code < 0xa0)) {
      result += ' ';
    } else {
      result += text.substr(at, letter.bytes);
    }
    at += letter.bytes;
  }
  return result;
}

/// Removes the last letter of `text`.
void drop_letter(std::string& text) {
  while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) text.pop_back();
  if (!text.empty()) text.pop_back();
}

double squared_distance_to_segment(PagePoint p, PagePoint a, PagePoint b) {
  const PagePoint along = b - a, to = p - a;
  const double length2 = along.x * along.x + along.y * along.y;
  const double t = length2 > 0 ? std::clamp((to.x * along.x + to.y * along.y) / length2, 0.0, 1.0) : 0.0;
  const PagePoint off = to - t * along;
  return off.x * off.x + off.y * off.y;
}

/// Where a row of pixels may be nearer to the segment than `reach`: from, to.
std::pair<double, double> row_of_segment(PagePoint a, PagePoint b, double y, double reach) {
  double from = std::min(a.x, b.x) - reach, to = std::max(a.x, b.x) + reach;
  const PagePoint along = b - a;
  if (std::abs(along.y) > 1e-6) {
    const double middle = a.x + (y - a.y) * along.x / along.y;
    const double half = reach * std::hypot(along.x, along.y) / std::abs(along.y);
    from = std::max(from, middle - half), to = std::min(to, middle + half);
  }
  return {from, to};
}

/// The pixels of a row that a stroke touches.
struct Touched {
  int first, last;
};

/// The pieces of a line that the dashes of a pen draw.
std::vector<std::vector<PagePoint>> dashed(std::span<const PagePoint> points, double dash) {
  std::vector<std::vector<PagePoint>> pieces;
  if (dash <= 0) return {std::vector<PagePoint>(points.begin(), points.end())};
  double gone = 0;
  bool pen_down = true;
  std::vector<PagePoint> piece = {points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    PagePoint from = points[i - 1];
    double left = std::hypot(points[i].x - from.x, points[i].y - from.y);
    while (gone + left >= dash) {
      const double part = (dash - gone) / left;
      from += (points[i] - from) * part;
      left -= dash - gone;
      gone = 0;
      piece.push_back(from);
      if (pen_down) pieces.push_back(piece);
      pen_down = !pen_down;
      piece = {from};
    }
    gone += left;
    piece.push_back(points[i]);
  }
  if (pen_down) pieces.push_back(piece);
  return pieces;
}

}  // namespace

Colour mixed(Colour first, Colour second, float part) {
  const auto between = [part](float a, float b) { return a + (b - a) * part; };
  return {between(first.red, second.red), between(first.green, second.green), between(first.blue, second.blue)};
}

Canvas::Canvas(int width, int height, Colour paper)
    : width_(width * fineness), height_(height * fineness), clip_{0, 0, width_, height_} {
  pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 3);
  fill({0, 0, static_cast<double>(width), static_cast<double>(height)}, paper);
  sans_ = Font::find(sans_fonts);
  serif_ = Font::find(serif_fonts);
  if (!serif_) serif_ = sans_;
}

void Canvas::blend(int x, int y, Colour colour, float opacity) {
  if (opacity <= 0 || x < clip_.left || y < clip_.top || x >= clip_.right || y >= clip_.bottom) return;
  float* pixel =
      &pixels_[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)) * 3];
  pixel[0] += (colour.red - pixel[0]) * opacity;
  pixel[1] += (colour.green - pixel[1]) * opacity;
  pixel[2] += (colour.blue - pixel[2]) * opacity;
}

void Canvas::fill(const PageBox& box, Colour colour) {
  const auto fine = [](double x) { return static_cast<int>(std::lround(x * fineness)); };
  for (int y = fine(box.top); y < fine(box.bottom); ++y) {
    for (int x = fine(box.left); x < fine(box.right); ++x) blend(x, y, colour, 1);
  }
}

void Canvas::outline(const PageBox& box, const Pen& pen) {
  const std::array corners = {PagePoint(box.left, box.top), PagePoint(box.right, box.top),
                              PagePoint(box.right, box.bottom), PagePoint(box.left, box.bottom),
                              PagePoint(box.left, box.top)};
  stroke(corners, pen);
}

// ImageBufAlgo::render_line has neither width nor smooth edges, so lines are drawn here by the distance of each pixel.
void Canvas::stroke(std::span<const PagePoint> points, const Pen& pen) {
  if (points.size() < 2) return;
  const double radius = pen.width * fineness / 2;
  const double core = std::max(radius - 0.5, 0.0), squared_core = core * core;  // there a pixel is covered whole
  for (std::vector<PagePoint> piece : dashed(points, pen.dash)) {
    for (PagePoint& point : piece) point *= fineness;
    double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
    for (const PagePoint& point : piece) {
      left = std::min(left, point.x), right = std::max(right, point.x);
      top = std::min(top, point.y), bottom = std::max(bottom, point.y);
    }
    const auto inside = [](double value, int low, int high) {
      return static_cast<int>(std::clamp(value, double(low), double(high)));
    };
    const int x0 = inside(left - radius - 2, clip_.left, clip_.right),
              x1 = inside(right + radius + 2, clip_.left, clip_.right);
    const int y0 = inside(top - radius - 2, clip_.top, clip_.bottom),
              y1 = inside(bottom + radius + 2, clip_.top, clip_.bottom);
    if (x0 >= x1 || y0 >= y1) continue;
    const auto stride = static_cast<std::size_t>(x1 - x0);
    std::vector<float> coverage(stride * static_cast<std::size_t>(y1 - y0), 0.0f);
    std::vector<Touched> rows(static_cast<std::size_t>(y1 - y0), Touched{x1, x0});
    for (std::size_t i = 1; i < piece.size(); ++i) {
      const PagePoint a = piece[i - 1], b = piece[i];
      const int first = inside(std::floor(std::min(a.y, b.y) - radius - 1), y0, y1),
                last = inside(std::ceil(std::max(a.y, b.y) + radius + 1), y0, y1);
      for (int y = first; y < last; ++y) {
        const auto [near, far] = row_of_segment(a, b, y + 0.5, radius + 1);
        const int x_first = inside(std::floor(near), x0, x1), x_last = inside(std::ceil(far), x0, x1);
        Touched& row = rows[static_cast<std::size_t>(y - y0)];
        row = {std::min(row.first, x_first), std::max(row.last, x_last)};
        for (int x = x_first; x < x_last; ++x) {
          const double squared = squared_distance_to_segment({x + 0.5, y + 0.5}, a, b);
          float& covered = coverage[static_cast<std::size_t>(y - y0) * stride + static_cast<std::size_t>(x - x0)];
          covered =
              std::max(covered, squared <= squared_core
                                    ? 1.0f
                                    : static_cast<float>(std::clamp(radius + 0.5 - std::sqrt(squared), 0.0, 1.0)));
        }
      }
    }
    for (int y = y0; y < y1; ++y) {
      const Touched& row = rows[static_cast<std::size_t>(y - y0)];
      for (int x = row.first; x < row.last; ++x) {
        const float covered = coverage[static_cast<std::size_t>(y - y0) * stride + static_cast<std::size_t>(x - x0)];
        blend(x, y, pen.colour, covered * pen.opacity);
      }
    }
  }
}

void Canvas::line(PagePoint from, PagePoint to, const Pen& pen) {
  const std::array points = {from, to};
  stroke(points, pen);
}

void Canvas::shade(std::span<const PagePoint> points, double base, Colour colour, float opacity) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const PagePoint a = points[i - 1], b = points[i];
    const int first = static_cast<int>(std::lround(a.x * fineness)),
              last = static_cast<int>(std::lround(b.x * fineness));
    for (int x = first; x < last; ++x) {
      const double part = ((x + 0.5) / fineness - a.x) / (b.x - a.x);
      const double edge = a.y + (b.y - a.y) * std::clamp(part, 0.0, 1.0);
      const double top = std::min(edge, base) * fineness, bottom = std::max(edge, base) * fineness;
      for (int y = static_cast<int>(std::floor(top)); y < static_cast<int>(std::ceil(bottom)); ++y) {
        const double covered = std::min(bottom, y + 1.0) - std::max(top, double(y));
        blend(x, y, colour, opacity * static_cast<float>(std::clamp(covered, 0.0, 1.0)));
      }
    }
  }
}

void Canvas::area(std::span<const PagePoint> corners, Colour colour, float opacity) {
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9, doubled_area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PagePoint a = corners[i], b = corners[(i + 1) % corners.size()];
    left = std::min(left, a.x), right = std::max(right, a.x);
    top = std::min(top, a.y), bottom = std::max(bottom, a.y);
    doubled_area += a.x * b.y - a.y * b.x;
  }
  const auto inside = [](double value, int low, int high) {
    return static_cast<int>(std::clamp(value * fineness, double(low), double(high)));
  };
  // The inside of an edge: where normal * (point - corner) is positive, which is then its distance.
  std::vector<std::pair<PagePoint, PagePoint>> edges;
  const double turn = doubled_area < 0 ? -1 : 1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PagePoint along = corners[(i + 1) % corners.size()] - corners[i];
    const double length = std::hypot(along.x, along.y);
    if (length > 0) edges.emplace_back(corners[i], PagePoint(-along.y, along.x) * (turn / length));
  }
  for (int y = inside(top - 1, clip_.top, clip_.bottom); y < inside(bottom + 1, clip_.top, clip_.bottom); ++y) {
    for (int x = inside(left - 1, clip_.left, clip_.right); x < inside(right + 1, clip_.left, clip_.right); ++x) {
      double depth = 1e9;  // how far inside the nearest edge, canvas pixels
      for (const auto& [corner, normal] : edges) {
        const PagePoint to = PagePoint(x + 0.5, y + 0.5) / double(fineness) - corner;
        depth = std::min(depth, (normal.x * to.x + normal.y * to.y) * fineness);
      }
      blend(x, y, colour, opacity * static_cast<float>(std::clamp(depth + 0.5, 0.0, 1.0)));
    }
  }
}

void Canvas::clip(const PageBox& box) {
  const auto fine = [](double x, int most) {
    return static_cast<int>(std::clamp(std::round(x * fineness), 0.0, double(most)));
  };
  clip_ = {fine(box.left, width_), fine(box.top, height_), fine(box.right, width_), fine(box.bottom, height_)};
}

void Canvas::write(PagePoint at, std::string_view text, const Type& type, Align align) {
  const double width = width_of(text, type);
  const double left = align == Align::left ? at.x : align == Align::centre ? at.x - width / 2 : at.x - width;
  font_of(type).draw(printable(text), type.size * fineness, left * fineness, at.y * fineness,
                     [&](int x, int y, float opacity) { blend(x, y, type.colour, opacity); });
}

void Canvas::write_within(PagePoint at, double width, std::string_view text, const Type& type, Align align) {
  std::string shown = printable(text);
  // Of a very long title only the beginning is measured; measuring all of it would take as long as reading it.
  if (shown.size() > 500) shown.resize(500), shown = printable(shown);
  if (width_of(shown, type) <= width) return write(at, shown, type, align);
  while (!shown.empty() && width_of(shown + "…", type) > width) drop_letter(shown);
  while (!shown.empty() && shown.back() == ' ') shown.pop_back();
  write(at, shown + "…", type, align);
}

double Canvas::width_of(std::string_view text, const Type& type) const {
  return font_of(type).width_of(printable(text), type.size * fineness) / fineness;
}

void Canvas::place(const PageBox& box, std::span<const Colour> pixels) {
  const int left = static_cast<int>(std::lround(box.left * fineness)),
            top = static_cast<int>(std::lround(box.top * fineness));
  const int columns = static_cast<int>(std::lround(box.width() * fineness));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int x = static_cast<int>(i) % columns, y = static_cast<int>(i) / columns;
    blend(left + x, top + y, pixels[i], 1);
  }
}

void Canvas::place_squares(const PageBox& box, std::span<const Colour> squares, int side) {
  const int left = static_cast<int>(std::lround(box.left * fineness)),
            top = static_cast<int>(std::lround(box.top * fineness));
  const int shown = static_cast<int>(std::lround(box.width() * fineness));
  for (int y = 0; y < shown; ++y)
    for (int x = 0; x < shown; ++x) {
      const int row = y * side / shown, column = x * side / shown;
      blend(left + x, top + y, squares[static_cast<std::size_t>(row * side + column)], 1);
    }
}

Drawing Canvas::finish(const ImageLibrary& images) const {
  const int width = width_ / fineness, height = height_ / fineness;
  return {width, height, images.shrunk(pixels_, width_, height_, width, height), static_cast<bool>(sans_)};
}

}  // namespace wale
