// Shapes against slow and obvious references: distances by dense sampling, insides by winding numbers, masks by all
// their cells.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "runtime/stage/front_most.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/runtime/some_shapes.hpp"
#include "wale/shape.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::shape_test {
namespace {

double length(glm::dvec2 way) { return std::hypot(way.x, way.y); }

/// One of each kind, many times.
std::vector<Shape> some_shapes(Places& places, int each) {
  std::vector<Shape> shapes;
  for (int i = 0; i < each; ++i) {
    shapes.push_back(*Shape::ellipse(places.metres(0.001f, 0.05f), places.metres(0.001f, 0.05f)));
    shapes.push_back(*Shape::polygon(star(places, 3 + places.below(30))));
    shapes.push_back(*Shape::mask(random_bits(places, 12 * 9, 2), 12, 9, 0.004f));
  }
  return shapes;
}

/// How far the nearest of many points of a closed curve is.
template <typename Curve>
double sampled_distance(const Curve& curve, glm::dvec2 point, int samples) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < samples; ++i) least = std::min(least, length(curve(i / double(samples)) - point));
  return least;
}

TEST(Shapes, ARectangleHasNoEdgeOfItsOwn) {
  const Shape shape;
  EXPECT_TRUE(shape.is_rectangle());
  EXPECT_TRUE(shape.contains({5, 5}));
  EXPECT_EQ(shape.edge({1, 1}).metres, 0.0f);
  EXPECT_TRUE(shape.stretched({1, 2}).is_rectangle());
}

TEST(Shapes, EllipsesAgreeWithDenseSampling) {
  Places places(1);
  for (int trial = 0; trial < 40; ++trial) {
    const float a = places.metres(0.001f, 0.05f), b = trial % 8 == 0 ? a : places.metres(0.001f, 0.05f);
    const Shape shape = *Shape::ellipse(a, b);
    const auto curve = [&](double turn) {
      return glm::dvec2(a * std::cos(2 * pi * turn), b * std::sin(2 * pi * turn));
    };
    constexpr int samples = 10000;
    const double spacing = 2 * pi * std::max(a, b) / samples;
    for (int i = 0; i < 12; ++i) {
      glm::vec2 point = places.in({3 * a, 3 * b});
      if (i == 0) point = {0, 0};
      if (i == 1) point.x = 0;
      if (i == 2) point.y = 0;
      if (i == 3) point.y = 1e-30f;
      if (i == 4) point = {a, 0};
      const double inside = std::pow(point.x / double(a), 2) + std::pow(point.y / double(b), 2) <= 1 ? 1 : -1;
      const double expected = inside * sampled_distance(curve, glm::dvec2(point), samples);
      EXPECT_NEAR(shape.edge(point).metres, expected, spacing) << a << " " << b << " " << point.x << " " << point.y;
    }
  }
}

/// How often the corners turn around the point.
int winding(const std::vector<glm::vec2>& corners, glm::dvec2 point) {
  double angle = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 from = glm::dvec2(corners[i]) - point, to = glm::dvec2(corners[(i + 1) % corners.size()]) - point;
    angle += std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y);
  }
  return static_cast<int>(std::lround(angle / (2 * pi)));
}

TEST(Shapes, PolygonsAgreeWithDenseSamplingAndWindingNumbers) {
  Places places(2);
  int inside = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const std::vector<glm::vec2> corners = star(places, 3 + places.below(40));
    const Result<Shape> shape = Shape::polygon(corners);
    ASSERT_TRUE(shape) << in_words(shape.error());
    const auto curve = [&](double turn) {
      const double at = turn * static_cast<double>(corners.size());
      const auto i = static_cast<std::size_t>(at);
      const glm::dvec2 from(corners[i]), to(corners[(i + 1) % corners.size()]);
      return from + (at - static_cast<double>(i)) * (to - from);
    };
    const int samples = 2000 * static_cast<int>(corners.size());
    for (int i = 0; i < 10; ++i) {
      const glm::vec2 point = places.in({0.09f, 0.09f});
      const bool within = winding(corners, glm::dvec2(point)) != 0;
      inside += within;
      EXPECT_EQ(shape->contains(point), within);
      EXPECT_NEAR(std::abs(shape->edge(point).metres), sampled_distance(curve, glm::dvec2(point), samples),
                  0.08 / 2000);
    }
  }
  EXPECT_GT(inside, 50);
}

TEST(Shapes, APolygonThatIsARectangleHasItsDistance) {
  const Shape shape =
      *Shape::polygon(std::vector<glm::vec2>{{-0.03f, -0.02f}, {-0.03f, 0.02f}, {0.03f, 0.02f}, {0.03f, -0.02f}});
  EXPECT_EQ(shape.size(), glm::vec2(0.06f, 0.04f));
  Places places(3);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec2 point = places.in({0.06f, 0.04f});
    EXPECT_NEAR(shape.edge(point).metres, std::min(0.03f - std::abs(point.x), 0.02f - std::abs(point.y)), 1e-8f);
  }
  EXPECT_EQ(shape.edge({0.03f, 0.0f}).metres, 0.0f);
  EXPECT_EQ(shape.edge({0.03f, 0.0f}).slope, glm::vec2(-1, 0)) << "towards the inside, on the edge too";
  EXPECT_EQ(shape.edge({0.04f, 0.0f}).slope, glm::vec2(-1, 0));
}

/// The distance to all squares of the other kind.
double distance_in_mask(const std::vector<std::uint8_t>& bits, int columns, int rows, glm::dvec2 cell,
                        glm::dvec2 point) {
  const auto square_at = [&](int column, int row) {
    const glm::dvec2 low((column - columns / 2.0) * cell.x, (rows / 2.0 - row - 1) * cell.y);
    const glm::dvec2 nearest(std::clamp(point.x, low.x, low.x + cell.x), std::clamp(point.y, low.y, low.y + cell.y));
    return length(point - nearest);
  };
  const auto is_set = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < columns && row < rows &&
           bits[static_cast<std::size_t>(row * columns + column)] != 0;
  };
  double to_set = std::numeric_limits<double>::infinity(), to_other = to_set;
  for (int row = -1; row <= rows; ++row)
    for (int column = -1; column <= columns; ++column) {
      double& least = is_set(column, row) ? to_set : to_other;
      least = std::min(least, square_at(column, row));
    }
  return to_set == 0 ? to_other : -to_set;
}

TEST(Shapes, MasksAgreeWithASearchOfAllTheirCells) {
  Places places(4);
  for (int trial = 0; trial < 40; ++trial) {
    const int columns = 1 + static_cast<int>(places.below(20)), rows = 1 + static_cast<int>(places.below(20));
    const std::uint32_t one_in = trial % 3 == 0 ? 1 : trial % 3 == 1 ? 2 : 12;
    const auto bits = random_bits(places, static_cast<std::size_t>(columns * rows), one_in);
    Shape shape = *Shape::mask(bits, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), 0.001f);
    glm::dvec2 cell(0.001f);
    if (trial % 2 == 1) {
      shape = shape.stretched({static_cast<float>(columns) * 0.002f, static_cast<float>(rows) * 0.0007f});
      cell = {0.002f, 0.0007f};
    }
    for (int i = 0; i < 200; ++i) {
      const glm::vec2 point = places.in(1.4f * shape.size() + glm::vec2(0.004f));
      const double expected = distance_in_mask(bits, columns, rows, cell, glm::dvec2(point));
      EXPECT_NEAR(shape.edge(point).metres, expected, 1e-8) << trial << ": " << point.x << " " << point.y;
    }
  }
}

TEST(Shapes, DistancesChangeByNoMoreThanTheWay) {
  Places places(5);
  for (const Shape& shape : some_shapes(places, 12)) {
    for (int i = 0; i < 300; ++i) {
      const glm::vec2 from = places.in(1.5f * shape.size());
      const float reach = std::pow(10.0f, places.metres(-6, -2));
      const glm::vec2 to = from + places.in({reach, reach});
      const double change = std::abs(double(shape.edge(from).metres) - double(shape.edge(to).metres));
      EXPECT_LE(change, length(glm::dvec2(to) - glm::dvec2(from)) + 1e-8);
      const glm::vec2 slope = shape.edge(from).slope;
      EXPECT_LE(std::max(std::abs(slope.x), std::abs(slope.y)), 1.00001f);
    }
  }
}

/// The energy theorem needs no more than this: the slope's integral along any way is the change of the distance.
TEST(Shapes, SlopesIntegrateToDistances) {
  Places places(6);
  for (const Shape& shape : some_shapes(places, 12)) {
    for (int i = 0; i < 8; ++i) {
      const glm::dvec2 from(places.in(shape.size())), to(places.in(shape.size()));
      constexpr int steps = 5000;
      double sum = 0;
      for (int step = 0; step < steps; ++step) {
        const glm::vec2 at(from + (step + 0.5) / steps * (to - from));
        const glm::dvec2 slope(shape.edge(at).slope), way = (to - from) / double(steps);
        sum += slope.x * way.x + slope.y * way.y;
      }
      const double change = double(shape.edge(glm::vec2(to)).metres) - double(shape.edge(glm::vec2(from)).metres);
      EXPECT_NEAR(sum, change, 60 * length(to - from) / steps);  // each kink on the way costs at most two steps
    }
  }
}

TEST(Shapes, CoversOnlyDiscsThatTheyContain) {
  Places places(7);
  int covered = 0;
  for (const Shape& shape : some_shapes(places, 20)) {
    for (int i = 0; i < 60; ++i) {
      const glm::vec2 centre = places.in(shape.size());
      const float radius = places.metres(0, 0.01f);
      if (!shape.covers(centre, radius)) continue;
      ++covered;
      for (int k = 0; k < 40; ++k) {
        const double angle = places.within(0, 2 * pi), away = radius * std::sqrt(places.within(0, 1));
        EXPECT_TRUE(shape.contains(centre + glm::vec2(away * std::cos(angle), away * std::sin(angle))));
      }
    }
  }
  EXPECT_GT(covered, 100);
}

TEST(Shapes, StretchedOnesHaveTheirSizeAndDistances) {
  Places places(8);
  const Shape ellipse = Shape::ellipse(0.02f, 0.01f)->stretched({0.01f, 0.06f}), same = *Shape::ellipse(0.005f, 0.03f);
  const std::vector<glm::vec2> corners = {{-0.02f, -0.01f}, {0.02f, 0}, {-0.02f, 0.01f}, {-0.01f, 0}};
  std::vector<glm::vec2> wider = corners;
  for (glm::vec2& corner : wider) corner.x *= 2;
  const Shape arrow = Shape::polygon(corners)->stretched({0.08f, 0.02f}), wide_arrow = *Shape::polygon(wider);
  EXPECT_EQ(arrow.size(), glm::vec2(0.08f, 0.02f));
  for (int i = 0; i < 500; ++i) {
    const glm::vec2 point = places.in({0.08f, 0.06f});
    EXPECT_NEAR(ellipse.edge(point).metres, same.edge(point).metres, 1e-8f);
    EXPECT_NEAR(arrow.edge(point).metres, wide_arrow.edge(point).metres, 1e-8f);
  }
  EXPECT_EQ(ellipse.stretched({0.01f, 0.06f}), ellipse) << "its own size gives the same value";
  EXPECT_EQ(ellipse.stretched({0, 1}), ellipse);
}

TEST(Shapes, WhatAStretchedOneContainsIsKnownWithoutStretching) {
  Places places(10);
  int inside = 0;
  for (const Shape& shape : some_shapes(places, 5)) {
    const glm::vec2 size(places.metres(0.01f, 0.1f), places.metres(0.01f, 0.1f));
    const Shape stretched = shape.stretched({0.5f, 0.25f}).stretched(size);
    EXPECT_EQ(stretched.unstretched(), shape);
    for (int i = 0; i < 200; ++i) {
      const glm::vec2 point = places.in(size);
      EXPECT_EQ(shape.contains(point, size), stretched.contains(point));
      const float metres = stretched.edge(point).metres;
      if (std::abs(metres) > 1e-9f) {
        EXPECT_EQ(shape.contains(point, size), metres > 0);
      }
      inside += metres > 0;
    }
  }
  EXPECT_GT(inside, 500);
}

TEST(Shapes, WhatIsNoShapeIsRefused) {
  const auto why = [](const Result<Shape>& made) { return made ? "" : made.error().sentence; };
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  for (const auto& [a, b] :
       std::initializer_list<std::pair<float, float>>{{0, 1}, {1, -1}, {nan, 1}, {inf, 1}, {11, 1}})
    EXPECT_NE(why(Shape::ellipse(a, b)), "");
  using Corners = std::vector<glm::vec2>;
  EXPECT_EQ(why(Shape::polygon(Corners{{0, 0}, {1, 1}})), "expected 3 to 256 corners, found 2");
  EXPECT_EQ(why(Shape::polygon(Corners{{0, 0}, {1, 1}, {1, 0}, {0, 1}})),
            "expected edges that meet only at corners, found that those from corners 1 and 3 meet");
  EXPECT_EQ(why(Shape::polygon(Corners{{0, 0}, {0, 0}, {1, 0}})), "expected corners that differ, found corner 1 twice");
  EXPECT_EQ(why(Shape::polygon(Corners{{0, 0}, {1, 0}, {0.5f, 0}})),
            "expected a polygon, found that its edge turns back at corner 2");
  EXPECT_NE(why(Shape::polygon(Corners{{0, 0}, {1, 0}, {1, 1}, {0.5f, 0}})), "") << "a corner on another edge";
  EXPECT_NE(why(Shape::polygon(Corners{{0, 0}, {1, 0}, {nan, 1}})), "");
  EXPECT_NE(why(Shape::polygon(Corners(300, {0, 0}))), "");
  EXPECT_EQ(why(Shape::polygon(Corners{{0, 0}, {0.5f, 0}, {1, 0}, {1, 1}})), "") << "straight on is a corner too";
  const std::vector<std::uint8_t> none(6), one = {0, 0, 0, 1, 0, 0};
  EXPECT_EQ(why(Shape::mask(none, 3, 2, 1)), "expected a mask with a bit that is set, found none");
  EXPECT_EQ(why(Shape::mask(one, 3, 3, 1)), "expected 9 bits of a mask, found 6");
  EXPECT_NE(why(Shape::mask(one, 3, 2, 0)), "");
  EXPECT_NE(why(Shape::mask(one, 3, 2, nan)), "");
  EXPECT_NE(why(Shape::mask(one, 3, 2, 7)), "");
  EXPECT_NE(why(Shape::mask({}, std::size_t{1} << 33, std::size_t{1} << 33, 1e-9f)), "");
  EXPECT_EQ(why(Shape::mask(one, 3, 2, 1)), "");
}

TEST(FrontMostShapes, AgreeWithASearchOfAllPatches) {
  Places places(9);
  const std::vector<Shape> shapes = some_shapes(places, 6);
  for (const std::size_t count : {1, 3, 40, 900}) {
    for (const float largest : {0.01f, 0.2f}) {
      std::vector<PatchOutline> patches(count);
      for (PatchOutline& each : patches) {
        each = {places.in({0.2f, 0.2f}), places.metres(0.001f, largest), places.metres(0.001f, largest)};
        each.layer = static_cast<float>(places.below(5));
        if (places.below(4) != 0)
          each.shape =
              shapes[places.below(static_cast<std::uint32_t>(shapes.size()))].stretched({each.width, each.height});
      }
      for (std::size_t i = 0; i < count / 3; ++i) {  // the same place and size, with another shape
        patches[i] = patches[count - 1 - i];
        patches[i].shape = shapes[i % shapes.size()].stretched({patches[i].width, patches[i].height});
      }
      const FrontMost front_most(patches);
      for (int i = 0; i < 1500; ++i) {
        const glm::dvec2 point(places.in({0.25f, 0.25f}));
        std::uint32_t expected = FrontMost::none;
        for (std::uint32_t k = 0; k < count; ++k) {
          if (!patches[k].contains(glm::vec2(point - glm::dvec2(patches[k].position)))) continue;
          if (expected == FrontMost::none || patches[k].layer >= patches[expected].layer) expected = k;
        }
        ASSERT_EQ(front_most.at(point), expected);
      }
    }
  }
}

TEST(StageShapes, TheFrontMostShapeUnderTheHandIsFelt) {
  const std::vector<std::uint8_t> holed = {1, 1, 1, 1, 0, 1, 1, 1, 1};
  const auto felt = [&](glm::dvec2 hand) {
    Still device(hand);
    Stage stage(device);
    const Patch behind = *stage.add(corduroy(1), {.size = PatchSize{0.2f, 0.2f, 0.001f}});
    const Patch in_front =
        *stage.add(feeling_edge(50), {.at = {0.01f, 0}, .layer = 1, .shape = *Shape::mask(holed, 3, 3, 0.02f)});
    const auto run = stage.run({.seconds = 0.2, .virtual_time = true});
    EXPECT_TRUE(run);
    return std::pair(stage.now().patch == in_front, stage.now());
  };
  EXPECT_FALSE(felt({0.01, 0}).first) << "the hole";
  EXPECT_FALSE(felt({0.05, 0}).first) << "beside it";
  const auto [on, now] = felt({0.03, 0.003});
  EXPECT_TRUE(on);
  EXPECT_NEAR(now.force.x, 50 * 0.01, 0.01) << "the middle of a cell is half a cell from the hole";
  EXPECT_NEAR(now.force.y, 0, 0.2);
}

TEST(StageShapes, ASizeStretchesAndNoSizeIsTheShapesOwn) {
  const auto on = [](glm::dvec2 hand, std::optional<PatchSize> size, std::optional<PatchSize> later) {
    Still device(hand);
    Stage stage(device);
    Patch patch = *stage.add(feeling_edge(1), {.size = size, .shape = *Shape::ellipse(0.02f, 0.01f)});
    if (later) {
      EXPECT_TRUE(patch.resize(*later));
    }
    EXPECT_TRUE(stage.run({.seconds = 0.05, .virtual_time = true}));
    return stage.now().inside;
  };
  EXPECT_TRUE(on({0.019, 0}, {}, {}));
  EXPECT_FALSE(on({0.015, 0.008}, {}, {}));
  EXPECT_FALSE(on({0.021, 0}, {}, {}));
  EXPECT_TRUE(on({0.021, 0}, PatchSize{0.08f, 0.02f, 0.001f}, {}));
  EXPECT_TRUE(on({0, 0.03}, {}, PatchSize{0.02f, 0.08f, 0.001f}));
  EXPECT_FALSE(on({0.019, 0}, {}, PatchSize{0.02f, 0.08f, 0.001f}));
}

}  // namespace
}  // namespace wale::shape_test
