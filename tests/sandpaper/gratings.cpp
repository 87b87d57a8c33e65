// Gratings, grids and the version-2 seed against sampled arrays smoothed by a sampled Gaussian, as in the thesis.
#include <cmath>
#include <set>

#include "tests/sandpaper/reading.hpp"

namespace wale::sandpaper::gratings_test {
namespace {

constexpr double pixel = 0.37e-3;

/// A rectangle wave of `valley` and `hill` pixels, with the middle of a hill at 0.
double square_wave(double along, double valley, double hill) {
  const double period = valley + hill, rest = along - period * std::round(along / period);
  return std::abs(rest) < hill / 2 ? 1 : 0;
}

/// The wave smoothed by a Gaussian of standard deviation `kernel`, summed in small steps.
double smoothed_wave(double along, double valley, double hill, double kernel) {
  double sum = 0, weights = 0;
  const int steps = 6000;
  for (int i = -steps; i < steps; ++i) {
    const double t = 7 * kernel * (i + 0.5) / steps, weight = std::exp(-t * t / (2 * kernel * kernel));
    sum += weight * square_wave(along - t, valley, hill);
    weights += weight;
  }
  return sum / weights;
}

/// The value of a plain expression of the place, as the force along x in N.
class Probe {
 public:
  Probe(const std::string& imports, const std::string& function)
      : program_(Module("probe.wale", "wale 1\n" + imports +
                                          "\nmaterial probe { physical { patch 220 mm, 220 mm; active 2 W; " +
                                          "force = vector(1 N * (" + function + "), 0 N) } }\n")
                     .program("probe")),
        bank_(program_) {}
  double operator()(double x, double y = 0) {
    Hand hand;
    hand.position = {x, y};
    return tick(bank_, hand).x;
  }

 private:
  Program program_;
  Bank bank_;
};

const std::string imports = "import sandpaper.gratings\n";

TEST(Gratings, BarsAreASmoothedRectangleWave) {
  std::mt19937 random(1);
  for (const auto& [valley, hill, kernel] : {std::tuple{5, 10, 1}, std::tuple{15, 5, 2}, std::tuple{20, 20, 4}}) {
    Probe bars(imports, "bars(x, " + std::to_string(valley) + " pixels, " + std::to_string(hill) + " pixels, " +
                            std::to_string(kernel) + " pixels)");
    for (int i = 0; i < 100; ++i) {
      const double x = uniform(random, 0.1);
      EXPECT_NEAR(bars(x), smoothed_wave(x / pixel, valley, hill, kernel), 1e-3) << valley << " " << hill << " " << x;
    }
  }
}

TEST(Gratings, GridsAreSmoothedPlateausInRowsThatMayBeShifted) {
  Probe grid(imports, "grid(10 pixels, 5 pixels, 1 pixels)");
  Probe offset(imports, "offset_grid(5 pixels, 5 pixels, 1 pixels, 5 pixels)");
  Probe brickwork(imports, "offset_grid(10 pixels, 5 pixels, 1 pixels, 4 pixels)");
  Probe checkerboard(imports, "checkerboard(5 pixels, 5 pixels, 1 pixels)");
  // A plateau is where both waves are high. Every second row of plateaus is shifted to the right.
  const auto plateau = [](double u, double v, double valley, double hill, double shift) {
    const double row = std::round(v / (valley + hill));
    return square_wave(v, valley, hill) * square_wave(std::fmod(std::abs(row), 2) == 1 ? u - shift : u, valley, hill);
  };
  const auto smoothed = [&](const auto& height, double u, double v) {
    double sum = 0, weights = 0;
    const int steps = 160;
    for (int i = -steps; i < steps; ++i) {
      for (int j = -steps; j < steps; ++j) {
        const double s = 4.5 * (i + 0.5) / steps, t = 4.5 * (j + 0.5) / steps, weight = std::exp(-(s * s + t * t) / 2);
        sum += weight * height(u - s, v - t);
        weights += weight;
      }
    }
    return sum / weights;
  };
  std::mt19937 random(2);
  for (int i = 0; i < 60; ++i) {
    const double x = uniform(random, 0.1), y = uniform(random, 0.1), u = x / pixel, v = y / pixel;
    EXPECT_NEAR(grid(x, y), smoothed([&](double s, double t) { return plateau(s, t, 10, 5, 0); }, u, v), 0.02);
    EXPECT_NEAR(offset(x, y), smoothed([&](double s, double t) { return plateau(s, t, 5, 5, 5); }, u, v), 0.02);
    EXPECT_NEAR(brickwork(x, y), smoothed([&](double s, double t) { return plateau(s, t, 10, 5, 4); }, u, v), 0.02);
    const auto squares = [](double s, double t) { return square_wave(s, 5, 5) != square_wave(t, 5, 5) ? 1.0 : 0.0; };
    EXPECT_NEAR(checkerboard(x, y), smoothed(squares, u, v), 0.02);
  }
}

/// The version-2 seed of the thesis: 256 samples, 128 of them a hill, smoothed circularly by a sampled Gaussian. The
/// first sample is right of the hill's middle.
std::vector<double> seed() {
  std::vector<double> smooth(256);
  double weights = 0;
  for (int t = -128; t <= 128; ++t) weights += std::exp(-t * t / (2.0 * 24 * 24));
  for (int i = 0; i < 256; ++i)
    for (int t = -128; t <= 128; ++t) {
      const int from = ((i - t) % 256 + 256) % 256;
      smooth[i] += (from < 64 || from >= 192 ? 1 : 0) * std::exp(-t * t / (2.0 * 24 * 24)) / weights;
    }
  return smooth;
}

TEST(Gratings, TheSeedIsTheThesisSArrayAtEveryPeriod) {
  const auto array = seed();
  for (const char* period : {"0.7", "0.9", "1.2", "1.8", "2.5", "3.7", "5.0", "7.5", "10.0"}) {
    Probe probe(imports, "seed(x, " + std::string(period) + " mm)");
    const double length = std::stod(period) * 1e-3;
    for (int i = 0; i < 256; ++i)
      for (const int repeat : {-3, 0, 2})
        ASSERT_NEAR(probe(((i + 0.5) / 256 + repeat) * length), array[i], 1e-3) << period << " sample " << i;
  }
}

TEST(Gratings, TheSeedInEightBitsHasFiveLevelsOfForceTwentyPercentApart) {
  const std::string text =
      "wale 1\n" + imports + "material displayed { physical { force = vector(seed_force(x, 2.56 mm, 5 N), 0 N) } }\n" +
      "material sample { physical { force = vector(1 N / 255 * seed_sample(x / 0.1 mm), 0 N) } }\n";
  Module module("probe.wale", text);
  const Program displayed = module.program("displayed"), sample = module.program("sample");
  Bank force(displayed), height(sample);
  const auto along = [](Bank& bank, double x) {
    Hand hand;
    hand.position = {x, 0};
    return static_cast<double>(tick(bank, hand).x);
  };
  std::vector<long> grey;
  for (int i = 0; i <= 256; ++i) grey.push_back(std::lround(255 * along(height, i * 1e-4)));
  EXPECT_EQ(grey[0], 253);  // 255 (2 Normal(64 / 24) - 1): the hill is too narrow for its full height
  EXPECT_EQ(grey[64], 128);
  EXPECT_EQ(grey[128], 2);
  std::set<long> levels;
  for (int i = 0; i < 256; ++i) {
    const double now = along(force, (i + 0.5) * 1e-5);
    EXPECT_NEAR(now, -static_cast<double>(grey[i + 1] - grey[i]), 1e-4) << i;
    levels.insert(std::lround(std::abs(now)));
  }
  EXPECT_EQ(levels, (std::set<long>{0, 1, 2, 3, 4, 5}));
}

TEST(Gratings, VersionTwoPushesDownhillWithItsAmplitudeAtMost) {
  Module module("textures_version2.wale");
  const Program program = module.program("Version2");
  const auto array = seed();
  double steepest = 0;
  for (int i = 0; i < 256; ++i) steepest = std::max(steepest, std::abs(array[(i + 1) % 256] - array[i]));
  std::mt19937 random(4);
  for (int each = 0; each < 12; ++each) {
    const Parameters q = random_parameters(program, random);
    Bank bank = bank_with(program, q);
    for (int i = 0; i < 256; ++i) {  // between samples i and i + 1
      Hand hand;
      hand.position = {static_cast<float>((i + 1.0) / 256 * q.at("period")), 0};
      EXPECT_NEAR(tick(bank, hand).x, -q.at("amplitude") * (array[(i + 1) % 256] - array[i]) / steepest,
                  0.012 * q.at("amplitude"));
    }
  }
}

/// The largest forward difference, in grey levels, of a sampled grating smoothed by a sampled Gaussian.
double largest_difference(int valley, int hill, double kernel) {
  double largest = 0;
  std::vector<double> wave(512);
  for (int i = 0; i < 512; ++i) wave[i] = i % (valley + hill) < hill ? 255 : 0;
  const auto smoothed = [&](int i) {
    double sum = 0, weights = 0;
    for (int t = -40; t <= 40; ++t) {
      const double weight = std::exp(-t * t / (2 * kernel * kernel));
      sum += weight * wave[i - t];
      weights += weight;
    }
    return sum / weights;
  };
  for (int i = 100; i < 400; ++i) largest = std::max(largest, std::abs(smoothed(i + 1) - smoothed(i)));
  return largest;
}

TEST(Gratings, StimuliPushHalfAProgramUnitForEachGreyLevelOfTheirMap) {
  Module module("chapter4.wale");
  constexpr double pu = 10.0 / 512;
  const auto largest_force = [&](const std::string& material) {
    const Program program = module.program(material);
    Bank bank(program);
    double largest = 0;
    for (int i = -4000; i <= 4000; ++i) {
      Hand hand;
      hand.position = {static_cast<float>(i * 1e-5), 0};
      largest = std::max(largest, std::abs(static_cast<double>(tick(bank, hand).x)));
    }
    return largest;
  };
  for (const auto& [name, valley, hill, kernel] :
       {std::tuple{"barsB5W5_1", 5, 5, 1}, std::tuple{"barsB5W15_1", 5, 15, 1}, std::tuple{"barsB10W30_2", 10, 30, 2},
        std::tuple{"barsB15W5_2", 15, 5, 2}, std::tuple{"barsB20W20_4", 20, 20, 4},
        std::tuple{"barsB15W15_4", 15, 15, 4}, std::tuple{"barsB12W13_2", 12, 13, 2}})
    EXPECT_NEAR(largest_force(name) / pu, largest_difference(valley, hill, kernel) / 2,
                0.05 * largest_difference(valley, hill, kernel) / 2)
        << name;
  const double usual = largest_force("barsB5W5_1");
  EXPECT_NEAR(largest_force("barsB5W5_1Fless") / usual, 1 / 1.5, 0.01);
  EXPECT_NEAR(largest_force("barsB5W5_1Fmore") / usual, 1.5, 0.01);
  EXPECT_NEAR(largest_force("barsB5W5_1Fmost") / usual, 2.25, 0.01);
}

}  // namespace
}  // namespace wale::sandpaper::gratings_test
