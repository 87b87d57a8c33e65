// A device that is too weak for a level renders the stimulus that it can give, with that stimulus's shape, stiffness
// and damping. The expectations are closed forms of Minsky's grating: its force at a distance u of the steepest place
// is A exp(-u^2 / (2 w^2)) with w = 24/256 periods, so its steepest slope is A exp(-1/2) / w.

#include <gtest/gtest.h>

#include <cmath>

#include "compiler/describe/describe.hpp"
#include "tests/calibration/declared.hpp"

namespace wale::scaling_test {
namespace {

using calibrating::bank_at;
using calibrating::Declared;

const char* const weak_device =
    "device weak { class force_plane; workspace disc(228.6 mm); position 4096 counts; force 2 N, 2048 counts\n"
    "  rate 900 Hz; speed 1 m/s; slew 200 N/s; velocity_filter 15, 1 counts; patch 160 mm, 160 mm, 5 mm\n"
    "  damping assumed 1 N s/m }\n";
const char* const ribs = "physical { force = lateral(grating(x, period: 2.5 mm)) }";

constexpr double period = 2.5e-3, width = 24.0 / 256 * period;

/// The force of the grating with amplitude `newton` at `x` (m), where ridges are centred at whole periods: hills take
/// half a period, so a flank is a quarter of a period off.
double grating_force(double newton, double x) {
  const double u = x - period * std::floor(x / period + 0.5);  // -1/2 .. 1/2 of a period
  double force = 0;
  for (int i = -2; i <= 2; ++i)
    for (const double side : {-1.0, 1.0}) {
      const double off = u - i * period - side * period / 4;
      force += side * std::exp(-off * off / (2 * width * width));
    }
  return newton * force;
}

double force_at(const Bank& bank, double x) {
  Hand hand;
  hand.position = {static_cast<float>(x), 0};
  Bank copy = bank;
  return tick(copy, hand).x;
}

TEST(Scaling, KeepsTheWaveformOnAWeakDevice) {
  Declared declared(std::string("material m { perceptual { roughness 0.95 } ") + ribs + " }\n" + weak_device);
  const Program program = declared.program("m", "weak");
  EXPECT_EQ(declared.codes(), "W0408");
  const Bank bank(program);
  // The tops of the clipped grating of 3.54 N would be flat at 2 N over 40 % of the way.
  double worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = -20e-3 + 1e-5 * i;
    worst = std::max(worst, std::abs(force_at(bank, x) - grating_force(2, x)));
  }
  EXPECT_LT(worst, 0.02) << "1 % of the steepest places are held at the 99th percentile";
  const Description description = describe(bank, declared.declarations());
  const double stiffness = 2 * std::exp(-0.5) / width;
  EXPECT_NEAR(description.grade.stiffness, stiffness, 0.01 * stiffness);
  EXPECT_NEAR(description.grade.required_damping, stiffness / 900 / 2, 0.01 * stiffness / 1800);
  EXPECT_NEAR(description.texture->force.amplitude, 2, 0.01);
  const DescribedPercept& roughness = description.percepts.at(0);
  EXPECT_NEAR(roughness.amplitude, 2, 1e-5);
  EXPECT_NEAR(roughness.level, std::pow(2 / (194 * 10.0 / 512), 0.759593), 1e-4);
  EXPECT_TRUE(roughness.saturated);
}

TEST(Scaling, FollowsTheSlider) {
  Declared declared(std::string("material m { perceptual { roughness 0.95 } ") + ribs + " }\n" + weak_device);
  const Program program = declared.program("m", "weak");
  for (const double level : {0.0, 0.1, 0.3, 0.6, 0.62, 0.7, 1.0}) {
    const double asked = 194 * 10.0 / 512 * std::pow(level, 1 / 0.759593);
    EXPECT_NEAR(amplitude(bank_at(program, {{"roughness", level}}), 0), std::min(asked, 2.0), 1e-4) << level;
  }
}

TEST(Scaling, LeavesStrongDevicesAsTheyWere) {
  Declared declared(std::string("material m { perceptual { roughness 0.95 } ") + ribs + " }\n");
  const Program program = declared.program();
  EXPECT_NEAR(amplitude(Bank(program), 0), 194 * 10.0 / 512 * std::pow(0.95, 1 / 0.759593), 1e-4);
  EXPECT_EQ(declared.codes(), "");
}

// Springs and walls count at the reach that their percept declares, here 40 mm: 2 N there are 50 N/m.
TEST(Scaling, HoldsForEveryForceThatAPerceptSolves) {
  Declared declared(std::string("material m { perceptual { springiness 0.8 } }\n") + weak_device);
  const Program program = declared.program("m", "weak");
  EXPECT_NEAR(force_at(Bank(program), 0.01), -50 * 0.01, 1e-5);
  EXPECT_NEAR(force_at(Bank(program), 0.039), -50 * 0.039, 1e-5) << "not cut within that reach";
}

std::string fate_of(Declared& declared, const std::string& material, const std::string& device,
                    std::map<std::string, double> at = {}) {
  const Program program = declared.program(material, device);
  for (const DescribedFate& each : fates_at(bank_at(program, at), declared.declarations()))
    if (!each.record.percept) return fate_word(each.record.fate) + ": " + each.record.reason;
  return "";
}

TEST(Fates, AFixedForceThatIsCutIsSaturated) {
  Declared declared(
      std::string("material push { physical { force = vector(3 N, 0 N) } }\n"
                  "material just { physical { force = vector(2 N, 0 N) } }\n"
                  "material ribs { physical { force = lateral(grating(x, period: 2.5 mm), amplitude: 3 N) } }\n"
                  "material held { physical { force = lateral(grating(x, period: 2.5 mm), amplitude: 2 N) } }\n"
                  "material limited { physical { force = lateral(grating(x, period: 2.5 mm), amplitude: 3 N) limit 2 N "
                  "} }\n"
                  "material oil { physical { param b = 6 N s/m in 0 N s/m .. 20 N s/m\n force = viscous(b) } }\n"
                  "material clings { physical { force = sticky(2.5 N) } }\n") +
      weak_device);
  const std::string kept = "kept: by the material's formulas, not found from a level";
  EXPECT_EQ(fate_of(declared, "push", "weak"),
            "saturated: by the material's formulas, which ask for up to 3 N along x or y, and `weak` gives 2 N");
  EXPECT_EQ(fate_of(declared, "push", "sandpaper"), kept);
  EXPECT_EQ(fate_of(declared, "just", "weak"), kept);
  EXPECT_EQ(fate_of(declared, "ribs", "weak").substr(0, 9), "saturated");
  EXPECT_EQ(fate_of(declared, "held", "weak"), kept) << "it reaches the limit and is not cut";
  EXPECT_EQ(fate_of(declared, "limited", "weak"), kept) << "its author limits it";
  // The hand `normal` moves at 0.25 m/s at most: 6 N s/m are 1.5 N, 10 N s/m are 2.5 N.
  EXPECT_EQ(fate_of(declared, "oil", "weak"), kept);
  EXPECT_EQ(fate_of(declared, "oil", "weak", {{"b", 10}}).substr(0, 9), "saturated");
  EXPECT_EQ(fate_of(declared, "clings", "weak"),
            "saturated: by the material's formulas, which ask for up to 2.5 N along x or y, and `weak` gives 2 N")
      << "only a hand that moved is held";
  EXPECT_EQ(fate_of(declared, "clings", "sandpaper"), kept);
  const Program program = declared.program("push", "weak");
  EXPECT_EQ(program.description().fates.at(0).fate, Fate::saturated) << "the file says so too";
}

TEST(Fates, AFixedSizeThatIsCutSaturatesItsPercept) {
  Declared declared(std::string("material m { perceptual { roughness 0.84 ± 0.02 }\n"
                                "  physical { force = lateral(grating(x, period: 2.5 mm), amplitude: 3 N) } }\n") +
                    weak_device);
  const Program program = declared.program("m", "weak");
  const FateRecord& roughness = program.description().fates.at(0);
  EXPECT_EQ(roughness.fate, Fate::saturated);
  EXPECT_NEAR(roughness.given, std::pow(2 / (194 * 10.0 / 512), 0.759593), 1e-4);
}

// The gamepad renders ribs of 2.5 mm at 0.1 m/s with 40 Hz, where it gives 10 m/s^2 of the 12 that level 1 needs.
TEST(Fates, AndLevelsAgreeOnAPadThatGivesLessAtARate) {
  Declared declared("material ribs { perceptual { roughness 1 } }\n");
  const Bank bank(declared.program("ribs", "gamepad"));
  const Description description = describe(bank, declared.declarations());
  const DescribedPercept& roughness = description.percepts.at(0);
  EXPECT_TRUE(roughness.saturated);
  EXPECT_NEAR(roughness.amplitude, 10, 1e-4);
  EXPECT_NEAR(roughness.level, std::pow(10.0 / 12, 0.76), 1e-4);
  EXPECT_NEAR(description.fates.at(0).record.given, roughness.level, 1e-4);
}

}  // namespace
}  // namespace wale::scaling_test
