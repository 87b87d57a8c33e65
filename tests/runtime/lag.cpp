// The force of a delayed actuator, against the overlap of each command's time with the period.
#include "runtime/stage/lag.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "tests/runtime/figures.hpp"

namespace wale::lag_test {
namespace {

/// The mean over [end - periods, end] of commands; command k acts from k + late to k + 1 + late.
double mean_force(const std::vector<double>& commands, double late, double end, double periods) {
  double sum = 0;
  for (std::size_t k = 0; k < commands.size(); ++k) {
    const double from = static_cast<double>(k) + late, to = from + 1;
    sum += commands[k] * std::max(0.0, std::min(to, end) - std::max(from, end - periods));
  }
  return sum / periods;
}

TEST(Lag, IsTheMeanOfTheCommandsThatHaveArrived) {
  std::mt19937 random(1995);
  std::uniform_real_distribution<double> newton(-10, 10);
  for (const double late_x : {0.0, 0.3, 1.0, 2.0, 2.7, 5.5})
    for (const double late_y : {0.0, 1.5}) {
      DeviceProfile profile = sandpaper();
      profile.delay_x = late_x / profile.rate;
      profile.delay_y = late_y / profile.rate;
      Lag late(profile);
      EXPECT_NEAR(late.periods().x, late_x, 1e-9);
      EXPECT_NEAR(late.periods().y, late_y, 1e-9);
      std::vector<double> x, y;
      for (int call = 0; call < 300; ++call) {
        const long periods = random() % 10 == 0 ? 2 : 1;
        const glm::dvec2 held(newton(random), newton(random));
        for (long period = 0; period < periods; ++period) x.push_back(held.x), y.push_back(held.y);
        const Lag::Answer felt = late.over({held, -held}, periods);
        const glm::dvec2 force = felt.force;
        ASSERT_NEAR(felt.place.x, -force.x, 1e-9);
        ASSERT_NEAR(felt.place.y, -force.y, 1e-9);
        const auto end = static_cast<double>(x.size()), length = static_cast<double>(periods);
        ASSERT_NEAR(force.x, mean_force(x, late_x, end, length), 1e-9) << call;
        ASSERT_NEAR(force.y, mean_force(y, late_y, end, length), 1e-9) << call;
      }
    }
}

TEST(Lag, ABandwidthDelaysByItsTimeConstant) {
  DeviceProfile profile = sandpaper();
  profile.bandwidth_y = profile.rate / (2 * std::numbers::pi * 3);
  EXPECT_NEAR(Lag(profile).periods().y, 3, 1e-9);
}

}  // namespace
}  // namespace wale::lag_test
