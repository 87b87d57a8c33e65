// Promise 3 for percepts that are no texture: the simulated hand moves, the size of each carrier is measured from the
// actuator's force, and the published law, written independently here, gives the level back.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/promises/running.hpp"

namespace wale {
namespace {

/// The ticks of a run without the first half second.
std::vector<TickRecord> settled(const std::string& percepts) {
  const Program program = promises::compiled("wale 1\nmaterial m { perceptual { " + percepts + " } }\n");
  std::vector<TickRecord> ticks;
  for (const TickRecord& tick : promises::record_of(program).ticks)
    if (tick.time > 0.5) ticks.push_back(tick);
  return ticks;
}

/// The negated slope of force against a quantity of the hand, by a fit through the origin.
template <typename Of>
double resistance(const std::vector<TickRecord>& ticks, Of of) {
  double products = 0, squares = 0;
  for (const TickRecord& tick : ticks) products -= of(tick) * tick.force.x, squares += of(tick) * of(tick);
  return products / squares;
}

constexpr double force_step = 10.0 / 2048;

TEST(Viscosity, ComesOutOfTheHandle) {
  for (const double level : {0.4, 0.7, 1.0}) {
    const auto ticks = settled("viscosity " + std::to_string(level));
    const double damping = resistance(ticks, [](const TickRecord& tick) { return tick.velocity.x; });
    const double asked = 10 * std::pow(level, 1 / 0.44);  // Stevens and Guirao 1964; level 1 is 10 N s/m
    // The tolerance includes one step of the force at 0.2 m/s.
    EXPECT_NEAR(damping, asked, 0.01 * asked + force_step / 0.2);
    EXPECT_NEAR(std::pow(damping / 10, 0.44), level, 0.01 + 0.44 * level * force_step / 0.2 / asked);
  }
}

TEST(Springiness, ComesOutOfTheHandle) {
  for (const double level : {0.2, 0.5, 0.9}) {
    const auto ticks = settled("springiness " + std::to_string(level));
    const double stiffness = resistance(ticks, [](const TickRecord& tick) { return tick.position.x; });
    EXPECT_NEAR(stiffness / 200, level, 0.01);  // in proportion; level 1 is 200 N/m
  }
}

TEST(Stickiness, ComesOutOfTheHandle) {
  for (const double level : {0.5, 0.8}) {
    // The median of the opposing force away from the turning points, where the bristle bends over.
    std::vector<double> drags;
    for (const TickRecord& tick : settled("stickiness " + std::to_string(level)))
      if (std::abs(tick.velocity.x) > 0.15) drags.push_back(-tick.force.x * (tick.velocity.x > 0 ? 1 : -1));
    ASSERT_GT(drags.size(), 500u);
    std::ranges::nth_element(drags, drags.begin() + static_cast<std::ptrdiff_t>(drags.size() / 2));
    EXPECT_NEAR(drags[drags.size() / 2], level, force_step);  // in proportion; level 1 is 1 N
  }
}

TEST(Vibration, ComesOutOfTheHandle) {
  for (const double level : {0.3, 0.8}) {
    double squares = 0;
    const auto ticks = settled("vibration " + std::to_string(level));
    for (const TickRecord& tick : ticks) squares += tick.force.x * tick.force.x;
    const double amplitude = std::sqrt(2 * squares / static_cast<double>(ticks.size()));
    EXPECT_NEAR(std::pow(amplitude / 2, 0.89), level, 0.01);  // Verrillo 1970; level 1 is 2 N
  }
}

TEST(TwoPercepts, ComeOutTogether) {
  // Least squares separate the force in proportion to velocity from the force in proportion to place.
  double vv = 0, pp = 0, vp = 0, fv = 0, fp = 0;
  for (const TickRecord& tick : settled("viscosity 0.8; springiness 0.4")) {
    const double v = tick.velocity.x, p = tick.position.x, f = tick.force.x;
    vv += v * v, pp += p * p, vp += v * p, fv -= f * v, fp -= f * p;
  }
  const double determinant = vv * pp - vp * vp;
  const double damping = (fv * pp - fp * vp) / determinant, stiffness = (fp * vv - fv * vp) / determinant;
  EXPECT_NEAR(std::pow(damping / 10, 0.44), 0.8, 0.01);
  EXPECT_NEAR(stiffness / 200, 0.4, 0.01);
}

}  // namespace
}  // namespace wale
