// Two gratings side by side: a hand that crosses their border feels each as itself up to 2 mm from it, and the step.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "compiler/modules/load_modules.hpp"
#include "tests/promises/running.hpp"
#include "wale/loop.hpp"

namespace wale::promises {
namespace {

constexpr double to_border = 2e-3;  // m

/// A grating of ridges across x, of a roughness, whose phase does not depend on the size of its patch.
std::string material(const char* name, double roughness, double millimetres) {
  return "material " + std::string(name) + " {\n  perceptual { roughness " + std::to_string(roughness) +
         " }\n  physical {\n    height ribs = grating(x, period: " + std::to_string(millimetres) +
         " mm)\n    force = lateral(ribs)\n  }\n}\n";
}

std::string text_of(const std::string& patches) {
  return "wale 1\n" + material("rough", 0.7, 2.5) + material("smooth", 0.3, 1.6) + "workspace desk {\n" + patches +
         "}\n";
}

/// The forces along x of one who goes from `from` to `to`, m, at a speed, m/s: place and force at each tick.
std::vector<glm::dvec2> crossed(const std::string& patches, double from, double to, double speed) {
  const Library library;
  const auto compiled = library.workspace(text_of(patches));
  if (!compiled) throw std::runtime_error(explained(compiled.error()));
  const DeviceProfile profile = joystick()->profile();
  Stage stage(profile);
  const auto put = put_on(stage, compiled->workspace);
  if (!put) throw std::runtime_error(explained(put.error()));
  auto loop = Loop::begin(stage);
  if (!loop) throw std::runtime_error(explained(loop.error()));
  std::vector<glm::dvec2> forces;
  const double step = (to > from ? 1 : -1) * speed / profile.rate;
  const auto counts = [&](double x) {
    return glm::ivec2(static_cast<int>(std::lround(x / profile.position_step())), 0);
  };
  // The hand rests at its first place until its banks are there and the force has come.
  for (int i = 0; i < 4000; ++i) loop->step({.counts = counts(from)});
  for (double x = from; (to - x) * step > 0; x += step) forces.emplace_back(x, loop->step({.counts = counts(x)}).x);
  return forces;
}

/// The largest force among places between two, m.
double largest(const std::vector<glm::dvec2>& forces, double from, double to) {
  double most = 0;
  for (const glm::dvec2& each : forces)
    if (each.x >= from && each.x <= to) most = std::max(most, std::abs(each.y));
  return most;
}

/// The smallest force that people notice, N.
double least_noticed() {
  double least = 0;
  for (const Threshold* each : common_modules()->declarations.thresholds())
    if (each->cue == "amplitude") least = std::max(least, each->floor);
  return least;
}

const char* const both =
    "  patch left = rough { at -30 mm, 0 mm; size 60 mm, 40 mm }\n"
    "  patch right = smooth { at 30 mm, 0 mm; size 60 mm, 40 mm }\n";
/// The same materials without a border there: their patches have the same middle.
const char* const left_alone = "  patch left = rough { at -30 mm, 0 mm; size 120 mm, 40 mm }\n";
const char* const right_alone = "  patch right = smooth { at 30 mm, 0 mm; size 120 mm, 40 mm }\n";

TEST(Crossing, EachOfTwoGratingsReadsAsItselfToTwoMillimetresFromTheBorder) {
  double least_step = HUGE_VAL;
  for (const double speed : {0.05, 0.1, 0.15, 0.2})
    for (const double way : {1.0, -1.0})
      for (const double begin : {0.025, 0.02507, 0.02513}) {  // ticks fall on other places of the textures
        const auto together = crossed(both, -begin * way, begin * way, speed);
        const auto left = crossed(left_alone, -begin * way, begin * way, speed);
        const auto right = crossed(right_alone, -begin * way, begin * way, speed);
        ASSERT_EQ(together.size(), left.size());
        const double of_left = largest(left, -0.02, 0.02), of_right = largest(right, -0.02, 0.02);
        double off = 0;
        for (std::size_t i = 0; i < together.size(); ++i) {
          const double x = together[i].x;
          if (x < -to_border) off = std::max(off, std::abs(together[i].y - left[i].y) / of_left);
          if (x > to_border) off = std::max(off, std::abs(together[i].y - right[i].y) / of_right);
        }
        EXPECT_LT(off, 0.03) << 1e3 * speed << " mm/s, way " << way << ", from " << begin;
        least_step =
            std::min(least_step, std::abs(largest(together, -0.012, -to_border) - largest(together, to_border, 0.012)));
      }
  EXPECT_GT(least_noticed(), 0);
  EXPECT_GT(least_step, 2 * least_noticed());
}

/// The force that a level of roughness stands for, N, by the fit to table 6: the 194 program units of level 1 with the
/// exponent 0.7596 (Minsky 1995, section 5.3.1, figure 19).
double force_of(double roughness) { return 194 * 10.0 / 512 * std::pow(roughness, 1 / 0.7596); }

/// The 99th percentile of the forces between two places.
double percentile(const std::vector<glm::dvec2>& forces, double from, double to) {
  std::vector<double> all;
  for (const glm::dvec2& each : forces)
    if (each.x >= from && each.x <= to) all.push_back(std::abs(each.y));
  std::ranges::sort(all);
  return all.at(static_cast<std::size_t>(0.99 * static_cast<double>(all.size() - 1)));
}

TEST(Crossing, EachSideHasTheForceOfItsLevelAndTheStepIsTheirDifference) {
  for (const double speed : {0.05, 0.1, 0.2})
    for (const double way : {1.0, -1.0}) {
      const auto forces = crossed(both, -0.028 * way, 0.028 * way, speed);
      const double left = percentile(forces, -0.026, -to_border), right = percentile(forces, to_border, 0.026);
      EXPECT_NEAR(left / force_of(0.7), 1, 0.03) << speed << " " << way;
      EXPECT_NEAR(right / force_of(0.3), 1, 0.03) << speed << " " << way;
      EXPECT_GT(left - right, 2 * least_noticed());
    }
}

/// A height of 1 mm that falls to 0 over the rim alone, at 2 N. To go in takes 2 mJ at any rim, and the push is that of the
/// cubic's slope, 6 u (1 - u) / rim of it at u rims from the edge.
TEST(Crossing, ARimOfAnyWidthTakesTheSameWorkAndPushesByItsSlope) {
  for (const double rim : {0.5, 1.0, 2.0, 4.0})
    for (const char* shape : {"", "; shape ellipse", "; shape mask"}) {
      const std::string outline =
          std::string(shape) == "; shape mask" ? "shape polygon(-20 mm, -20 mm, 20 mm, -20 mm, 20 mm, 20 mm, -20 mm, 20 mm)"
                                               : "size 40 mm, 40 mm" + std::string(shape);
      const Library library;
      const auto compiled = library.workspace(
          "wale 1\nmaterial slab {\n  physical {\n    height top = 1 mm * patch_fade()\n"
          "    force = -2 N * grad(top)\n  }\n}\nworkspace desk {\n  patch one = slab { " +
          outline + "; rim " + std::to_string(rim) + " mm }\n}\n");
      ASSERT_TRUE(compiled) << explained(compiled.error());
      const WorkspacePatch& patch = compiled->workspace.patches.at(0);
      Bank bank(patch.program, patch.program.default_parameters(), *patch.options.size);
      const Shape laid = patch.options.shape.stretched({bank.size().width, bank.size().height});
      double work = 0;
      constexpr int steps = 40000;
      for (int i = 0; i < steps; ++i) {
        const double x = -0.021 + 0.021 * (i + 0.5) / steps;
        Hand hand{.position = glm::vec2(x, 0)};
        double force = 0;
        if (x > -0.02) {
          if (!laid.is_rectangle()) {
            const EdgeDistance edge = laid.edge(glm::vec2(x, 0));
            hand.edge = std::max(edge.metres, std::numeric_limits<float>::min());
            hand.edge_slope = edge.slope;
          }
          force = tick(bank, hand).x;
        }
        const double u = std::clamp((x + 0.02) / (1e-3 * rim), 0.0, 1.0);
        ASSERT_NEAR(force, -2e-3 * 6 * u * (1 - u) / (1e-3 * rim), 0.01 + 0.01 / rim) << rim << " " << shape << " " << x;
        work -= force * 0.021 / steps;
      }
      EXPECT_NEAR(work, 2e-3, 1e-5) << rim << " " << shape;
    }
}

TEST(Crossing, NoClosedWayOverTheBorderOrAMasksEdgeGainsEnergy) {
  const Library library;
  const auto compiled = library.workspace(text_of(
      "  patch left = rough { at -30 mm, 0 mm; size 60 mm, 40 mm; shape ellipse }\n"
      "  patch right = smooth { at 25 mm, 0 mm; shape polygon(-30 mm, -20 mm, 30 mm, -20 mm, 5 mm, 20 mm) }\n"));
  ASSERT_TRUE(compiled) << explained(compiled.error());
  struct Laid {
    Bank bank;
    PatchOptions options;
  };
  std::vector<Laid> laid;
  for (const WorkspacePatch& each : compiled->workspace.patches)
    laid.push_back({Bank(each.program, each.program.default_parameters(), *each.options.size), each.options});
  // The front-most patch under the hand pushes, as on a stage.
  const auto force_at = [&](glm::dvec2 place) {
    for (std::size_t i = laid.size(); i-- > 0;) {
      const glm::vec2 at = glm::vec2(place) - laid[i].options.at,
                      half(0.5f * laid[i].options.size->width, 0.5f * laid[i].options.size->height);
      if (std::abs(at.x) > half.x || std::abs(at.y) > half.y || !laid[i].options.shape.contains(at)) continue;
      Hand hand{.position = at};
      const EdgeDistance edge = laid[i].options.shape.edge(at);
      hand.edge = std::max(edge.metres, std::numeric_limits<float>::min());
      hand.edge_slope = edge.slope;
      return glm::dvec2(tick(laid[i].bank, hand));
    }
    return glm::dvec2(0);
  };
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(-0.03, 0.03), y(-0.022, 0.022);
  double most = 0, brushed = 0;
  for (int way = 0; way < 12; ++way) {
    std::vector<glm::dvec2> corners;
    for (int i = 0; i < 5; ++i) corners.emplace_back(x(random), y(random));
    double gained = 0, moved = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec2 from = corners[i], along = corners[(i + 1) % corners.size()] - from;
      const int steps = 1 + static_cast<int>(std::hypot(along.x, along.y) / 4e-6);
      for (int k = 0; k < steps; ++k) {
        const double work = glm::dot(force_at(from + (k + 0.5) / steps * along), along) / steps;
        gained += work, moved += std::abs(work);
      }
    }
    most = std::max(most, std::abs(gained));
    brushed = std::max(brushed, moved);
  }
  EXPECT_GT(brushed, 0.01);
  EXPECT_LT(most, 1e-3 * brushed);
}

}  // namespace
}  // namespace wale::promises
