#include "runtime/device/pointer/pointer_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <glm/geometric.hpp>
#include <vector>

namespace wale::pointer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int dots_across = 2, dots_down = 4;  // in a cell

/// Dots of Unicode's braille patterns, two by four in each cell.
class Dots {
 public:
  Dots(int columns, int rows)
      : columns_(columns), rows_(rows), cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  void set(glm::dvec2 cells) {
    const auto x = static_cast<long>(std::floor(cells.x * dots_across));
    const auto y = static_cast<long>(std::floor(cells.y * dots_down));
    if (x < 0 || y < 0 || x >= long{columns_} * dots_across || y >= long{rows_} * dots_down) return;
    // Dots 1 2 3 and 4 5 6 from above, then 7 and 8 below them.
    constexpr std::uint8_t bits[dots_down][dots_across] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    cells_[static_cast<std::size_t>(y / dots_down * columns_ + x / dots_across)] |=
        bits[y % dots_down][x % dots_across];
  }

  void line(glm::dvec2 from, glm::dvec2 to) {
    const double steps =
        std::ceil(std::max(std::abs(to.x - from.x) * dots_across, std::abs(to.y - from.y) * dots_down));
    const double most = 4.0 * (columns_ * dots_across + rows_ * dots_down);
    const int count = static_cast<int>(std::clamp(steps, 1.0, most));
    for (int i = 0; i <= count; ++i) set(from + (to - from) * (static_cast<double>(i) / count));
  }

  std::uint8_t at(int column, int row) const { return cells_[static_cast<std::size_t>(row * columns_ + column)]; }

 private:
  int columns_, rows_;
  std::vector<std::uint8_t> cells_;
};

void append_braille(std::string& text, std::uint8_t dots) {  // U+2800 + dots, in UTF-8
  text += '\xe2';
  text += static_cast<char>(0xa0 | dots >> 6);
  text += static_cast<char>(0x80 | (dots & 0x3f));
}

}  // namespace

WorkspaceView::WorkspaceView(double workspace_diameter, int columns, int rows, double cell_height)
    : columns_(std::clamp(columns, 1, 1000)),
      rows_(std::clamp(rows - 1, 1, 1000)),
      cell_height_(cell_height > 0 ? cell_height : 2),
      cells_per_metre_(std::min<double>(columns_, rows_ * cell_height_) / workspace_diameter) {}

glm::dvec2 WorkspaceView::place(glm::dvec2 cells) const {
  return glm::dvec2(cells.x - columns_ / 2.0, (rows_ / 2.0 - cells.y) * cell_height_) / cells_per_metre_;
}

glm::dvec2 WorkspaceView::cells(glm::dvec2 place) const {
  return {columns_ / 2.0 + place.x * cells_per_metre_, rows_ / 2.0 - place.y * cells_per_metre_ / cell_height_};
}

std::string draw(const PointerScene& scene, const WorkspaceView& view) {
  Dots dots(view.columns(), view.rows());
  constexpr int parts = 360;
  for (int i = 0; i < parts; ++i) {
    const double angle = 2 * pi * i / parts;
    dots.set(view.cells(scene.workspace_diameter / 2 * glm::dvec2(std::cos(angle), std::sin(angle))));
  }
  const glm::dvec2 half = scene.patch / 2.0;
  const glm::dvec2 corners[] = {{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}};
  for (int i = 0; i < 4; ++i) dots.line(view.cells(corners[i]), view.cells(corners[(i + 1) % 4]));

  const bool is_number = std::isfinite(scene.force.x) && std::isfinite(scene.force.y);
  const glm::dvec2 force = is_number ? scene.force : glm::dvec2(0);
  const glm::dvec2 arrow = force / scene.full_newton * (scene.workspace_diameter / 3), head = scene.hand + arrow;
  dots.line(view.cells(scene.hand), view.cells(head));
  for (const double side : {-1.0, 1.0}) {
    const double turn = side * 0.85 * pi;
    const glm::dvec2 barb(arrow.x * std::cos(turn) - arrow.y * std::sin(turn),
                          arrow.x * std::sin(turn) + arrow.y * std::cos(turn));
    dots.line(view.cells(head), view.cells(head + barb / 4.0));
  }

  const glm::dvec2 hand = view.cells(scene.hand);
  const int hand_column = static_cast<int>(std::floor(std::clamp(hand.x, -1.0, 2000.0)));
  const int hand_row = static_cast<int>(std::floor(std::clamp(hand.y, -1.0, 2000.0)));
  const auto hundredths = [](double newton) { return std::round(100 * newton) / 100 + 0.0; };  // never -0.00
  char said[80];
  std::snprintf(said, sizeof said, " %.2f N to the right, %.2f N away: drawn, not felt", hundredths(force.x),
                hundredths(force.y));
  const std::string words = std::string(said).substr(0, static_cast<std::size_t>(view.columns()));

  std::string text;
  const auto go_to = [&](int row) { text += "\033[" + std::to_string(row + 1) + ";1H"; };
  for (int row = 0; row < view.rows(); ++row) {
    go_to(row);
    int column = 0;
    if (row == 0) {
      text += words;
      column = static_cast<int>(words.size());
    }
    for (; column < view.columns(); ++column) {
      if (column == hand_column && row == hand_row) {
        text += "\xe2\x97\x8f";  // a filled circle
      } else if (dots.at(column, row) == 0) {
        text += ' ';
      } else {
        append_braille(text, dots.at(column, row));
      }
    }
  }
  go_to(view.rows());
  return text;
}

}  // namespace wale::pointer
