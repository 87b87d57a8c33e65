// Masonry, wood, meshes, sand and solids as heights.
#include <algorithm>

#include "tests/standard/standard.hpp"

namespace wale::standard::surfaces_test {
namespace {

TEST(Brickwork, SetsEveryCourseOffByHalfABrick) {
  const Height wall("std.masonry", "brickwork(hand, 24 mm, 9 mm, 2 mm)");
  Chance chance(15);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec2 place = chance.place(0.035);
    EXPECT_NEAR(wall(place), wall(place + glm::dvec2(0.012, 0.009)), 1e-3);
    EXPECT_NEAR(wall(place), wall(place + glm::dvec2(0.024, 0)), 1e-3);
    EXPECT_NEAR(wall(place), wall(place + glm::dvec2(0, 0.018)), 1e-3);
  }
  for (int course = -3; course < 3; ++course) {
    const double middle = 0.009 * (course + 0.5), start = course % 2 == 0 ? 0 : 0.012;
    EXPECT_NEAR(wall({0.005, 0.009 * course}), -0.5, 1e-5);   // the bed joint
    EXPECT_NEAR(wall({start, middle}), -0.5, 1e-5);           // the joint between two bricks
    EXPECT_NEAR(wall({start + 0.0009, middle}), -0.5, 1e-5);  // half of its width to either side
    EXPECT_NEAR(wall({start + 0.012, middle}), 0.5, 1e-5);    // the middle of a face
    EXPECT_NEAR(wall({start + 0.0021, middle}), 0.5, 1e-5);   // behind the bevel
  }
}

TEST(Tiles, StandInRowsAndColumns) {
  const Height floor("std.masonry", "tiles(hand, 10 mm, 1 mm)");
  Chance chance(16);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 place = chance.place(0.03);
    EXPECT_NEAR(floor(place), floor(place + glm::dvec2(0.01, 0)), 1e-3);
    EXPECT_NEAR(floor(place), floor(place + glm::dvec2(0, 0.01)), 1e-3);
    EXPECT_NEAR(floor(place), floor({place.y, place.x}), 1e-3);
  }
}

TEST(Cobbles, AreRoundAndSetOff) {
  const Height road("std.masonry", "cobbles(hand, 14 mm)");
  Chance chance(17);
  double sum = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec2 place = chance.place(0.028);
    sum += road(place) / 20000;
    EXPECT_NEAR(road(place), road(place + glm::dvec2(0.007, 0.014)), 1e-3);
  }
  EXPECT_NEAR(sum, 0, 0.01);
  EXPECT_NEAR(road({0.007, 0.007}), 0.64, 1e-5);
  EXPECT_NEAR(road({0, 0.007}), -0.36, 1e-5);
}

TEST(Wood, RingsAreRoundAndOneYearWide) {
  const Height log("std.wood", "end_grain(hand, vector(15 mm, -10 mm), 4 mm, waver: 0)");
  Chance chance(18);
  const glm::dvec2 pith{0.015, -0.01};
  for (int i = 0; i < 500; ++i) {
    const double radius = chance.between(0.004, 0.04);
    EXPECT_NEAR(log(pith + radius * chance.direction()), log(pith + radius * chance.direction()), 2e-3);
    EXPECT_NEAR(log(pith + radius * glm::dvec2(0.6, 0.8)), log(pith + (radius + 0.004) * glm::dvec2(0.6, 0.8)), 2e-3);
  }
  // The height rises over three quarters of a year's width and falls over the last quarter.
  EXPECT_NEAR(log(pith + glm::dvec2(0.008, 0)), -0.5, 1e-3);
  EXPECT_NEAR(log(pith + glm::dvec2(0.0095, 0)), 0, 1e-3);
  EXPECT_NEAR(log(pith + glm::dvec2(0.011, 0)), 0.5, 1e-3);
  EXPECT_NEAR(log(pith + glm::dvec2(0.0115, 0)), 0, 1e-3);
}

TEST(Wood, GrainRunsAlongTheBoard) {
  const Height board("std.wood", "board_grain(hand, 4 mm)"), straight("std.wood", "board_grain(hand, 4 mm, waver: 0)");
  Chance chance(19);
  double along = 0, across = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec2 place = chance.place(0.06);
    along += std::abs(board(place) - board(place + glm::dvec2(0, 0.0005)));
    across += std::abs(board(place) - board(place + glm::dvec2(0.0005, 0)));
    EXPECT_NEAR(straight(place), straight({place.x + 0.004, -place.y}), 1e-3);
  }
  EXPECT_GT(across, 4 * along);
}

TEST(Wood, PoresAreSparseFurrows) {
  const Height pores("std.wood", "pores(hand, 1.2 mm, 14 mm, few: 0.6)");
  Chance chance(20);
  int open = 0;
  for (int i = 0; i < 10000; ++i) {
    const double height = pores(chance.place(0.06));
    ASSERT_LE(height, 0);
    ASSERT_GE(height, -1);
    open += height < 0;
  }
  EXPECT_GT(open, 500);
  EXPECT_LT(open, 5000);
}

TEST(Mesh, HasWiresBothWaysAndHolesBetween) {
  const Height mesh("std.mesh", "mesh(hand, 5 mm, 1.6 mm)");
  Chance chance(21);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 place = chance.place(0.03);
    EXPECT_NEAR(mesh(place), mesh(place + glm::dvec2(0.005, 0)), 1e-3);
    EXPECT_NEAR(mesh(place), mesh({-place.y, place.x}), 1e-3);
    const auto aside = [](double along) { return std::abs(along - 0.005 * std::round(along / 0.005)); };
    const double nearest = std::min(aside(place.x), aside(place.y));
    const double rise = nearest < 0.0008 ? std::pow(std::cos(pi / 2 * nearest / 0.0008), 2) : 0;
    EXPECT_GE(mesh(place), rise - 0.3 - 1e-3);
    if (nearest > 0.00081) {
      EXPECT_NEAR(mesh(place), -0.3, 1e-5);
    }
  }
  const Height diamonds("std.mesh", "diamond_mesh(hand, 5 mm, 1.6 mm)");
  EXPECT_NEAR(diamonds({0.01, 0.01}), 0.7, 1e-3);
  EXPECT_NEAR(diamonds({0.0025 * std::sqrt(2.0), 0}), -0.3, 1e-4);
}

TEST(Perforated, HasRoundHolesInStaggeredRows) {
  const Height sheet("std.mesh", "perforated(hand, 6 mm, 3 mm)");
  const double row = 0.003 * std::sqrt(3.0);
  Chance chance(22);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 place = chance.place(0.03);
    EXPECT_NEAR(sheet(place), sheet(place + glm::dvec2(0.003, row)), 2e-3);
    const double c = std::cos(pi / 3), s = std::sin(pi / 3);
    EXPECT_NEAR(sheet(place), sheet({c * place.x - s * place.y, s * place.x + c * place.y}), 2e-3);
  }
  EXPECT_NEAR(sheet({0, 0}), -0.7, 1e-5);
  EXPECT_NEAR(sheet({0.0015, 0}), -0.2, 1e-3);  // the edge
  EXPECT_NEAR(sheet({0.003, 0}), 0.3, 1e-5);
}

TEST(Sand, IsLevelOnAverageAndIndependentForEachSeed) {
  const Height beach("std.sand", "sand(hand, 3 mm)"), other("std.sand", "sand(hand, 3 mm, seed: 7)");
  Chance chance(23);
  double sum = 0, squares = 0, product = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec2 place = chance.place(0.07);
    const double height = beach(place);
    ASSERT_LE(std::abs(height), 0.85);
    sum += height / 20000;
    squares += height * height / 20000;
    product += height * other(place) / 20000;
  }
  EXPECT_NEAR(sum, 0, 0.02);
  EXPECT_GT(squares, 0.02);
  EXPECT_NEAR(product, 0, 0.1 * squares);
}

TEST(Ripples, RiseOverTwoThirdsOfTheirSpacing) {
  const Height dunes("std.sand", "ripples(hand, 12 mm, waver: 0)");
  for (int i = -2; i < 2; ++i) {
    EXPECT_NEAR(dunes({0.012 * i, 0.01}), -0.5, 1e-4);
    EXPECT_NEAR(dunes({0.012 * i + 0.004, 0}), 0, 1e-3);
    EXPECT_NEAR(dunes({0.012 * i + 0.008, 0}), 0.5, 1e-4);
    EXPECT_NEAR(dunes({0.012 * i + 0.010, 0}), 0, 1e-3);
  }
}

TEST(Solid, IsContinuousInDepthAndIndependentFarApart) {
  Chance chance(24);
  const Height here("std.solid", "density(hand, 3 mm, 5 mm)"), near("std.solid", "density(hand, 3.001 mm, 5 mm)"),
      far("std.solid", "density(hand, 13 mm, 5 mm)"), detailed("std.solid", "detailed_density(hand, 3 mm)");
  double product = 0, squares = 0;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec2 place = chance.place(0.07);
    for (const Height* each : {&here, &detailed}) {
      EXPECT_GE((*each)(place), 0);
      EXPECT_LE((*each)(place), 1);
    }
    EXPECT_NEAR(here(place), near(place), 1e-3);
    product += (here(place) - 0.5) * (far(place) - 0.5) / 5000;
    squares += (here(place) - 0.5) * (here(place) - 0.5) / 5000;
  }
  EXPECT_GT(squares, 0.01);
  EXPECT_NEAR(product, 0, 0.2 * squares);
}

TEST(Solid, ResistsInProportionToItsDensity) {
  const Height density("std.solid", "density(hand, 4 mm, 6 mm)");
  Chance chance(25);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec2 way = chance.direction(), end = chance.place(0.05);
    Stroke stroke(made("std.solid", "solid_noise", "depth: 4 mm, grain: 6 mm, thin: 0.2 N, dense: 1.8 N"),
                  end - 0.01 * way);
    stroke.line(end, 0.02);
    EXPECT_NEAR(glm::distance(stroke.force(), -(0.2 + 1.6 * density(end)) * way), 0, 0.03);
  }
}

class Heights : public testing::TestWithParam<std::pair<const char*, const char*>> {};

// At a step or crease of a height the force reverses abruptly, and a hand there vibrates.
TEST_P(Heights, HaveNeitherStepsNorCreases) {
  const auto [module, height] = GetParam();
  const Height surface(module, height);  // its features are about 4 mm wide
  constexpr double feature = 4e-3, step = 4e-5;
  Chance chance(26);
  std::vector<glm::vec2> places;
  for (int i = 0; i < 100000; ++i) {
    const glm::dvec2 place = chance.place(0.06), way = chance.direction();
    for (int k : {-1, 0, 1}) places.push_back(place + way * (k * step));
  }
  const std::vector<float> heights = surface(places);
  double steepest = 0, sharpest = 0;
  for (std::size_t i = 0; i < heights.size(); i += 3) {
    const double a = heights[i], b = heights[i + 1], c = heights[i + 2];
    steepest = std::max(steepest, std::abs(c - a) / (2 * step) * feature);
    sharpest = std::max(sharpest, std::abs(a - 2 * b + c) / (step * step) * feature * feature);
  }
  // Relative to the feature's width. A crease between slopes of 5 and -5 would give 10 * 4 mm / 0.04 mm = 1000, and a
  // step more.
  EXPECT_LT(steepest, 25);
  EXPECT_LT(sharpest, 600);
}

INSTANTIATE_TEST_SUITE_P(
    Standard, Heights,
    testing::Values(std::pair{"std.weave", "plain_weave(hand, 4 mm)"}, std::pair{"std.weave", "twill(hand, 4 mm)"},
                    std::pair{"std.weave", "satin(hand, 4 mm)"}, std::pair{"std.knit", "stockinette(hand, 4 mm, 4 mm)"},
                    std::pair{"std.knit", "purl(hand, 4 mm, 4 mm)"},
                    std::pair{"std.knit", "rib_knit(hand, 4 mm, 4 mm)"},
                    std::pair{"std.wood", "board_grain(hand, 4 mm)"}, std::pair{"std.wood", "pores(hand, 4 mm, 14 mm)"},
                    std::pair{"std.masonry", "brickwork(hand, 24 mm, 9 mm, 2 mm)"},
                    std::pair{"std.masonry", "cobbles(hand, 4 mm)"}, std::pair{"std.mesh", "mesh(hand, 6 mm, 3 mm)"},
                    std::pair{"std.mesh", "perforated(hand, 6 mm, 3 mm, bevel: 1 mm)"},
                    std::pair{"std.sand", "sand(hand, 4 mm)"}, std::pair{"std.sand", "ripples(hand, 4 mm)"},
                    std::pair{"std.solid", "detailed_density(hand, 0 mm, 8 mm)"}),
    [](const auto& each) {
      const std::string text = each.param.second;
      return text.substr(0, text.find('('));
    });

}  // namespace
}  // namespace wale::standard::surfaces_test
