#include "compiler/preview/relief.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "wale/picture.hpp"

namespace wale {
namespace {

constexpr Colour plaster = {0.865f, 0.820f, 0.745f};
constexpr Colour umbra = {0.225f, 0.190f, 0.180f};
constexpr Colour glint = {1.0f, 0.992f, 0.965f};

/// Rows from the top, with one more pixel on every side than is shown, so that slopes at the edge have both neighbours.
struct Heights {
  int side = 0;
  std::vector<float> values;
  std::vector<Colour> colours;  // for each value; empty if the program has no colours
  std::size_t index(int column, int row) const { return static_cast<std::size_t>(row * side + column); }
  float at(int column, int row) const { return values[index(column, row)]; }
};

Heights heights_of(const Bank& bank, const Memory* memory, const Exhibit& exhibit, int shown) {
  Heights heights{shown + 2, {}, {}};
  std::vector<glm::vec2> positions;
  for (int row = -1; row <= shown; ++row) {
    for (int column = -1; column <= shown; ++column) positions.push_back(pixel_position(exhibit, column, row, shown));
  }
  heights.values.resize(positions.size());
  std::vector<glm::vec3> colours(bank.program().description().picture.colour ? positions.size() : 0);
  surface_all(bank, memory, positions, exhibit.shape, heights.values, colours);
  for (glm::vec3 colour : colours) heights.colours.push_back({colour.r, colour.g, colour.b});
  for (float& value : heights.values) {
    if (!std::isfinite(value)) value = 0;
  }
  const auto [least, most] = std::minmax_element(heights.values.begin(), heights.values.end());
  const float low = *least, range = *most - *least;
  // A flat surface is level ground at height 1.
  for (float& value : heights.values) value = range > 1e-30f ? (value - low) / range : 1.0f;
  return heights;
}

/// A surface of its own colour in the light in which plaster looks like `lamp`.
Colour lit_by(Colour lamp, Colour surface) {
  const auto part = [](float light, float white, float own) { return std::min(own * light / white, 1.0f); };
  return {part(lamp.red, plaster.red, surface.red), part(lamp.green, plaster.green, surface.green),
          part(lamp.blue, plaster.blue, surface.blue)};
}

/// The depth of each point below its surroundings, 0 .. 1, which darkens hollows. `reach` is in pixels.
std::vector<float> hollowness(const Heights& heights, double reach, const ImageLibrary& images) {
  std::vector<float> hollow = images.surroundings(heights.values, heights.side, reach);
  for (std::size_t i = 0; i < hollow.size(); ++i) hollow[i] = std::clamp(hollow[i] - heights.values[i], 0.0f, 1.0f);
  return hollow;
}

}  // namespace

std::vector<Colour> relief_colours(const Bank& bank, const Memory* memory, const Exhibit& exhibit,
                                   const ImageLibrary& images, int shown) {
  const Heights heights = heights_of(bank, memory, exhibit, shown);

  std::vector<float> slopes;
  const auto slope = [&](int column, int row) {  // to the right and upwards, per pixel
    return glm::vec2((heights.at(column + 2, row + 1) - heights.at(column, row + 1)) / 2,
                     (heights.at(column + 1, row) - heights.at(column + 1, row + 2)) / 2);
  };
  for (int row = 0; row < shown; row += 3) {
    for (int column = 0; column < shown; column += 3) {
      const glm::vec2 s = slope(column, row);
      slopes.push_back(std::hypot(s.x, s.y));
    }
  }
  const auto steep = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() * 98 / 100);
  std::nth_element(slopes.begin(), steep, slopes.end());
  // A flank at the 98th percentile of steepness is drawn at 50 degrees if it is felt at level 1, and less steeply the
  // weaker it is felt; a surface without a texture's force is drawn as one of level 1.
  const float strength = static_cast<float>(std::clamp(std::sqrt(exhibit.felt.value_or(1)), 0.15, 1.2));
  const float exaggeration = 1.2f * strength / std::max(*steep, 1e-9f);

  const double texture = exhibit.period.value_or(exhibit.side / 8) / exhibit.side * shown;
  const std::vector<float> hollow = hollowness(heights, texture, images);

  const float light[3] = {-0.52f, 0.52f, 0.68f};
  std::vector<Colour> pixels;
  pixels.reserve(static_cast<std::size_t>(shown) * static_cast<std::size_t>(shown));
  for (int row = 0; row < shown; ++row) {
    for (int column = 0; column < shown; ++column) {
      const glm::vec2 s = slope(column, row) * exaggeration;
      const float normal = 1 / std::sqrt(s.x * s.x + s.y * s.y + 1);
      const float lit = (-s.x * light[0] - s.y * light[1] + light[2]) * normal;
      const float height = heights.at(column + 1, row + 1);
      const float in_hollow = hollow[static_cast<std::size_t>((row + 1) * heights.side + column + 1)];
      // Level ground has the colour of plaster; flanks go towards the glint or the shadow.
      const float tone = lit - light[2];
      const float shade =
          std::clamp(0.42f * in_hollow + 0.10f * (1 - height) + (tone < 0 ? -0.95f * tone : 0.0f), 0.0f, 0.92f);
      const float shine = std::clamp(tone * 2.6f, 0.0f, 0.95f);
      const Colour lamp = mixed(mixed(plaster, glint, shine), umbra, shade);
      pixels.push_back(heights.colours.empty() ? lamp
                                               : lit_by(lamp, heights.colours[heights.index(column + 1, row + 1)]));
    }
  }
  return pixels;
}

void draw_relief(Canvas& canvas, const PageBox& box, const Bank& bank, const Memory* memory, const Exhibit& exhibit,
                 const ImageLibrary& images, int square) {
  const int shown = static_cast<int>(std::lround(box.width() * Canvas::fineness)) / square;
  canvas.place_squares(box, relief_colours(bank, memory, exhibit, images, shown), shown);
}

}  // namespace wale
