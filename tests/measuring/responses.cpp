// What a calibration finds on the simulated device whose truth is planted: the 95 % intervals hold it as often as they
// say, and forces that are corrected by the figures come out as they were asked for. The seeds are fixed: of 200
// intervals of 95 %, a right method holds the truth in 183 to 197 nearly always.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "calibration/device/ask_for_forces.hpp"
#include "calibration/device/bench.hpp"
#include "calibration/device/device_calibration.hpp"

namespace wale::measuring::responses_test {
namespace {

constexpr int seeds = 200, fewest = 181;

DeviceProfile stick() {
  return {.name = "stick",
          .workspace_diameter = 0.2,
          .position_counts = 16384,
          .force_newton = 10,
          .force_counts = 4096,
          .rate = 1000,
          .velocity_window = 15,
          .mass = 0.3,
          .damping = 1.2,
          .friction = 0.2,
          .delay_x = 2e-3,
          .delay_y = 3.5e-3};
}

/// Four ways that differ, with the given bends and saturations.
DeviceWiring planted(double quadratic, double cubic, double most) {
  DeviceWiring wiring;
  wiring.gain = {0.92, 1.1};
  wiring.response = {ForceResponse{1.02, 0.35, quadratic, cubic, most},
                     ForceResponse{0.98, 0.25, quadratic, cubic, most}, ForceResponse{1.01, 0.3, quadratic, cubic, 0},
                     ForceResponse{0.99, 0.45, quadratic, cubic, 0}};
  wiring.offset = {0.08, -0.05};
  return wiring;
}

/// The commands of a whole protocol, as the simulated device takes them in its steps.
const std::vector<GaugeStep>& taken_steps() {
  static const std::vector<GaugeStep> steps = [] {
    PlantedDevice device(stick(), {}, 1);
    std::vector<GaugeStep> all = force_steps(stick().force_newton);
    for (GaugeStep& step : all) {
      Force force(0);
      force[axis_of(step.way)] = static_cast<float>(sign_of(step.way) * step.command);
      step.command = sign_of(step.way) * device.command(force)[axis_of(step.way)];
    }
    return all;
  }();
  return steps;
}

std::vector<GaugeReading> readings_of(const DeviceWiring& truth, std::uint64_t seed) {
  PlantedDevice device(stick(), truth, seed);
  std::vector<GaugeReading> readings;
  for (const GaugeStep& step : taken_steps())
    readings.push_back({step.way, step.command, device.gauge(step.way, step.command), step.repeat, 0});
  return readings;
}

struct PlantedBends {
  const char* name;
  double quadratic, cubic, most;
};

class Planted : public testing::TestWithParam<PlantedBends> {};

TEST_P(Planted, TheTruthIsWithinTheIntervals) {
  const auto [name, quadratic, cubic, most] = GetParam();
  const DeviceWiring truth = planted(quadratic, cubic, most);
  std::map<std::string, int> held;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto found = fit_readings(readings_of(truth, static_cast<std::uint64_t>(seed)), stick().force_newton);
    ASSERT_TRUE(found) << seed << ": " << found.error().sentence;
    const auto hold = [&](const std::string& figure, const analysis::Coefficient& of, double true_value) {
      held[figure] += of.low() <= true_value && true_value <= of.high() ? 1 : 0;
    };
    for (const Way way : all_ways) {
      const auto i = static_cast<std::size_t>(way);
      const WayFit& fit = *found->ways[i];
      const ForceResponse& response = truth.response[i];
      const std::string in_way = std::string(" ") + in_words(way);
      hold("gain" + in_way, fit.gain, truth.gain[i / 2] * response.gain);
      hold("dead band" + in_way, fit.dead_band, response.dead_band);
      hold("quadratic" + in_way, fit.quadratic, quadratic);
      hold("cubic" + in_way, fit.cubic, cubic);
      if (response.most > 0) {
        ASSERT_TRUE(fit.most) << "seed " << seed << ", " << in_words(way);
        hold("saturation" + in_way, *fit.most, response.most);
      } else {
        held["no saturation" + in_way] += fit.most ? 0 : 1;
      }
    }
    hold("offset x", axis_offset(*found->ways[0], *found->ways[1]), truth.offset[0]);
    hold("offset y", axis_offset(*found->ways[2], *found->ways[3]), truth.offset[1]);
  }
  for (const auto& [figure, times] : held) EXPECT_GE(times, fewest) << figure << ", " << name;
}

TEST_P(Planted, CorrectedForcesReachWhatWasAsked) {
  const auto [name, quadratic, cubic, most] = GetParam();
  const DeviceWiring truth = planted(quadratic, cubic, most);
  const double peak = stick().force_newton;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const auto found = fit_readings(readings_of(truth, seed), peak);
    ASSERT_TRUE(found);
    DeclaredDevice declared;
    declared.profile = stick();
    const DeviceWiring measured = calibrated(declared, *found).wiring;
    double without = 0;
    for (const Way way : all_ways) {
      const std::size_t axis = static_cast<std::size_t>(axis_of(way));
      const AxisResponse corrects = measured.response_of(axis, peak), pushes = truth.response_of(axis, peak);
      const double reach = std::min(corrects.force(peak), -corrects.force(-peak));
      // Near a saturation the curve is known worse: its last readings are those of the plateau.
      const double share = truth.response[static_cast<std::size_t>(way)].most > 0 ? 0.85 : 0.99;
      for (double asked = 0.5; asked < share * reach; asked += 0.1) {
        const double newton = pushes.force(corrects.command(sign_of(way) * asked));
        EXPECT_NEAR(newton, sign_of(way) * asked, found->ways[static_cast<std::size_t>(way)]->greatest_residual)
            << name << ", " << in_words(way) << ", seed " << seed;
        without = std::max(without, std::abs(pushes.force(sign_of(way) * asked) - sign_of(way) * asked));
      }
    }
    EXPECT_GT(without, 0.3) << "without a correction it is far off";
  }
}

INSTANTIATE_TEST_SUITE_P(Bends, Planted,
                         testing::Values(PlantedBends{"softening", -0.18, 0, 6.5},
                                         PlantedBends{"hardening", 0.1, 0.15, 6.2}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(Responses, AForceIsTheInverseOfItsCommand) {
  const AxisResponse axis(0.9, {1.05, 0.4, -0.2, 0.1, 0}, {0.95, 0.1, 0.3, -0.1, 7}, 0, 10);
  for (double force = -6.9; force < 7; force += 0.01)
    EXPECT_NEAR(axis.force(axis.command(force)), force, 1e-9) << force;
  EXPECT_EQ(axis.command(0), 0) << "no force is no command, in spite of the dead band";
  EXPECT_EQ(axis.command(std::nan("")), 0);
  EXPECT_LE(axis.command(1e9), 10);
  EXPECT_GE(axis.command(-1e9), -10);
  const double most = axis.steepest();
  for (double command = 0.001; command <= 10; command += 0.001) {
    EXPECT_LE(axis.force(command), most * command);
    EXPECT_LE(-axis.force(-command), most * command);
  }
}

TEST(Responses, AnOffsetIsTakenAwayWithoutAJump) {
  const AxisResponse axis(1, {}, {}, 0.2, 10);
  EXPECT_EQ(axis.command(0), 0);
  double before = axis.command(-2);
  for (double force = -2; force <= 2; force += 1e-3) {
    const double command = axis.command(force);
    EXPECT_NEAR(command, before, 2e-3) << force;
    if (std::abs(force) >= 0.4) {
      EXPECT_NEAR(axis.force(command), force, 1e-9);
    }
    before = command;
  }
}

TEST(Responses, AMotorKeepsItsResponseWhereverItPushes) {
  const DeviceWiring wiring = planted(-0.1, 0.05, 6);
  const std::array<SignedAxis, 2> turned{{{1, -1}, {0, 1}}};
  const DeviceWiring other = wiring.with_motors(turned);
  // What its own y motor does with a command of 3 N, whichever way the handle lies: away there, to the left here.
  EXPECT_EQ(other.response_of(0, 10).force(-3), -wiring.response_of(1, 10).force(3));
  EXPECT_EQ(other.response_of(0, 10).force(3), -wiring.response_of(1, 10).force(-3));
  EXPECT_EQ(other.response_of(1, 10).force(3), wiring.response_of(0, 10).force(3));
  EXPECT_EQ(other.with_motors(wiring.motors), wiring);
}

TEST(Responses, TooFewReadingsAreRefused) {
  auto readings = readings_of(planted(0, 0, 0), 1);
  const auto refused = [](std::vector<GaugeReading> few) { return fit_way(few, 10).error().sentence; };
  const auto right = [&](auto keeps) {
    std::vector<GaugeReading> kept;
    for (const GaugeReading& each : readings)
      if (each.way == Way::right && keeps(each)) kept.push_back(each);
    return kept;
  };
  EXPECT_EQ(refused(right([](const GaugeReading& each) { return each.command < 0.5; })).substr(0, 30),
            "right has 6 readings at 3 diff");
  EXPECT_NE(
      refused(right([](const GaugeReading& each) { return each.command > 0; })).find("no reading at a command of 0 N"),
      std::string::npos);
  auto falling = right([](const GaugeReading&) { return true; });
  for (GaugeReading& each : falling) each.newton = -each.newton;
  EXPECT_NE(refused(falling).find("does not push harder"), std::string::npos);
  auto gram_force = right([](const GaugeReading&) { return true; });
  for (GaugeReading& each : gram_force) each.newton *= 1000 / 9.80665;
  EXPECT_NE(fit_way(gram_force, 10).error().mend.find("102 times"), std::string::npos);
  EXPECT_FALSE(fit_readings({}, 10));
}

TEST(Responses, AGainFarFromTheDeclaredOneIsAsked) {
  DeviceWiring truth;
  truth.gain = {1.6, 1};
  const auto found = fit_readings(readings_of(truth, 1), 10);
  ASSERT_TRUE(found) << found.error().sentence;
  DeclaredDevice declared;
  declared.profile = stick();
  const auto questions = gain_questions(declared, *found);
  ASSERT_EQ(questions.size(), 2u);
  EXPECT_EQ(questions[0].way, Way::right);
  EXPECT_NE(questions[0].text().find("the declared gain is 1, and the readings say 1.6"), std::string::npos)
      << questions[0].text();
  EXPECT_NE(questions[0].text().find("102 times"), std::string::npos);
  declared.wiring.gain = {1.5, 1};
  EXPECT_TRUE(gain_questions(declared, *found).empty());
}

TEST(Responses, ACurveOfAnotherShapeIsSaidToBeOne) {
  std::vector<GaugeReading> readings;
  analysis::Random random(7);
  for (const GaugeStep& step : taken_steps())
    if (step.way == Way::right)
      readings.push_back({step.way, step.command,
                          0.9 * step.command + 0.2 * std::sin(1.5 * step.command) + 0.01 * random.normal(), step.repeat,
                          0});
  const auto fit = fit_way(readings, 10);
  ASSERT_TRUE(fit) << fit.error().sentence;
  ASSERT_TRUE(fit->lack_of_fit);
  EXPECT_LT(*fit->lack_of_fit, 0.01);
}

TEST(Responses, HeatingIsTheChangeBetweenTheRounds) {
  auto readings = readings_of(planted(0, 0, 0), 3);
  for (GaugeReading& each : readings)
    if (each.repeat == 2) each.newton *= 0.96;
  std::erase_if(readings, [](const GaugeReading& each) { return each.way != Way::away; });
  const auto fit = fit_way(readings, 10);
  ASSERT_TRUE(fit);
  ASSERT_TRUE(fit->drift);
  EXPECT_LT(fit->drift->low(), -0.04);
  EXPECT_GT(fit->drift->high(), -0.04);
  EXPECT_LT(fit->drift->high(), -0.02);
}

}  // namespace
}  // namespace wale::measuring::responses_test
