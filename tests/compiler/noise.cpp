// The noises of schema/functions.wale against their definitions, computed in double precision from values of `lattice`.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "tests/compiler/compiling.hpp"

namespace wale::compiling::noise_test {
namespace {

// A cell is 1/1024 m wide, so that whole places, and those at multiples of 1/1024 of a cell, are exact floats of
// metres.
constexpr double cells_per_metre = 1024;

Hand at(double u, double v, double w = 0) {
  Hand hand;
  hand.position = {static_cast<float>(u / cells_per_metre), static_cast<float>(v / cells_per_metre)};
  hand.time = w;
  return hand;
}

const std::string inputs = "    let u = 1024 * (x / 1 m)\n    let v = 1024 * (y / 1 m)\n    let w = time / 1 s\n";

/// The value of a dimensionless expression of u, v and w.
class Evaluated {
 public:
  explicit Evaluated(const std::string& expression)
      : value_(compiled(inputs + "    force = vector(1 N * " + expression + ", 0 N)")) {}

  double operator()(double u, double v = 0, double w = 0) { return tick(value_, at(u, v, w)).x; }

 private:
  Bank value_;
};

/// The slope of an expression, per cell.
std::array<double, 2> slope(Bank& bank, double u, double v, double w = 0) {
  const Force force = tick(bank, at(u, v, w));
  return {force.x, force.y};
}
Bank slope_of(const std::string& expression) {
  return Bank(compiled(inputs + "    force = grad(" + expression + ") * 1 N * (1 m / 1024)"));
}

double bent(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double mixed(double a, double b, double way) { return a + way * (b - a); }

/// lattice(arguments) at whole numbers, computed once for each place.
class Lattice {
 public:
  explicit Lattice(const std::string& arguments) : corner_("lattice(" + arguments + ")") {}

  double operator()(double u, double v) {
    const auto [known, added] = values_.try_emplace({u, v}, 0);
    if (added) known->second = corner_(u, v);
    return known->second;
  }

 private:
  Evaluated corner_;
  std::map<std::pair<double, double>, double> values_;
};

double noise_by_hand(Lattice& lattice, double t) {
  const double below = std::floor(t);
  return mixed(lattice(below, 0), lattice(below + 1, 0), bent(t - below));
}
double noise2_by_hand(Lattice& lattice, double u, double v) {
  const double left = std::floor(u), below = std::floor(v), way = bent(u - left);
  return mixed(mixed(lattice(left, below), lattice(left + 1, below), way),
               mixed(lattice(left, below + 1), lattice(left + 1, below + 1), way), bent(v - below));
}
double gradient_noise_by_hand(Lattice& lattice, double u, double v) {
  const double left = std::floor(u), below = std::floor(v), way = bent(u - left);
  const auto corner = [&](int right, int up) {
    const double angle = 2 * std::numbers::pi * lattice(left + right, below + up);
    return std::cos(angle) * (u - left - right) + std::sin(angle) * (v - below - up);
  };
  return mixed(mixed(corner(0, 0), corner(1, 0), way), mixed(corner(0, 1), corner(1, 1), way), bent(v - below));
}

/// A number of cells that a float of metres holds exactly: in steps of 1/1024 of a cell.
double somewhere(std::mt19937& random) { return (static_cast<double>(random() % 120000) - 60000) / 1024; }

TEST(Noise, IsTheLatticeAtWholePlaces) {
  Evaluated one("noise(u, seed: 7)"), two("noise2(u, v, seed: 7)"), three("noise3(u, v, w, seed: 7)"),
      slopes("gradient_noise(u, v, seed: 7)");
  Evaluated line("lattice(u, 7)"), plane("lattice(u, v, 7)");
  for (int u = -60; u <= 60; u += 3)
    for (int v = -60; v <= 60; v += 5) {
      ASSERT_EQ(one(u, v), line(u));
      ASSERT_EQ(two(u, v), plane(u, v));
      ASSERT_EQ(three(u, v, 0), plane(u, v));
      ASSERT_NEAR(slopes(u, v), 0, 1e-7);
    }
  // noise3 spends 101 seeds on each layer.
  Evaluated second("lattice(u, v, 7 + 202)");
  for (int u = -60; u <= 60; ++u) ASSERT_EQ(three(u, 3, 2), second(u, 3));
}

TEST(Noise, FollowsItsDefinitionBetweenWholePlaces) {
  Evaluated one("noise(u, 4)"), two("noise2(u, v, 4)"), slopes("gradient_noise(u, v, 4)"), three("noise3(u, v, w, 4)");
  Lattice line("u, 4"), plane("u, v, 4"), layer("u, v, 4 + 303"), above("u, v, 4 + 404");
  std::mt19937 random(21);
  for (int i = 0; i < 2000; ++i) {
    const double u = somewhere(random), v = somewhere(random), w = 3 + random() % 1024 / 1024.0;
    ASSERT_NEAR(one(u), noise_by_hand(line, u), 2e-6) << u;
    ASSERT_NEAR(two(u, v), noise2_by_hand(plane, u, v), 2e-6) << u << " " << v;
    ASSERT_NEAR(slopes(u, v), gradient_noise_by_hand(plane, u, v), 4e-6) << u << " " << v;
    ASSERT_NEAR(three(u, v, w), mixed(noise2_by_hand(layer, u, v), noise2_by_hand(above, u, v), bent(w - 3)), 3e-6)
        << u << " " << v << " " << w;
  }
}

TEST(Noise, PushesByTheSlopeOfItsDefinition) {
  const double step = 1e-5;
  Lattice line("u, 0"), plane("u, v, 0");
  using Height = std::function<double(double, double)>;
  const std::vector<std::pair<std::string, Height>> cases{
      {"noise(u)", [&](double u, double) { return noise_by_hand(line, u); }},
      {"noise2(u, v)", [&](double u, double v) { return noise2_by_hand(plane, u, v); }},
      {"noise3(u, v, 0)", [&](double u, double v) { return noise2_by_hand(plane, u, v); }},
      {"gradient_noise(u, v)", [&](double u, double v) { return gradient_noise_by_hand(plane, u, v); }}};
  for (const auto& [text, height] : cases) {
    Bank bank = slope_of(text);
    std::mt19937 random(22);
    for (int i = 0; i < 500; ++i) {
      const double u = somewhere(random), v = somewhere(random);
      const auto [along, across] = slope(bank, u, v);
      // Slopes are continuous, with bounded curvature, across the edges of cells too.
      ASSERT_NEAR(along, (height(u + step, v) - height(u - step, v)) / (2 * step), 2e-4) << text << u << " " << v;
      ASSERT_NEAR(across, (height(u, v + step) - height(u, v - step)) / (2 * step), 2e-4) << text << u << " " << v;
    }
  }
}

TEST(Noise, DoesNotJumpFromCellToCell) {
  for (const char* text : {"noise(u, 2)", "noise2(u, v, 2)", "noise3(u, v, w, 2)", "gradient_noise(u, v, 2)"}) {
    Evaluated value(text);
    Bank bank = slope_of(text);
    const double step = 1.0 / 4096;
    for (int cell = -50; cell < 50; ++cell) {
      const double v = 0.37 * cell;
      // Values differ by at most the slope at the edge times the step. The slope is 0 except for gradient noise.
      const double steep = std::hypot(slope(bank, cell, v, 5)[0], slope(bank, v, cell, 5)[1]);
      ASSERT_NEAR(value(cell - step, v, 5), value(cell, v, 5), step * (steep + 0.02)) << text << cell;
      ASSERT_NEAR(value(v, cell - step, 5), value(v, cell, 5), step * (steep + 0.02)) << text << cell;
      ASSERT_NEAR(slope(bank, cell - step, v, 5)[0], slope(bank, cell, v, 5)[0], 0.02) << text << cell;
      ASSERT_NEAR(value(v, v, 5 + cell + 50 - step), value(v, v, 5 + cell + 50), step) << text << cell;
    }
  }
}

TEST(Noise, KeepsItsRangeAndUsesIt) {
  const std::vector<std::tuple<std::string, double, double>> cases{{"noise(u, 5)", 0, 1},
                                                                   {"noise2(u, v, 5)", 0, 1},
                                                                   {"noise3(u, v, w, 5)", 0, 1},
                                                                   {"gradient_noise(u, v, 5)", -0.71, 0.71}};
  for (const auto& [text, low, high] : cases) {
    Evaluated value(text);
    std::mt19937 random(23);
    double least = 1, most = -1, sum = 0;
    for (int i = 0; i < 5000; ++i) {
      const double one = value(somewhere(random), somewhere(random), random() % 64000 / 1000.0);
      least = std::min(least, one);
      most = std::max(most, one);
      sum += one / 5000;
    }
    EXPECT_GE(least, low) << text;
    EXPECT_LE(most, high) << text;
    EXPECT_LT(least, low + 0.3 * (high - low)) << text;
    EXPECT_GT(most, high - 0.3 * (high - low)) << text;
    EXPECT_NEAR(sum, (low + high) / 2, 0.06) << text;
  }
}

TEST(Noise, IsAnotherForEachSeed) {
  for (const std::string name : {"noise(u", "noise2(u, v", "noise3(u, v, w", "gradient_noise(u, v"}) {
    Evaluated first(name + ", seed: 1)"), again(name + ", seed: 1.9)"), second(name + ", seed: 2)");
    std::mt19937 random(24);
    int alike = 0;
    double first_by_second = 0, first_squared = 0, second_squared = 0;
    const double middle = name.starts_with("gradient") ? 0 : 0.5;
    for (int i = 0; i < 2000; ++i) {
      const double u = somewhere(random), v = somewhere(random), w = random() % 64000 / 1000.0;
      const double p = first(u, v, w) - middle, q = second(u, v, w) - middle;
      alike += std::abs(p - q) < 1e-3 ? 1 : 0;
      first_by_second += p * q;
      first_squared += p * p;
      second_squared += q * q;
      ASSERT_EQ(first(u, v, w), again(u, v, w)) << name;  // the fraction of a seed is dropped
    }
    EXPECT_LT(alike, 60) << name;
    // A line of 120 cells has about 100 independent values, whose correlation is about 0.1 by chance.
    EXPECT_LT(std::abs(first_by_second) / std::sqrt(first_squared * second_squared), 0.3) << name;
  }
}

}  // namespace
}  // namespace wale::compiling::noise_test
