// One size of a carrier, in solving and in reading: the 99th percentile of the whole relief times the root of the share
// of its mean square that lies in the percept's band. The expectations are computed here from the formulas of the
// waves.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/read.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::bands_test {
namespace {

using std::numbers::pi;

struct Sine {
  double period = 0;     // mm
  double amplitude = 0;  // N
  double turn = 0;       // rad: its direction
  double phase = 0;      // rad

  double at(double x, double y) const {
    return amplitude * std::sin(2 * pi * (x * std::cos(turn) + y * std::sin(turn)) / period + phase);
  }
  std::string force() const {
    return fmt::format(
        "    force f{:.0f} = vector({:.6f}, {:.6f}) * {:.6f} N * sin(2 * pi * ({:.6f} * x + {:.6f} * y) / "
        "{:.6f} mm + {:.6f})\n",
        1e4 * period + 1e3 * phase, std::cos(turn), std::sin(turn), amplitude, std::cos(turn), std::sin(turn), period,
        phase);
  }
};

/// The 99th percentile of the size of a sum over the patch without its rim, 150 mm.
double percentile_99(const std::vector<Sine>& sines) {
  std::vector<double> sizes;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-75, 75);
  for (int i = 0; i < 60000; ++i) {
    const double x = place(random), y = place(random);
    double force_x = 0, force_y = 0;
    for (const Sine& each : sines) {
      force_x += each.at(x, y) * std::cos(each.turn);
      force_y += each.at(x, y) * std::sin(each.turn);
    }
    sizes.push_back(std::hypot(force_x, force_y));
  }
  std::ranges::sort(sizes);
  return sizes[sizes.size() * 99 / 100];
}

double carrier(const Program& program, const std::string& name) {
  static const auto common = common_modules();
  const Bank bank(program);
  return carrier_of(read(bank, common->declarations), *common->declarations.percepts.find(name), common->declarations)
      .value_or(0);
}

/// The share of a percept's band, as an amplitude.
double due(const std::vector<Sine>& sines, double low, double high) {
  double inside = 0, all = 0;
  for (const Sine& each : sines) {
    const double square = each.amplitude * each.amplitude;
    all += square;
    if (each.period >= low && each.period <= high) inside += square;
  }
  return percentile_99(sines) * std::sqrt(inside / all);
}

TEST(Bands, SumsOfSinesShareTheirSizeBetweenRoughnessAndBumpiness) {
  std::mt19937 random(1995);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int wrong = 0;
  constexpr int programs = 24;
  for (int i = 0; i < programs; ++i) {
    const double turn = i % 3 == 0 ? 0 : between(0, pi);
    std::vector<Sine> sines = {{between(1, 8), between(0.4, 1.2), turn, between(0, 6)},
                               {between(12, 40), between(0.4, 1.2), i % 2 == 0 ? turn : between(0, pi), between(0, 6)}};
    std::string physical;
    for (const Sine& each : sines) physical += each.force();
    if (i % 4 == 3) physical += "    force back = spring(30 N/m)\n";
    const Program program = compiling::compiled(physical);
    const double rough = carrier(program, "roughness"), bumpy = carrier(program, "bumpiness");
    const double rough_due = due(sines, 0.7, 10), bumpy_due = due(sines, 10, 100);
    const bool right =
        std::abs(rough - rough_due) <= 0.04 * rough_due && std::abs(bumpy - bumpy_due) <= 0.04 * bumpy_due;
    wrong += !right;
    if (!right)
      fmt::print("{}  roughness {:.4f}, due {:.4f}; bumpiness {:.4f}, due {:.4f}\n", physical, rough, rough_due, bumpy,
                 bumpy_due);
  }
  EXPECT_LE(wrong, 1) << "of " << programs;
}

TEST(Bands, WavesWithASmallCommonMultipleCountByTheirOwnPeriods) {
  // Nothing pushes with the period after which both repeat: 20 mm, 30 mm, 0.96 mm.
  for (const auto& [first, second] : {std::pair(4.0, 5.0), {6.0, 15.0}, {0.48, 0.32}}) {
    const std::vector<Sine> sines = {{first, 1, 0, 0.3}, {second, 0.8, 0, 1}};
    const Program program = compiling::compiled(sines[0].force() + sines[1].force());
    EXPECT_NEAR(carrier(program, "roughness"), due(sines, 0.7, 10), 0.04) << first;
    EXPECT_NEAR(carrier(program, "bumpiness"), due(sines, 10, 100), 0.04) << first;
  }
}

TEST(Bands, AFineWaveOnACoarseOneIsNoHarmonicOfIt) {
  // 2.5 mm fits 8 times into 20 mm.
  const std::vector<Sine> sines = {{2.5, 0.5, 0, 0.3}, {20, 1, 0, 1}};
  const Program program = compiling::compiled(sines[0].force() + sines[1].force());
  EXPECT_NEAR(carrier(program, "roughness"), due(sines, 0.7, 10), 0.03);
  EXPECT_NEAR(carrier(program, "bumpiness"), due(sines, 10, 100), 0.03);
}

TEST(Bands, HarmonicsCountWithTheirWave) {
  // A square wave of 30 mm has harmonics of 10 mm, 6 mm and so on, and no roughness.
  const Program square = compiling::compiled("    force = vector(if fract(x / 30 mm) < 0.5 then 1 N else -1 N, 0 N)");
  EXPECT_EQ(carrier(square, "roughness"), 0);
  EXPECT_NEAR(carrier(square, "bumpiness"), 1, 0.03);
}

TEST(Bands, ALevelIsSolvedForTheShareThatCounts) {
  // The slopes of the two heights are in these proportions.
  const double fine = 1 / 2.5, coarse = 3 / 20.0;
  const Program program = compiling::compiled(
      "    force = lateral(sin(2 * pi * x / 2.5 mm) + 3 * sin(2 * pi * x / 20 mm))", "", "roughness 0.3");
  const double needed = 194 * 10.0 / 512 * std::pow(0.3, 1 / 0.759593);
  EXPECT_NEAR(carrier(program, "roughness"), needed, 0.03 * needed);
  EXPECT_NEAR(carrier(program, "bumpiness"), needed * coarse / fine, 0.03 * needed);
  const PerceptRecord& record = program.description().percepts.front();
  EXPECT_NEAR(record.basis.share, fine / std::hypot(fine, coarse), 0.02);
  // The slider keeps meaning the level: half of it is half.
  const std::vector<float> level{0.15f};
  const Bank half(program, level, program.default_size());
  EXPECT_NEAR(carrier_of(read(half, common_modules()->declarations),
                         *common_modules()->declarations.percepts.find("roughness"), common_modules()->declarations)
                  .value_or(0),
              194 * 10.0 / 512 * std::pow(0.15, 1 / 0.759593), 0.02);
}

TEST(Bands, RoughnessAndBumpinessTogetherReadAsAsked) {
  const Program program = compiling::compiled(
      "    force fine = lateral(grating(x, period: 2.5 mm))\n    force coarse = bumps(sin(2 * pi * y / 25 mm))", "",
      "roughness 0.4; bumpiness 0.5");
  const double rough = 194 * 10.0 / 512 * std::pow(0.4, 1 / 0.759593), bumpy = 3 * std::pow(0.5, 1 / 0.76);
  EXPECT_NEAR(carrier(program, "roughness"), rough, 0.04 * rough);
  EXPECT_NEAR(carrier(program, "bumpiness"), bumpy, 0.04 * bumpy);
  EXPECT_EQ(program.description().fates[0].fate, Fate::kept);
  EXPECT_EQ(program.description().fates[1].fate, Fate::kept);
}

TEST(Bands, ATextureOfOneBandIsSolvedAsBefore) {
  const Program program = compiling::compiled("    force = lateral(grating(x, period: 2.5 mm))", "", "roughness 0.6");
  EXPECT_EQ(program.description().percepts.front().basis.share, 1);
}

}  // namespace
}  // namespace wale::bands_test
