// Napped cloth, crushable paper and sand: surfaces whose force depends on the direction of the stroke and on earlier
// strokes.
#include "tests/standard/standard.hpp"

namespace wale::standard::surfaces_that_remember_test {
namespace {

TEST(NapFromVelocity, HasTwoCoefficientsAndTheirMeanAcross) {
  Field field(pushing("std.nap", "nap(0.3 N, 1.2 N, lay: 60 deg, rise: 5 N s/m)"));
  Chance chance(7);
  for (int i = 0; i < 300; ++i) {
    const double angle = chance.between(-pi, pi), speed = 0.5;
    const glm::dvec2 way{std::cos(angle), std::sin(angle)};
    const double expected = (0.3 + 1.2) / 2 - (1.2 - 0.3) / 2 * std::cos(angle - pi / 3);
    EXPECT_NEAR(glm::distance(field({0, 0}, speed * way), -expected * way), 0, 1e-4) << angle;
  }
}

TEST(NappedCloth, ResistsAStrokeAgainstItFourTimesAsMuch) {
  for (double degrees : {90.0, 0.0, -135.0}) {
    const double angle = degrees * pi / 180;
    const glm::dvec2 lay{std::cos(angle), std::sin(angle)}, across{-lay.y, lay.x};
    Stroke stroke(
        made("std.nap", "napped_cloth", "with: 0.3 N, against: 1.2 N, lay: " + std::to_string(degrees) + " deg"));
    stroke.line(0.02 * lay, 0.1);
    EXPECT_NEAR(glm::distance(stroke.force(), -0.3 * lay), 0, 1e-3);
    stroke.line(-0.01 * lay, 0.1);
    EXPECT_NEAR(glm::distance(stroke.force(), 1.2 * lay), 0, 1e-3);
    stroke.line(-0.01 * lay + 0.06 * across, 0.1);
    EXPECT_NEAR(glm::length(stroke.force()), 0.75, 0.03);
  }
}

TEST(BrushedPile, LiesInTheDirectionOfTheLastStroke) {
  // Strokes go down, against the pile, along one column of cells.
  Stroke stroke(made("std.nap", "brushed_pile", "with: 0.3 N, against: 1.3 N, way: 2 mm"), {0.001, 0.03});
  const auto stroked_down = [&] {
    double total = 0;
    int count = 0;
    for (double y = 0.03; y > -0.03; y -= 0.0001) {
      const double force = stroke.move({0.001, y}).y;
      if (y < 0.02) total += force, ++count;
    }
    return total / count;
  };
  const double first = stroked_down();
  stroke.line({0.021, -0.03}, 0.1);  // back up beside the lane
  stroke.line({0.021, 0.03}, 0.1);
  stroke.line({0.001, 0.03}, 0.1);
  const double second = stroked_down();
  EXPECT_GT(first, 0.55);
  EXPECT_LT(second, 0.6 * first);
  EXPECT_GT(second, 0.29);
}

/// The value of grid 0's cell under `place` (m). Cells cover the patch from its lower left corner.
double cell_under(const Program& program, const Memory& memory, glm::dvec2 place) {
  const auto& grid = program.description().grids.at(0);
  const auto size = program.default_size();
  const int column = static_cast<int>(std::floor((place.x / size.width + 0.5) * grid.columns));
  const int row = static_cast<int>(std::floor((place.y / size.height + 0.5) * grid.rows));
  return memory.grid(0)[static_cast<std::size_t>(row * grid.columns + column)];
}

TEST(CrushablePaper, StaysCrushedOnlyWhereItWasTouched) {
  const Program program = made("std.paper", "crushable_paper", "press: 1, wear: 6 mm");
  Stroke stroke(program, {-0.03, 0.0107});
  for (float each : stroke.memory().grid(0)) ASSERT_EQ(each, 0);
  stroke.line({0.03, 0.0107}, 0.05);
  int crushed = 0;
  for (float each : stroke.memory().grid(0)) crushed += each > 0;
  EXPECT_NEAR(crushed, 60 / 1.5, 3);
  for (double x = -0.025; x < 0.025; x += 0.0015) {
    // The path through one cell is its width.
    EXPECT_NEAR(cell_under(program, stroke.memory(), {x, 0.0107}), 1 - std::exp(-1.5 / 6), 0.02) << x;
    EXPECT_EQ(cell_under(program, stroke.memory(), {x, 0.0107 + 0.0016}), 0);
    EXPECT_EQ(cell_under(program, stroke.memory(), {x, 0.0107 - 0.0016}), 0);
  }
  for (int again = 2; again <= 4; ++again) {
    stroke.line({again % 2 == 0 ? -0.03 : 0.03, 0.0107}, 0.05);
    EXPECT_NEAR(cell_under(program, stroke.memory(), {0.0004, 0.0107}), 1 - std::exp(-again * 1.5 / 6), 0.03);
  }
}

TEST(CrushablePaper, IsSmootherRubbedTwiceAndPressedLightlyCrushesLess) {
  const auto rubbed = [](const std::string& parameters, int times) {
    Stroke stroke(made("std.paper", "crushable_paper", parameters), {-0.03, 0});
    double drag = 0, ripple = 0;
    for (int i = 0; i < times; ++i) {
      stroke.line({-0.03, 0}, 0.05);
      drag = ripple = 0;
      int count = 0;
      for (double x = -0.03; x < 0.03; x += 5e-5, ++count) {
        const glm::dvec2 force = stroke.move({x, 0});
        if (x < -0.02) continue;
        drag += -force.x;
        ripple += force.y * force.y;  // across the path there is only the texture
      }
    }
    return std::pair(drag, std::sqrt(ripple));
  };
  const auto fresh = rubbed("press: 1", 1), twice = rubbed("press: 1", 2), often = rubbed("press: 1", 30);
  EXPECT_LT(twice.first, 0.85 * fresh.first);
  EXPECT_LT(twice.second, 0.85 * fresh.second);
  EXPECT_NEAR(often.second / fresh.second, 0.2,
              0.07);  // the parameter `left`; the first stroke crushes a little already
  const auto lightly = rubbed("press: 0.1", 2);
  EXPECT_GT(lightly.first, twice.first);
  EXPECT_GT(lightly.second, twice.second);
}

TEST(Sandpit, IsPloughedOnce) {
  Stroke stroke(made("earth.sand", "sandpit"), {-0.03, 0.001});
  stroke.line({0.03, 0.001}, 0.05);
  const double once = stroke.work();
  stroke.line({-0.03, 0.001}, 0.05);
  const double back = stroke.work() - once;
  EXPECT_LT(back, 0.8 * once);
  stroke.line({-0.03, 0.021}, 0.05);
  const double before = stroke.work();
  stroke.line({0.03, 0.021}, 0.05);  // untouched sand beside it
  EXPECT_NEAR(stroke.work() - before, once, 0.15 * once);
}

}  // namespace
}  // namespace wale::standard::surfaces_that_remember_test
