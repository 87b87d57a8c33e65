#include "compiler/drawing/canvas.hpp"

#include <array>
#include <cmath>

#include "compiler/drawing/image_library.hpp"

namespace wale {

Colour mixed(Colour first, Colour second, float part) {
  const auto between = [part](float a, float b) { return a + (b - a) * part; };
  return {between(first.red, second.red), between(first.green, second.green), between(first.blue, second.blue)};
}

void Canvas::outline(const PageBox& box, const Pen& pen) {
  const std::array corners = {PagePoint(box.left, box.top), PagePoint(box.right, box.top),
                              PagePoint(box.right, box.bottom), PagePoint(box.left, box.bottom),
                              PagePoint(box.left, box.top)};
  stroke(corners, pen);
}

void Canvas::line(PagePoint from, PagePoint to, const Pen& pen) {
  const std::array points = {from, to};
  stroke(points, pen);
}

void Canvas::shade(std::span<const PagePoint> points, double base, Colour colour, float opacity) {
  if (points.empty()) return;
  std::vector<PagePoint> corners(points.begin(), points.end());
  corners.emplace_back(points.back().x, base);
  corners.emplace_back(points.front().x, base);
  area(corners, colour, opacity);
}

void Canvas::place(const PageBox& box, std::span<const Colour> pixels) {
  const int columns = static_cast<int>(std::lround(box.width() * fineness));
  place_picture(box, pixels, columns, static_cast<int>(pixels.size()) / columns, false);
}

void Canvas::place_squares(const PageBox& box, std::span<const Colour> squares, int side) {
  place_picture(box, squares, side, side, side < std::lround(box.width()));
}

Result<std::unique_ptr<Canvas>> new_canvas(int width, int height, Colour paper) {
  const auto library = image_library();
  if (!library) return library.error();
  return (*library)->new_canvas(width, height, paper);
}

Result<std::vector<std::byte>> encode_page(const Canvas& page, const std::string& name) {
  if (name.ends_with(".svg") || name.ends_with(".SVG")) return page.svg();
  return encode_drawing(page.pixels(), name);
}

}  // namespace wale
