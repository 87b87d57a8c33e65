#include "compiler/preview/field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/drawing/style.hpp"

namespace wale {
namespace {

constexpr int arrows = 13;  // a side

std::vector<Force> forces_over(const Bank& bank, const Exhibit& exhibit, bool of_velocity, int count) {
  std::vector<Hand> hands;
  for (int row = 0; row < count; ++row) {
    for (int column = 0; column < count; ++column) {
      const glm::vec2 at = pixel_position(exhibit, column, row, count);
      const auto to_speed = static_cast<float>(2 * exhibit.speed / exhibit.side);
      hands.push_back(of_velocity ? Hand{glm::vec2(exhibit.moving_at), (at - glm::vec2(exhibit.centre)) * to_speed}
                                  : Hand{at, {}});
    }
  }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  return forces;
}

/// The mean force in each arrow's square, of forces in `count` rows and columns. A wave finer than a square has the
/// mean 0, where forces at single places would show a slow one that is not there.
std::vector<glm::dvec2> means_over(const std::vector<Force>& forces, int count) {
  std::vector<glm::dvec2> sums(arrows * arrows, glm::dvec2(0));
  std::vector<int> counts(arrows * arrows);
  for (int row = 0; row < count; ++row)
    for (int column = 0; column < count; ++column) {
      const auto square = static_cast<std::size_t>(row * arrows / count * arrows + column * arrows / count);
      sums[square] += glm::dvec2(forces[static_cast<std::size_t>(row * count + column)]);
      ++counts[square];
    }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(1, counts[i]);
  return sums;
}

void draw_arrow(Canvas& canvas, PagePoint middle, PagePoint reach) {
  const double length = std::hypot(reach.x, reach.y);
  if (length < 3) return canvas.line(middle, middle + PagePoint(0.01, 0), {3, style::force});
  const PagePoint tip = middle + reach / 2.0, tail = middle - reach / 2.0;
  const PagePoint way = reach / length, side(-way.y, way.x);
  const double head = std::min(7.0, length * 0.4);
  const std::array barbs = {tip - way * head + side * head * 0.55, tip, tip - way * head - side * head * 0.55};
  canvas.line(tail, tip, {1.7, style::force});
  canvas.stroke(barbs, {1.7, style::force});
}

}  // namespace

double draw_field(Canvas& canvas, const PageBox& box, const Bank& bank, const Exhibit& exhibit, bool of_velocity,
                  int square) {
  const int shown = static_cast<int>(std::lround(box.width() * Canvas::fineness)) / square;
  const auto size_of = [](Force force) { return std::hypot(double{force.x}, double{force.y}); };

  const auto ground = forces_over(bank, exhibit, of_velocity, shown);
  double strongest = 0;
  for (Force force : ground) strongest = std::max(strongest, size_of(force));
  std::vector<Colour> pixels;
  pixels.reserve(ground.size());
  for (Force force : ground) {
    const double part = strongest > 0 ? size_of(force) / strongest : 0;
    pixels.push_back(mixed(style::field_weak, style::field_strong, static_cast<float>(part)));
  }
  canvas.place_squares(box, pixels, shown);

  const double cell = box.width() / arrows;
  // Where the background is coarser than the arrows, each has a sample of its own.
  const int samples = std::max(shown, arrows);
  const auto means = means_over(samples == shown ? ground : forces_over(bank, exhibit, of_velocity, samples), samples);
  for (int i = 0; i < arrows * arrows && strongest > 0; ++i) {
    const PagePoint middle(box.left + (i % arrows + 0.5) * cell, box.top + (i / arrows + 0.5) * cell);
    const glm::dvec2 force = means[static_cast<std::size_t>(i)];
    draw_arrow(canvas, middle, PagePoint(force.x, -force.y) * (0.92 * cell / strongest));
  }
  return strongest;
}

}  // namespace wale
