// The areas of a picture by its colours, on drawings whose areas are known: painted with antialiased edges, and
// compressed.
#include "compiler/areas/colour_areas.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <set>

#include "tests/image/encoding.hpp"

namespace wale::colour_areas_test {
namespace {

/// What a drawing shows at a place, in pixels: the number of a colour.
using Scene = std::function<std::size_t(double x, double y)>;

struct Drawing {
  int width = 0, height = 0;
  std::vector<std::uint32_t> colours;
  Scene scene;

  /// The numbers within so many pixels, in a square.
  std::set<std::size_t> around(int x, int y, int reach) const {
    std::set<std::size_t> found;
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j) found.insert(scene(x + 0.5 + i, y + 0.5 + j));
    for (const double i : {0.05, 0.95})
      for (const double j : {0.05, 0.95}) found.insert(scene(x + i, y + j));
    return found;
  }
  /// Painted with each pixel the mean of what is in it.
  std::vector<std::uint8_t> painted() const {
    std::vector<std::uint8_t> bytes;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double sum[3] = {};
        for (int i = 0; i < 8; ++i)
          for (int j = 0; j < 8; ++j) {
            const std::uint32_t colour = colours[scene(x + (i + 0.5) / 8, y + (j + 0.5) / 8)];
            for (int part = 0; part < 3; ++part) sum[part] += colour >> (16 - 8 * part) & 255;
          }
        for (const double each : sum) bytes.push_back(static_cast<std::uint8_t>(std::lround(each / 64)));
      }
    return bytes;
  }
  Bytes file(const std::string& extension, int quality) const {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeUInt8);
    spec.attribute("Compression", "jpeg:" + std::to_string(quality));
    return encode(extension, spec, painted());
  }
};

std::vector<std::uint32_t> some_colours(std::mt19937& random, std::size_t count) {
  std::vector<std::uint32_t> colours;
  while (colours.size() < count) {
    const std::uint32_t colour = random() & 0xffffff;
    bool apart = true;
    for (const std::uint32_t each : colours) apart = apart && colour_distance(colour, each) > 0.35;
    if (apart) colours.push_back(colour);
  }
  return colours;
}

/// A ground with discs and bands, each wider than 20 pixels.
Drawing some_drawing(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto from = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Drawing drawing{120, 90, some_colours(random, 4), {}};
  struct Disc {
    double x, y, radius;
  };
  const Disc discs[] = {{from(20, 45), from(20, 70), from(12, 22)}, {from(65, 100), from(20, 70), from(12, 22)}};
  const double angle = from(0, 3.14), middle = from(-15, 15), half = from(11, 16);
  drawing.scene = [=](double x, double y) -> std::size_t {
    for (std::size_t i = 0; i < 2; ++i)
      if (std::hypot(x - discs[i].x, y - discs[i].y) < discs[i].radius) return i + 1;
    const double across = (x - 60) * std::cos(angle) + (y - 45) * std::sin(angle);
    return std::abs(across - middle) < half ? 3 : 0;
  };
  return drawing;
}

/// How many pixels away from an edge are wrong, and how many on one belong to neither side.
void expect_right(const Drawing& drawing, const ColourAreas& found, int away, const std::string& what) {
  std::size_t wrong = 0, foreign = 0;
  for (int y = 0; y < drawing.height; ++y)
    for (int x = 0; x < drawing.width; ++x) {
      const AreaId area = found.areas[static_cast<std::size_t>(y * drawing.width + x)];
      const auto near = drawing.around(x, y, away);
      if (near.size() == 1 && area != *near.begin()) ++wrong;
      // Where three meet, or two have a third behind them that is narrower than an edge, a pixel may be of any.
      const bool is_plain = near.size() == 2 && drawing.around(x, y, away + 5).size() == 2;
      if (is_plain && (area == nobody || !near.contains(area))) ++foreign;
    }
  EXPECT_EQ(wrong, 0u) << what;
  EXPECT_EQ(foreign, 0u) << what;
  EXPECT_EQ(found.unmatched.pixels, 0u) << what;
}

TEST(ColourAreas, APaintedDrawingIsFoundAgainToThePixel) {
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const Drawing drawing = some_drawing(seed);
    const auto image = read_colour_image(drawing.file("png", 0), "a.png");
    ASSERT_TRUE(image);
    expect_right(drawing, colour_areas(*image, drawing.colours, 0.15), 1, "seed " + std::to_string(seed));
  }
}

TEST(ColourAreas, ACompressedDrawingIsFoundAgainToThreePixels) {
  for (std::uint32_t seed = 1; seed <= 15; ++seed)
    for (const int quality : {90, 70}) {
      const Drawing drawing = some_drawing(seed);
      const auto image = read_colour_image(drawing.file("jpg", quality), "a.jpg");
      ASSERT_TRUE(image);
      const ColourAreas found = colour_areas(*image, drawing.colours, 0.15);
      const std::string what = "seed " + std::to_string(seed) + ", quality " + std::to_string(quality);
      expect_right(drawing, found, 3, what);
      ColourAreas right{found.width, found.height, {}, {}, {}};
      for (int y = 0; y < drawing.height; ++y)
        for (int x = 0; x < drawing.width; ++x)
          right.areas.push_back(static_cast<AreaId>(drawing.scene(x + 0.5, y + 0.5)));
      if (!find_sliver(right, drawing.colours.size(), 8)) {
        const auto sliver = find_sliver(found, drawing.colours.size(), 4);
        EXPECT_FALSE(sliver) << what << ": " << int{sliver->area} << " at " << sliver->place.x << ", "
                             << sliver->place.y << ", " << sliver->width_pixels;
      }
    }
}

TEST(ColourAreas, AMixtureThatLooksLikeAThirdColourIsOfTheSides) {
  // Halfway between black and white is the grey that stands on the left.
  const Drawing drawing{90, 30, {0x000000, 0xffffff, 0x808080}, [](double x, double y) -> std::size_t {
                          return x < 30 ? 2 : x + 0.3 * y < 70 ? 0 : 1;
                        }};
  const auto image = read_colour_image(drawing.file("png", 0), "a.png");
  ASSERT_TRUE(image);
  const ColourAreas found = colour_areas(*image, drawing.colours, 0.15);
  for (int y = 0; y < 30; ++y)
    for (int x = 34; x < 90; ++x) EXPECT_NE(found.areas[static_cast<std::size_t>(y * 90 + x)], 2) << x << ", " << y;
}

TEST(ColourAreas, WhatHasNoneOfTheColoursIsCounted) {
  // A third is red, a third green, and of the last one a half each blue and yellow.
  const Drawing drawing{90, 40, {0xc02020, 0x20c020, 0x2020c0, 0xe0e020}, [](double x, double y) -> std::size_t {
                          return x < 30 ? 0 : x < 60 ? 1 : y < 16 ? 2 : 3;
                        }};
  const auto image = read_colour_image(drawing.file("png", 0), "a.png");
  ASSERT_TRUE(image);
  const ColourAreas found = colour_areas(*image, {0xc02020, 0x20c020}, 0.15);
  EXPECT_EQ(found.pixels[0], 30u * 40);
  EXPECT_EQ(found.pixels[1], 30u * 40);
  EXPECT_EQ(found.unmatched.pixels, 30u * 40);
  EXPECT_EQ(found.unmatched.mostly, 0xe0e020u);
  EXPECT_EQ(found.unmatched.place.x, 60u);
  EXPECT_EQ(found.unmatched.place.y, 16u);
}

TEST(ColourAreas, AnOutlineOfItsOwnColourIsNoEdge) {
  const Drawing drawing{90, 40, {0xc02020, 0x20c020, 0x000000}, [](double x, double) -> std::size_t {
                          return x < 40 ? 0 : x < 43 ? 2 : 1;
                        }};
  const auto image = read_colour_image(drawing.file("png", 0), "a.png");
  ASSERT_TRUE(image);
  EXPECT_EQ(colour_areas(*image, {0xc02020, 0x20c020}, 0.15).unmatched.pixels, 3u * 40);
}

/// A picture of one colour with a shape of the other, drawn pixel by pixel.
ColourAreas two_areas(int width, int height, const std::function<bool(int, int)>& inside) {
  ColourAreas areas{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}, {0, 0}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) areas.areas.push_back(inside(x, y) ? 0 : 1);
  return areas;
}

TEST(Slivers, AreIslandsAndTonguesThatAreTooNarrow) {
  for (int width = 1; width <= 12; ++width)
    for (int narrowest = 2; narrowest <= 10; ++narrowest) {
      const bool is_narrow = width < narrowest;
      // A bar across the picture, upright, lying and as an island; a bar on a large area.
      const auto in = [&](int at) { return at >= 30 && at < 30 + width; };
      const auto said = std::to_string(width) + " of " + std::to_string(narrowest);
      EXPECT_EQ(find_sliver(two_areas(90, 80, [&](int x, int) { return in(x); }), 1, narrowest).has_value(), is_narrow)
          << said;
      EXPECT_EQ(find_sliver(two_areas(90, 80, [&](int, int y) { return in(y); }), 1, narrowest).has_value(), is_narrow)
          << said;
      const auto tongue =
          find_sliver(two_areas(90, 80, [&](int x, int y) { return x < 20 || (in(y) && x < 80); }), 1, narrowest);
      EXPECT_EQ(tongue.has_value(), is_narrow) << said;
      if (tongue) {
        EXPECT_NEAR(tongue->width_pixels, width, 0.5) << said;
      }
      const auto island = find_sliver(two_areas(90, 80, [&](int x, int y) { return in(x) && in(y); }), 1, narrowest);
      EXPECT_EQ(island.has_value(), is_narrow) << said;
      if (island) {
        EXPECT_NEAR(island->width_pixels, width, 0.5) << said;
      }
    }
}

TEST(Slivers, LieAslantToo) {
  for (const double angle : {0.2, 0.6, 0.785, 1.2, 2.0, 2.7})
    for (const double width : {3.0, 5.0, 8.0, 13.0}) {
      const auto strip = two_areas(120, 120, [&](int x, int y) {
        return std::abs((x - 60) * std::cos(angle) + (y - 60) * std::sin(angle)) < 0.5 * width;
      });
      // Within the staircase of the pixels.
      EXPECT_TRUE(find_sliver(strip, 1, width + 2)) << angle << ", " << width;
      EXPECT_FALSE(find_sliver(strip, 1, width - 2)) << angle << ", " << width;
    }
}

TEST(Slivers, CornersAndDiscsAreNone) {
  EXPECT_FALSE(find_sliver(two_areas(120, 120, [](int x, int y) { return std::hypot(x - 60, y - 60) < 20; }), 1, 20));
  for (const double half : {0.25, 0.5, 0.8}) {  // rad, of a corner's angle
    const auto corner = two_areas(
        160, 120, [&](int x, int y) { return x < 140 && std::abs(std::atan2(y - 60, x - 10)) < half && x > 10; });
    EXPECT_FALSE(find_sliver(corner, 1, 6)) << half;
  }
}

}  // namespace
}  // namespace wale::colour_areas_test
