#include "compiler/grade/grade.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tests/grade/grading.hpp"

namespace wale::grade_test {
namespace {

using grading::device;
using grading::graded;

constexpr double pi = 3.14159265358979323846;

struct Stimulus {
  double program_units, period_mm;  // as in Minsky 1995, table 6 (calibration/maps/minsky1995_table6.csv)
  double stiffness, damping, step;  // N/m: 2 pi A / period; N s/m: stiffness * T / 2; N: 2 A sin(pi count / period)
};

/// Sines with amplitudes and periods of the thesis, against closed forms.
class SinesOfTheThesis : public testing::TestWithParam<Stimulus> {};

TEST_P(SinesOfTheThesis, HaveTheGradeOfTheClosedForms) {
  const Stimulus row = GetParam();
  const Grade grade =
      graded(fmt::format("    force = vector({} pu * sin(2 pi * x / {} mm), 0 N)", row.program_units, row.period_mm));
  EXPECT_NEAR(grade.stiffness, row.stiffness, 0.003 * row.stiffness);
  EXPECT_NEAR(grade.required_damping, row.damping, 0.005 + 0.003 * row.damping);
  EXPECT_NEAR(grade.step_newton, row.step, 0.001 + 0.003 * row.step);
  EXPECT_NEAR(grade.finest_period, 1e-3 * row.period_mm, 0.03e-3 * row.period_mm);
  EXPECT_NEAR(grade.force_levels, row.program_units * 4, 0.02 * row.program_units * 4);  // 512 units, 2048 counts
  EXPECT_EQ(grade.standing, Standing::unknown);
  EXPECT_TRUE(grade.energy.conservative);
  EXPECT_FALSE(grade.jumps);
}

INSTANTIATE_TEST_SUITE_P(Minsky, SinesOfTheThesis,
                         testing::Values(Stimulus{9, 0.9, 1227, 0.68, 0.0681}, Stimulus{17, 0.7, 2980, 1.66, 0.1646},
                                         Stimulus{41, 0.7, 7188, 3.99, 0.3970}, Stimulus{14, 2.5, 687, 0.38, 0.0383},
                                         Stimulus{159, 2.5, 7805, 4.34, 0.4352},
                                         Stimulus{194, 10, 2381, 1.32, 0.1329}));

TEST(Grade, KnownDampingDecidesBetweenPassiveHandAndUnstable) {
  const std::string wave = "    force = vector(1 N * sin(2 pi * x / 2.5 mm), 0 N)";  // K T / 2 = 1.396 N s/m
  const auto standing = [&](const std::string& damping) {
    return graded(wave, device("  damping " + damping), "bench");
  };
  EXPECT_EQ(standing("1.5 N s/m").standing, Standing::passive);
  EXPECT_NEAR(*standing("1.5 N s/m").margin(), 0.104, 0.01);
  EXPECT_EQ(standing("1 N s/m").standing, Standing::stable_in_the_hand);
  EXPECT_EQ(standing("assumed 1.5 N s/m").standing, Standing::unknown);
  EXPECT_FALSE(standing("assumed 1.5 N s/m").margin());
  const Grade steep =
      graded("    force = vector(8 N * sin(2 pi * x / 2.5 mm), 0 N)", device("  damping 1 N s/m"), "bench");
  EXPECT_EQ(steep.standing, Standing::unstable);  // 11.2 against 1 and 6.5
}

// The required damping is K (T / 2 + d + 1 / (2 pi f)) for the axis with the larger delay.
TEST(Grade, UsesTheDeclaredDelayAndBandwidthOfTheAxes) {
  const auto needed = [](const std::string& settings) {
    return graded("    force = -100 N/m * hand", device(settings), "bench").required_damping;
  };
  EXPECT_NEAR(needed(""), 100.0 / 1800, 1e-4);
  EXPECT_NEAR(needed("  delay 1 ms"), 100 * (1.0 / 1800 + 0.001), 1e-4);
  EXPECT_NEAR(needed("  delay 1 ms, 2 ms"), 100 * (1.0 / 1800 + 0.002), 1e-4);
  EXPECT_NEAR(needed("  delay 1 ms, 2 ms\n  bandwidth 20 Hz, 200 Hz"), 100 * (1.0 / 1800 + 0.001 + 1 / (2 * pi * 20)),
              1e-4);
}

TEST(Grade, BuzzesWhereFrictionIsBelowHalfAStep) {
  const auto buzzes = [](const std::string& friction) {
    return graded("    force = vector(1 N * sin(2 pi * x / 2.5 mm), 0 N)", device("  friction " + friction), "bench")
        .buzzes;
  };
  // One count changes the force by 0.1403 N, so the edge is at 0.0701 N.
  EXPECT_EQ(buzzes("0.08 N"), false);
  EXPECT_EQ(buzzes("0.06 N"), true);
  EXPECT_EQ(buzzes("assumed 0.06 N"), std::nullopt);
}

TEST(Grade, SpringsOilAndPotentialsAreNotActive) {
  for (const char* physical : {"    force = -40 N/m * hand", "    force = -4 N s/m * velocity",
                               "    height h = grating(x + y, period: 3 mm) * grating(y, period: 2 mm)\n"
                               "    force = lateral(h, amplitude: 2 N)",
                               "    force = -200 N/m * hand * exp(-(length(hand) / 20 mm)^2) - 1 N s/m * velocity"}) {
    const Grade grade = graded(physical);
    EXPECT_EQ(grade.standing, Standing::unknown) << physical;
    EXPECT_EQ(grade.energy.watt(), 0) << physical;
  }
}

TEST(Grade, AConstantForceNeedsNoDamping) {
  const Grade grade = graded("    force = vector(0.5 N, 0 N)");
  EXPECT_EQ(grade.standing, Standing::passive);
  EXPECT_EQ(grade.required_damping, 0);
  EXPECT_EQ(grade.stiffness, 0);
  EXPECT_TRUE(std::isinf(grade.finest_period));
}

TEST(Grade, ARotationalFieldGivesItsCurlTimesTheArea) {
  const Grade grade = graded("    let k = 15 N/m\n    force = vector(-k * y, k * x)");
  EXPECT_EQ(grade.standing, Standing::active);
  EXPECT_FALSE(grade.energy.conservative);
  EXPECT_NEAR(grade.energy.watt(), 30 * pi * 0.04 * 0.04, 1e-3);  // curl 2 k, circles of 40 mm at 1 Hz
}

// The largest force all along the way of the hand, which goes round at 2 pi 40 mm a second, is more than any hand gains.
TEST(Grade, ASmallPatchGivesNoMorePowerThanItsForceDoes) {
  for (const std::string law :
       {"height h = 0.5 + x / 8 mm\n    force = lateral(h, amplitude: 1 N)",
        "height h = fract(x / 2 mm)\n    force = lateral(h, amplitude: 1 N)",
        "force = vector(1 N * sign(sin(2 pi * y / 1 mm)), 0 N)", "force = vector(1 N * sin(2 pi * y / 0.5 mm), 0 N)",
        "force = 1 N * normalise(perpendicular(hand))"})
    for (const std::string patch : {"4 mm, 4 mm", "4 mm, 8 mm", "20 mm, 20 mm"})
      EXPECT_LE(graded("    patch " + patch + "\n    " + law).energy.watt(), 2 * pi * 0.04 * 1 * (1 + 1e-6)) << patch << ' ' << law;
}

TEST(Grade, AntiViscosityGivesItsPower) {
  const Grade grade = graded("    force = 2 N s/m * velocity");
  EXPECT_EQ(grade.standing, Standing::active);
  EXPECT_NEAR(grade.required_damping, 2, 0.01);
  const double speed = 2 * pi * 0.04;  // of the hand along each axis
  EXPECT_NEAR(grade.energy.watt(), 2 * 2 * speed * speed, 0.1 * 2 * 2 * speed * speed);
}

TEST(Grade, MotionByItselfIsActiveAndMotionDrivenByTheHandIsNot) {
  EXPECT_EQ(graded("    force = vector(0.3 N * sin(2 pi * 5 Hz * time), 0 N)").standing, Standing::active);
  EXPECT_EQ(graded("    force = vector(0.3 N * sin(phase(5 Hz)), 0 N)").standing, Standing::active);
  // A state that both the hand and an oscillation drive.
  EXPECT_EQ(
      graded(
          "    state p : position = hand\n    next p = p + (hand - p) * 0.1 + vector(1 mm * sin(phase(5 Hz)), 0 mm)\n"
          "    force = -50 N/m * (hand - p)")
          .standing,
      Standing::active);
  EXPECT_EQ(graded("    state p : position = hand\n    state v : velocity = vector(0 m/s, 0 m/s)\n"
                   "    let pull = 120 N/m * (hand - p)\n    v' = (pull - 0.8 N s/m * v) / 0.3 kg\n    p' = v\n"
                   "    force = -pull")
                .standing,
            Standing::unknown);
  // A state that stays at the place where the hand entered.
  EXPECT_EQ(graded("    state p : position = hand\n    next p = p\n    force = -50 N/m * (hand - p)").standing,
            Standing::unknown);
}

TEST(Grade, AStateThatGivesMoreEnergyThanItTakesIsActive) {
  // A mass that is pushed along its own motion.
  const Grade grade = graded(
      "    state p : position = hand\n    state v : velocity = vector(0 m/s, 0 m/s)\n"
      "    let pull = 120 N/m * (hand - p)\n    v' = (pull + 4 N s/m * v) / 0.3 kg\n    p' = v\n"
      "    force = -pull");
  EXPECT_EQ(grade.standing, Standing::active);
  EXPECT_GT(grade.energy.watt(), 0);
}

/// What a wall or a push gives a hand on its way out, it takes back on the way in.
TEST(Grade, AMemoryBesideAPotentialIsNotActive) {
  for (const char* beside :
       {"firm(910 N/m, face: -40 mm)", "vector(4 N, 0 N)", "-60 N/m * (hand - vector(30 mm, 0 mm))"}) {
    const Grade grade = graded(std::string("    force = sticky(0.3 N) + ") + beside);
    EXPECT_EQ(grade.energy.watt(), 0) << beside;
    EXPECT_NE(grade.standing, Standing::active) << beside;
  }
}

TEST(Grade, AJumpIsFoundByItsStep) {
  const Grade grade = graded("    force = vector(if x < 3.21 mm then 1.5 N else -0.5 N, 0 N)");
  EXPECT_TRUE(grade.jumps);
  EXPECT_NEAR(grade.step_newton, 2, 1e-6);
  EXPECT_NEAR(grade.required_damping, 2 / (0.2286 / 4096) / 1800, 0.01);
}

TEST(Grade, ARampToAConstantForceIsFiniteAtItsCentre) {
  const Grade grade = graded("    force = -1 N * normalise(hand) * min(1, length(hand) / 10 mm)");
  EXPECT_TRUE(std::isfinite(grade.required_damping));
  EXPECT_NEAR(grade.stiffness, 100, 1);  // 1 N over 10 mm
}

TEST(Grade, StiffnessAtASingularityIsLimitedByTheEncoder) {
  // A force of constant size towards the centre. Close to the centre its direction reverses within any distance.
  const Grade grade = graded("    force = -1 N * hand / length(hand)");
  const double count = 0.2286 / 4096;
  EXPECT_GT(grade.stiffness, 0.5 / count * 0.1);
  EXPECT_LE(grade.stiffness, 2 / count * (1 + 1e-6));
  EXPECT_LE(grade.required_damping, 2 / count / 1800 * (1 + 1e-6));
}

TEST(Grade, IsOfTheParametersAsTheyAreSet) {
  const Program program = compiling::compiled("    param k = 40 N/m in 0 N/m .. 400 N/m\n    force = -k * hand");
  const std::vector<float> stiff{400};
  EXPECT_NEAR(grade(Bank(program), grading::hand).stiffness, 40, 1e-3);
  EXPECT_NEAR(grade(Bank(program, stiff, program.default_size()), grading::hand).stiffness, 400, 1e-2);
}

TEST(Grade, IsTheSameEveryTime) {
  const std::string physical =
      "    height h = noise2(x / 2 mm, y / 2 mm)\n    force = lateral(h, amplitude: 1 N) - 1 N s/m * velocity";
  const Grade one = graded(physical), two = graded(physical);
  EXPECT_EQ(one.required_damping, two.required_damping);
  EXPECT_EQ(one.worst.position, two.worst.position);
  EXPECT_EQ(one.stiffness, two.stiffness);
}

}  // namespace
}  // namespace wale::grade_test
