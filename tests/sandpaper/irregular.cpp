// The irregular textures: Perlin's value noise against its formula, the fractal's spectrum, and noise.
#include <cmath>
#include <complex>

#include "tests/sandpaper/reading.hpp"

namespace wale::sandpaper::irregular_test {
namespace {

/// A program whose force components are two plain expressions, in N.
Program probe(const std::string& imports, const std::string& along_x, const std::string& along_y) {
  return Module("probe.wale", "wale 1\n" + imports +
                                  "\nmaterial probe { physical { patch 220 mm, 220 mm; active 2 W; force = " +
                                  "vector(1 N * (" + along_x + "), 1 N * (" + along_y + ")) } }\n")
      .program("probe");
}

Pair at(Bank& bank, double x, double y) {
  Hand hand;
  hand.position = {x, y};
  const Force force = tick(bank, hand);
  return {force.x, force.y};
}

double smooth(double t) { return 3 * t * t - 2 * t * t * t; }

TEST(Perlin, IsTricubicBetweenTheControlPointsAtHalfHeight) {
  for (const int pattern : {0, 3}) {
    // The control values of the two layers at whole millimetres.
    const Program lattice = probe("", "lattice(x / 1 mm, y / 1 mm, " + std::to_string(2 * pattern) + ")",
                                  "lattice(x / 1 mm, y / 1 mm, " + std::to_string(2 * pattern + 1) + ")");
    const Program density =
        probe("import sandpaper.perlin\n", "perlin_density(x / 1 mm, y / 1 mm, " + std::to_string(pattern) + ")",
              "perlin(1 mm, " + std::to_string(pattern) + ")");
    Bank control(lattice), noise(density);
    std::mt19937 random(6);
    for (int i = 0; i < 400; ++i) {
      const double u = uniform(random, 80), v = uniform(random, 80), column = std::floor(u), row = std::floor(v);
      double expected = 0;
      for (const int right : {0, 1}) {
        for (const int up : {0, 1}) {
          // Half a cell inside, so that rounding picks the right control point.
          const Pair layers = at(control, (column + right + 0.5) * 1e-3, (row + up + 0.5) * 1e-3);
          const double s = smooth(u - column), t = smooth(v - row);
          expected += (right ? s : 1 - s) * (up ? t : 1 - t) * (0.5 * layers.x + 0.5 * layers.y);
        }
      }
      const Pair found = at(noise, u * 1e-3, v * 1e-3);
      ASSERT_NEAR(found.x, expected, 1e-4) << u << " " << v;
      ASSERT_NEAR(found.y, expected - 0.5, 1e-4) << u << " " << v;
    }
  }
}

TEST(Perlin, AllSizesAreOnePatternWithForcesInProportionToTheSlope) {
  Module module("chapter4.wale");
  const auto p99 = [&](const std::string& name) {
    const Program program = module.program(name);
    Bank bank(program);
    std::vector<double> sizes;
    for (int i = -40; i <= 40; ++i)
      for (int j = -40; j <= 40; ++j) sizes.push_back(size(at(bank, i * 1e-3, j * 1e-3)));
    std::ranges::sort(sizes);
    return sizes[sizes.size() * 99 / 100] * 512 / 10;  // program units
  };
  for (const int feature : {5, 10, 20, 50})
    EXPECT_NEAR(p99("perlin" + std::to_string(feature)), 450.0 / feature, 0.03 * 450.0 / feature);
  EXPECT_NEAR(p99("perlin2"), 120, 3);  // 225, limited to the end of the thesis's axes
  EXPECT_NEAR(p99("perlin30Fless"), 10, 0.3);

  const Program small = probe("import sandpaper.perlin\n", "perlin(2 mm)", "perlin(20 mm)");
  Bank bank(small);
  for (int i = -10; i < 10; ++i) EXPECT_NEAR(at(bank, i * 1e-3, 2.3e-3).x, at(bank, i * 1e-2, 2.3e-2).y, 1e-4);
}

TEST(Fractal, PowerFallsWithFrequencyBySlope) {
  for (const double slope : {2.0, 3.0}) {
    // The octaves are 0.25 to 32 mm: lines of 204.8 mm with 2048 samples and a Hann window against leakage.
    const Program program =
        probe("import sandpaper.fractal\n", "fractal(x / 32 mm, y / 32 mm, " + std::to_string(slope) + ")", "0");
    Bank bank(program);
    constexpr int samples = 2048;
    std::vector<double> power(513);
    std::vector<Hand> hands(samples);
    std::vector<Force> heights(samples);
    for (int line = 0; line < 24; ++line) {
      for (int i = 0; i < samples; ++i) hands[i].position = {(i - samples / 2) * 1e-4f, (line - 12) * 9.1e-3f};
      tick_all(bank, hands, heights);
      for (int f = 8; f <= 256; ++f) {
        std::complex<double> sum = 0;
        const std::complex<double> turn = std::polar(1.0, 2 * M_PI * f / samples);
        std::complex<double> wave = 1;
        for (int i = 0; i < samples; ++i, wave *= turn)
          sum += (0.5 - 0.5 * std::cos(2 * M_PI * i / samples)) * static_cast<double>(heights[i].x) * wave;
        power[f] += std::norm(sum);
      }
    }
    // A straight line through the logarithms of the power in bands one octave wide.
    double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
    for (int band = 8; band < 256; band *= 2) {
      double mean = 0;
      for (int f = band; f < 2 * band; ++f) mean += power[f] / band;
      const double x = std::log(band * 1.5), y = std::log(mean);
      sx += x, sy += y, sxx += x * x, sxy += x * y, n += 1;
    }
    const double fitted = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    EXPECT_NEAR(fitted, -slope, 0.3) << slope;
  }
}

TEST(Noise, JumpsFromPixelToPixelWithinItsLargestForce) {
  Module module("chapter4.wale");
  for (const int level : {20, 35, 50}) {
    const Program program = module.program("Noise" + std::to_string(level));
    Bank bank(program);
    double largest = 0, mean = 0, within = 0;
    int counted = 0;
    for (int i = -100; i < 100; ++i) {
      for (int j = -100; j < 100; ++j) {
        const Pair here = at(bank, (i + 0.3) * 0.37e-3, (j + 0.4) * 0.37e-3);
        const Pair beside = at(bank, (i + 0.8) * 0.37e-3, (j + 0.6) * 0.37e-3);
        within = std::max(within, size(here - beside));
        largest = std::max({largest, std::abs(here.x), std::abs(here.y)});
        mean += here.x + here.y;
        ++counted;
      }
    }
    const double pu = 10.0 / 512;
    EXPECT_EQ(within, 0) << "one force in all of a pixel";
    EXPECT_LE(largest, level * pu);
    EXPECT_GT(largest, 0.95 * level * pu);
    EXPECT_NEAR(mean / counted, 0, 0.01 * level * pu);
  }
}

// On a rectangle through the middles of two pixels side by side, the two legs along x cross the same forces and cancel.
// The legs along y lie each within one pixel, so a turn gains their length times the difference of both forces.
TEST(Noise, AClosedPathAcrossTwoPixelsGainsTheEnergyThatIsDeclared) {
  const std::pair<const char*, const char*> materials[] = {{"chapter4.wale", "Noise20"},
                                                           {"chapter4.wale", "Noise35"},
                                                           {"chapter4.wale", "Noise50"},
                                                           {"appendix_a.wale", "noise_map"},
                                                           {"jitter.wale", "Noise"}};
  constexpr double pixel = 0.37e-3, least_declared = 0.01;
  constexpr double pace = 0.25;  // m/s, of the hand by which a material's energy is judged
  for (const auto& [file, name] : materials) {
    const Program program = Module(file).program(name);
    ASSERT_GT(program.description().active_watt, 0) << name;
    Bank bank(program);
    double most = 0;
    for (int i = -80; i < 80; ++i) {
      const double left = (i + 0.5) * pixel, right = left + pixel, low = 0.1 * pixel, high = 0.9 * pixel;
      double joule = 0;
      constexpr int parts = 100;
      for (int part = 0; part < parts; ++part) {
        const double x = left + (part + 0.5) / parts * (right - left), y = low + (part + 0.5) / parts * (high - low);
        joule += (at(bank, x, low).x - at(bank, x, high).x) * (right - left) / parts;
        joule += (at(bank, right, y).y - at(bank, left, y).y) * (high - low) / parts;
      }
      const double expected = (at(bank, right, low).y - at(bank, left, low).y) * (high - low);
      ASSERT_NEAR(joule, expected, 1e-8) << name << ", pixel " << i;
      most = std::max(most, std::abs(joule) * pace / (2 * (right - left + high - low)));
    }
    EXPECT_GT(most, least_declared) << name;
  }
}

}  // namespace
}  // namespace wale::sandpaper::irregular_test
