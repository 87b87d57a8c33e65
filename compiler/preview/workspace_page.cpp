#include "compiler/preview/workspace_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "compiler/drawing/axis.hpp"
#include "compiler/drawing/image_library.hpp"
#include "compiler/drawing/style.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/preview/exhibit.hpp"
#include "compiler/preview/relief.hpp"

namespace wale {
namespace {

constexpr int sheet_width = 1600, sheet_height = 1240;
constexpr double sheet_margin = 64;
constexpr PageBox plane = {sheet_margin, 170, sheet_margin + 1000, 1170};
constexpr double list_left = 1112, entry_height = 62;
constexpr int most_listed = 15;

/// The pixels of the plane, two by two of a placed picture's, with the scale.
class Plane {
 public:
  /// `across` is the side of the square that is shown, m, around the workspace's centre.
  explicit Plane(double across) : pixel_(across / side), pixels_(static_cast<std::size_t>(side) * side, style::paper) {}

  /// Lays a patch over what is there. `radius`: how far the device reaches, m.
  void lay(const WorkspacePatch& patch, std::optional<double> felt, double radius, const ImageLibrary& images) {
    const Bank bank(patch.program, patch.program.default_parameters(), *patch.options.size);
    const double width = bank.size().width, height = bank.size().height;
    const int first_column = column_of(patch.options.at.x - 0.5 * width);
    const int first_row = row_of(patch.options.at.y + 0.5 * height);
    const int longer = static_cast<int>(std::ceil(std::max(width, height) / pixel_)) + 2;
    const auto cost = static_cast<double>(cost_of(patch.program.description().picture.code));
    const int square = pixels_of_a_sample(cost, longer), shown = (longer + square - 1) / square;
    const glm::dvec2 middle(x_of(first_column) + 0.5 * (square * shown - 1) * pixel_,
                            y_of(first_row) - 0.5 * (square * shown - 1) * pixel_);
    Exhibit exhibit = exhibit_of(bank);
    exhibit.side = pixel_ * square * shown;
    exhibit.centre = middle - glm::dvec2(patch.options.at);
    exhibit.felt = felt;
    const Shape shape = patch.options.shape.stretched({bank.size().width, bank.size().height});
    exhibit.shape = shape;
    const std::vector<Colour> relief = relief_colours(bank, nullptr, exhibit, images, shown);
    const auto covers = [&](int column, int row) {
      const glm::dvec2 at(x_of(column) - patch.options.at.x, y_of(row) - patch.options.at.y);
      return std::abs(at.x) <= 0.5 * width && std::abs(at.y) <= 0.5 * height && shape.contains(glm::vec2(at));
    };
    for (int row = std::max(first_row, 0); row < std::min(first_row + square * shown, side); ++row) {
      for (int column = std::max(first_column, 0); column < std::min(first_column + square * shown, side); ++column) {
        if (!covers(column, row)) continue;
        const int of_relief = (row - first_row) / square * shown + (column - first_column) / square;
        Colour colour = relief[static_cast<std::size_t>(of_relief)];
        const bool at_edge = !covers(column - 1, row) || !covers(column + 1, row) || !covers(column, row - 1) ||
                             !covers(column, row + 1);
        if (at_edge) colour = mixed(colour, style::ink, 0.6f);
        if (std::hypot(x_of(column), y_of(row)) > radius) colour = mixed(colour, style::paper, 0.65f);
        pixels_[static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column)] = colour;
      }
    }
  }

  void draw(Canvas& canvas) const { canvas.place_squares(plane, pixels_, side); }
  /// A place of the workspace on the page.
  PagePoint on_page(glm::dvec2 at) const {
    const double per_metre = plane.width() / (pixel_ * side);
    return {plane.left + plane.width() / 2 + at.x * per_metre, plane.top + plane.height() / 2 - at.y * per_metre};
  }

 private:
  static constexpr int side = 1000;

  double x_of(int column) const { return (column + 0.5 - 0.5 * side) * pixel_; }
  double y_of(int row) const { return (0.5 * side - row - 0.5) * pixel_; }
  int column_of(double x) const { return static_cast<int>(std::floor(x / pixel_ + 0.5 * side)) - 1; }
  int row_of(double y) const { return static_cast<int>(std::floor(0.5 * side - y / pixel_)) - 1; }

  double pixel_;  // m
  std::vector<Colour> pixels_;
};

void draw_disc(Canvas& canvas, const Plane& on, double radius) {
  constexpr int corners = 360;
  std::vector<PagePoint> circle;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    circle.push_back(on.on_page(radius * glm::dvec2(std::cos(angle), std::sin(angle))));
  }
  canvas.stroke(circle, {1.5, style::quiet, 1, 6});
}

/// A bar of a round length at the lower left of the plane.
void draw_scale(Canvas& canvas, double across) {
  const Notation notation = length_notation(across);
  const double shown = across * notation.per_si, length = round_number(shown / 5);
  const double left = plane.left, right = left + length / shown * plane.width(), at = plane.bottom + 22;
  canvas.line({left + 1, at}, {right - 1, at}, {3, style::ink});
  for (const double end : {left + 1, right - 1}) canvas.line({end, at - 6}, {end, at + 6}, {2, style::ink});
  canvas.write({right + 13, at + 5.5}, fmt::format("{} {}", shown_number(length), notation.unit), style::heading);
}

/// The number of a patch on a small label.
void draw_number(Canvas& canvas, PagePoint at, std::size_t number) {
  const std::string text = std::to_string(number);
  const double half = 0.5 * canvas.width_of(text, style::heading) + 7;
  const PageBox label = {at.x - half, at.y - 13, at.x + half, at.y + 13};
  canvas.fill(label, style::paper);
  canvas.outline(label, {1, style::ink});
  canvas.write({at.x, at.y + 6.5}, text, style::heading, Align::centre);
}

void write_list(Canvas& canvas, const Workspace& workspace, std::span<const PatchWords> words) {
  const double width = sheet_width - sheet_margin - list_left;
  const std::size_t all = workspace.patches.size();
  const std::size_t listed = all <= most_listed + 1 ? all : most_listed;
  double top = plane.top + 14;
  for (std::size_t i = 0; i < listed; ++i, top += entry_height) {
    const WorkspacePatch& patch = workspace.patches[i];
    const std::string name = patch.name == patch.made_of ? patch.name : patch.name + ": " + patch.made_of;
    draw_number(canvas, {list_left + 14, top}, i + 1);
    canvas.write_within({list_left + 44, top + 6}, width - 44, name, style::heading);
    canvas.write_within({list_left + 44, top + 29}, width - 44, words[i].feels, style::label);
  }
  if (listed < all)
    canvas.write_within({list_left + 44, top + 6}, width - 44, fmt::format("and {} more", all - listed), style::label);
}

}  // namespace

Result<std::unique_ptr<Canvas>> draw_workspace(const Workspace& workspace, const DeviceProfile& device,
                                               std::span<const PatchWords> words) {
  const auto images = image_library();
  if (!images) return images.error();
  auto page = new_canvas(sheet_width, sheet_height, style::paper);
  if (!page) return page;
  Canvas& canvas = **page;
  constexpr double around = 1.04;  // a little more than the device reaches
  const double radius = 0.5 * device.widest_patch(), across = 2 * around * radius;
  Plane shown(across);
  for (std::size_t i = 0; i < workspace.patches.size(); ++i)
    shown.lay(workspace.patches[i], words[i].felt, radius, **images);
  shown.draw(canvas);
  draw_disc(canvas, shown, radius);
  canvas.outline(plane, {1, style::rule});
  for (std::size_t i = 0; i < workspace.patches.size(); ++i) {
    const glm::dvec2 half(0.5 * across);
    const glm::dvec2 at = glm::clamp(glm::dvec2(workspace.patches[i].options.at), -half, half);
    draw_number(canvas, shown.on_page(at), i + 1);
  }
  draw_scale(canvas, across);
  const double width = sheet_width - 2 * sheet_margin;
  canvas.write_within({sheet_margin, 92}, width, workspace.name, style::title);
  canvas.write_within({sheet_margin, 134}, width - 420, workspace.documentation, style::names);
  canvas.write_within({sheet_width - sheet_margin, 134}, 400, "on " + device.name, style::label, Align::right);
  write_list(canvas, workspace, words);
  return page;
}

}  // namespace wale
