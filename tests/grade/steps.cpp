// What a device sees of a force that jumps or turns sharply, against closed forms, for places, angles and sizes at
// random.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "compiler/grade/own_rate.hpp"
#include "tests/grade/grading.hpp"

namespace wale::grade_steps_test {
namespace {

using grading::graded;

constexpr double pi = 3.14159265358979323846;
constexpr double count = 0.2286 / 4096, tick = 1.0 / 900;  // m and s, of Minsky's joystick
constexpr double slowest = count / tick / 15;              // m/s: one count over the longest window of the filter

/// A jump somewhere, and the change of force over one count that it makes.
struct Jump {
  std::string physical;
  double newton;
};

class Jumps {
 public:
  explicit Jumps(unsigned seed) : dice_(seed) {}

  /// A force that ends along a line at any angle.
  Jump half_plane() {
    const double angle = in(0, 2 * pi), at = in(-60, 60), newton = in(0.2, 5);
    return {fmt::format("    let u = {} * x + {} * y\n    force = if u > {} mm then vector(0 N, 0 N) else {} N * "
                        "vector({}, {})",
                        std::cos(angle), std::sin(angle), at, newton, std::cos(angle), std::sin(angle)),
            newton};
  }
  /// A detent that pulls to its middle within a window.
  Jump window() {
    const double at = in(-60, 60), half = in(0.5, 15), stiffness = in(50, 500);
    const bool along_x = in(0, 1) < 0.5;
    const std::string u = along_x ? "x" : "y";
    const std::string pull =
        fmt::format("if abs({0} - {1} mm) < {2} mm then -{3} N/m * ({0} - {1} mm) else 0 N", u, at, half, stiffness);
    return {
        along_x ? fmt::format("    force = vector({}, 0 N)", pull) : fmt::format("    force = vector(0 N, {})", pull),
        1e-3 * stiffness * half};
  }
  /// A detent that pulls to a point within a disc.
  Jump disc() {
    const double x = in(-55, 55), y = in(-55, 55), radius = in(1, 20), stiffness = in(50, 400);
    return {
        fmt::format("    let away = hand - vector({} mm, {} mm)\n    force = if length(away) < {} mm then -{} N/m * "
                    "away else vector(0 N, 0 N)",
                    x, y, radius, stiffness),
        1e-3 * stiffness * radius};
  }
  /// A wall that pushes from its face on.
  Jump preload() {
    const double at = in(-60, 60), newton = in(0.3, 4), stiffness = in(100, 800);
    return {fmt::format("    force = vector(if x > {0} mm then -{1} N - {2} N/m * (x - {0} mm) else 0 N, 0 N)", at,
                        newton, stiffness),
            newton + stiffness * count};
  }
  /// Steps at the multiples of a period, along a line at any angle.
  Jump square_wave() {
    const double angle = in(0, 2 * pi), period = in(0.5, 40), newton = in(0.1, 3);
    return {fmt::format("    let u = {} * x + {} * y\n    force = {} N * (if fract(u / {} mm) < 0.37 then 1 else 0) * "
                        "vector({}, {})",
                        std::cos(angle), std::sin(angle), newton, period, std::cos(angle), std::sin(angle)),
            newton};
  }
  /// A jump beside a texture without one.
  Jump beside_texture() {
    const double at = in(-60, 60), newton = in(1, 3);
    return {
        fmt::format("    force = lateral(grating(y, period: {} mm), amplitude: 1 N) + vector(if x > {} mm then {} N "
                    "else 0 N, 0 N)",
                    in(2, 10), at, newton),
        newton};
  }
  /// A sign in another spelling.
  Jump by_sign() {
    const double at = in(-60, 60), newton = in(0.2, 3);
    return {in(0, 1) < 0.5
                ? fmt::format("    force = vector(-{} N * sign(x - {} mm), 0 N)", newton, at)
                : fmt::format("    force = vector(0 N, -{} N * (y - {} mm) / abs(y - {} mm))", newton, at, at),
            2 * newton};
  }

  Jump any(int kind) {
    switch (kind % 7) {
      case 0: return half_plane();
      case 1: return window();
      case 2: return disc();
      case 3: return preload();
      case 4: return square_wave();
      case 5: return beside_texture();
      default: return by_sign();
    }
  }
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(dice_); }

 private:
  std::mt19937 dice_;
};

TEST(Steps, EveryJumpIsFoundWithItsSize) {
  Jumps jumps(1995);
  constexpr int programs = 210;
  for (int i = 0; i < programs; ++i) {
    const Jump jump = jumps.any(i);
    const Grade grade = graded(jump.physical);
    SCOPED_TRACE(jump.physical);
    EXPECT_TRUE(grade.jumps);
    EXPECT_NEAR(grade.step_newton, jump.newton, 0.03 * jump.newton + 0.02);
    // The device sees the jump as a slope over one count: K T / 2.
    EXPECT_GE(grade.required_damping, 0.97 * (jump.newton - 0.02) / count * tick / 2);
  }
}

TEST(Steps, WhatDoesNotJumpIsNotSaidTo) {
  Jumps dice(7);
  for (int i = 0; i < 60; ++i) {
    const double at = dice.in(-50, 50), width = dice.in(1, 10), newton = dice.in(0.2, 4), angle = dice.in(0, 2 * pi);
    const std::string u = fmt::format("    let u = {} * x + {} * y\n", std::cos(angle), std::sin(angle));
    const std::string along = fmt::format("vector({}, {})", std::cos(angle), std::sin(angle));
    const std::string smooth[] = {
        fmt::format("{}    force = {} N * smoothstep((u - {} mm) / {} mm) * {}", u, newton, at, width, along),
        fmt::format("{}    force = {} N * clamp((u - {} mm) / {} mm, 0, 1) * {}", u, newton, at, width, along),
        fmt::format("{}    force = {} N * abs(fract(u / {} mm) - 0.5) * {}", u, newton, 4 * width, along),
        fmt::format("    force = firm({} N/m, face: {} mm)", 100 * newton, at),
        fmt::format("    force = lateral(grating(x, period: {} mm), amplitude: {} N)", width, newton),
        fmt::format("{}    force = if u > {} mm then -{} N/m * (u - {} mm) * {} else vector(0 N, 0 N)", u, at,
                    100 * newton, at, along)};
    for (const std::string& physical : smooth) {
      SCOPED_TRACE(physical);
      EXPECT_FALSE(graded(physical).jumps);
    }
  }
}

// Between two counts a sine of amplitude A changes by 2 A sin(pi count / period) at most, however steep it is.
TEST(Steps, AreNoLargerThanTheForceAllows) {
  for (const double period : {0.12, 0.15, 0.3, 0.9, 4.0, 30.0}) {
    const Grade grade = graded(fmt::format("    force = vector(0.3 N * sin(2 pi * x / {} mm), 0 N)", period));
    const double most = 0.6 * std::sin(pi * count / (1e-3 * period));
    EXPECT_NEAR(grade.step_newton, most, 0.005 * most) << period;
  }
}

/// A force that changes smoothly, and perhaps within far less than one count, along one direction: `shape` of u.
struct Shape {
  const char* formula;             ///< of u and the width w
  double (*value)(double u_by_w);  ///< the same
};

constexpr Shape shapes[] = {
    {"(1 + tanh(u / w))", [](double u) { return 1 + std::tanh(u); }},
    {"atan(u / w) / (90 deg)", [](double u) { return std::atan(u) / (pi / 2); }},
    {"clamp(u / w, 0, 1)", [](double u) { return std::clamp(u, 0.0, 1.0); }},
    {"smoothstep(u / w)",
     [](double u) {
       const double t = std::clamp(u, 0.0, 1.0);
       return t * t * (3 - 2 * t);
     }},
    {"normal(u / w)", [](double u) { return 0.5 * std::erfc(-u / std::sqrt(2.0)); }},
    {"1 / (1 + exp(-u / w))", [](double u) { return 1 / (1 + std::exp(-u)); }},
    {"exp(-(u / w)^2)", [](double u) { return std::exp(-u * u); }},
    {"max(0, 1 - abs(u / w))", [](double u) { return std::max(0.0, 1 - std::abs(u)); }},
};

/// The largest change of a shape over a distance, by trying places; both by the width.
double largest_change(const Shape& shape, double distance) {
  double largest = 0;
  const double reach = 3 + distance;
  for (int i = 0; i <= 20000; ++i) {
    const double from = -reach + 2 * reach * i / 20000;
    largest = std::max(largest, std::abs(shape.value(from + distance) - shape.value(from)));
  }
  return largest;
}

// The loop sees the change over one count, not the slope: a step as steep as a jump needs as much damping as one.
TEST(Steps, SteepSmoothStepsAreFoundWithTheirSizes) {
  Jumps dice(31);
  for (int i = 0; i < 160; ++i) {
    const Shape& shape = shapes[i % std::size(shapes)];
    const bool returns = shape.value(-100) == shape.value(100);  // a spike; far below one count it is never met
    const double narrowest = returns ? 2 : 0.3;
    const double width = 1e-6 * std::exp(dice.in(std::log(narrowest), std::log(300.0))), newton = dice.in(0.5, 5);
    const double angle = dice.in(0, 2 * pi), at = dice.in(-55, 55), radius = dice.in(2, 20);
    // A disc's middle must be without force, since its direction turns there.
    const bool disc = i / std::size(shapes) % 2 == 1 && shape.value(-100) == 0;
    const std::string along =
        disc ? "away / length(away)" : fmt::format("vector({}, {})", std::cos(angle), std::sin(angle));
    const std::string distance =
        disc ? fmt::format("    let away = hand - vector({} mm, {} mm)\n    let u = length(away) - {} mm\n", at,
                           dice.in(-55, 55), radius)
             : fmt::format("    let u = {} * x + {} * y - {} mm\n", std::cos(angle), std::sin(angle), at);
    const std::string physical = fmt::format("{}    let w = {} um\n    force = {} N * {} * {}", distance, 1e6 * width,
                                             newton, shape.formula, along);
    // A count along x or y is a shorter way along u.
    const double way = disc ? count : count * std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    const double change = newton * largest_change(shape, way / width);
    SCOPED_TRACE(physical);
    const Grade grade = graded(physical);
    EXPECT_NEAR(grade.step_newton, change, 0.05 * change + 0.02);
    EXPECT_GE(grade.required_damping, 0.95 * (change - 0.02) / count * tick / 2);
  }
}

// A jump that comes late is a jump, whether the place is remembered or the force.
TEST(Steps, JumpsThroughMemoryAreFound) {
  Jumps dice(17);
  for (int i = 0; i < 60; ++i) {
    const double newton = dice.in(0.3, 5), angle = dice.in(0, 2 * pi), at = dice.in(-30, 30);
    const std::string u = fmt::format("    let u = {} * x + {} * y\n", std::cos(angle), std::sin(angle));
    const std::string along = fmt::format("vector({}, {})", std::cos(angle), std::sin(angle));
    const std::string late[] = {
        fmt::format("{}    state old: length = 0 mm in -200 mm .. 200 mm\n    next old = u\n    force = if old > {} mm "
                    "then {} N * {} else vector(0 N, 0 N)",
                    u, at, newton, along),
        fmt::format(
            "{}    state old: length = 0 mm in -200 mm .. 200 mm\n    state older: length = 0 mm in -200 mm .. "
            "200 mm\n    next old = u\n    next older = old\n    force = {} N * clamp((older - {} mm) / 0.3 um, "
            "0, 1) * {}",
            u, newton, at, along),
        fmt::format(
            "{}    state slow: length = 0 mm in -200 mm .. 200 mm\n    next slow = slow + 0.3 * (u - slow)\n    "
            "force = if slow > {} mm then {} N * {} else vector(0 N, 0 N)",
            u, at, newton, along),
        fmt::format("{}    state pushed: force = 0 N in -10 N .. 10 N\n    next pushed = if u > {} mm then {} N else 0 "
                    "N\n    force = pushed * {}",
                    u, at, newton, along)};
    const std::string& physical = late[i % std::size(late)];
    SCOPED_TRACE(physical);
    const Grade grade = graded(physical);
    EXPECT_TRUE(grade.jumps);
    EXPECT_NEAR(grade.step_newton, newton, 0.03 * newton + 0.02);
    EXPECT_GE(grade.required_damping, 0.97 * (newton - 0.02) / count * tick / 2);
    EXPECT_NE(grade.standing, Standing::passive);
  }
}

TEST(Steps, MemoryWithoutJumpsIsNotSaidToJump) {
  for (const char* physical :
       {"    force = sticky(1 N)",
        "    state slow: length = 0 mm in -200 mm .. 200 mm\n    next slow = slow + 0.3 * (x - slow)\n    force = "
        "vector(-300 N/m * slow, 0 N)",
        "    state slow: length = 0 mm in -200 mm .. 200 mm\n    next slow = slow + 0.3 * (x - slow)\n    force = "
        "vector(2 N * tanh((slow - 7 mm) / 2 mm), 0 N)",
        "    state slow: length = 0 mm in -200 mm .. 200 mm\n    next slow = slow + 0.3 * (x - slow)\n    force = "
        "vector(-1 N * sign(velocity.x) - 10 N/m * slow, 0 N)",
        "    active 2 W\n    force = vector((if fract(phase(3 Hz)) < 0.5 then 1 N else 0 N), 0 N)"}) {
    const Grade grade = graded(physical);
    EXPECT_FALSE(grade.jumps) << physical;
    EXPECT_LT(grade.step_newton, 0.2) << physical;
  }
}

// Hands one count apart feel no more than a spring's slope over one count.
TEST(Steps, MemoryDoesNotMakeASpringStiffer) {
  const Grade grade = graded(
      "    state slow: length = 0 mm in -200 mm .. 200 mm\n    next slow = slow + 0.3 * (x - slow)\n    force = "
      "vector(-150 N/m * x - 0.001 N/m * slow, 0 N)");
  EXPECT_NEAR(grade.step_newton, 150 * count, 0.002 * 150 * count);
}

// Where `floor(x + 1)` rounds up before `floor(x)` does, a noise has a spike a nanometre wide, which no hand meets.
TEST(Steps, RoundingOnALatticeIsNoStep) {
  const std::string layer =
      "    let u = x / 3.7 mm\n    let v = y / 3.7 mm\n    let f = mix(mix(lattice(u, v, 0), lattice(u + 1, v, 0), "
      "smoothstep(fract(u))), mix(lattice(u, v + 1, 0), lattice(u + 1, v + 1, 0), smoothstep(fract(u))), "
      "smoothstep(fract(v)))\n";
  // The value itself changes by 1.5 over a cell's side at most, along one axis.
  const Grade grade = graded(layer + "    force = vector(4 N * f, 0 N)");
  EXPECT_LE(grade.step_newton, 4 * 1.5 * count / 3.7e-3 * 1.01);
  EXPECT_FALSE(grade.jumps);
}

TEST(Steps, PolesNeedTheDampingOfTheLimit) {
  // From -10 N to 10 N in one count.
  const double most = 20 / count * tick / 2;
  for (const char* force : {"vector(1 N * tan(x / 1 mm), 0 N)", "vector(1 mJ / (x - 3.3 mm), 0 N)",
                            "vector(0 N, -1000 N/mm * (y + 17.77 mm))", "-1000 N/mm * hand"})
    EXPECT_NEAR(graded(fmt::format("    force = {}", force)).required_damping, most, 0.02 * most) << force;
}

/// The damping that a material needs.
double needed(const std::string& force) { return graded("    force = " + force).required_damping; }

// Dry friction of 1 N turns its force by 2 N over the smallest velocity that the device tells from 0.
TEST(Steps, DryFrictionNeedsTheSameDampingInEverySpelling) {
  const double steepest = 2 / slowest;  // N s/m
  const double one = needed("vector(-1 N * sign(velocity.x), 0 N)");
  EXPECT_GT(one, 0.2 * steepest);
  EXPECT_LE(one, 1.01 * steepest);
  for (const char* spelling :
       {"-1 N * normalise(velocity)", "vector(-1 N * sign(velocity.x), -1 N * sign(velocity.y))",
        "vector(if velocity.x > 0 mm/s then -1 N else 1 N, 0 N)",
        "vector(if velocity.x > 0 mm/s then -1 N else if velocity.x < 0 mm/s then 1 N else 0 N, 0 N)",
        "vector(0 N, -1 N * velocity.y / max(abs(velocity.y), 0.001 mm/s))",
        "vector(-1 N * velocity.x / abs(velocity.x), 0 N)", "vector(-1 N * tanh(velocity.x / 0.01 mm/s), 0 N)",
        "vector(-1 N * clamp(velocity.x / 0.02 mm/s, -1, 1), 0 N)"})
    EXPECT_NEAR(needed(spelling), one, 0.02 * one) << spelling;
}

TEST(Steps, SharperFrictionNeedsMoreUpToThatOfASign) {
  const double most = needed("vector(-1 N * sign(velocity.x), 0 N)");
  double before = 0;
  for (const double width : {50.0, 20.0, 5.0, 1.0, 0.2, 0.05}) {
    const double now = needed(fmt::format("vector(-1 N * tanh(velocity.x / {} mm/s), 0 N)", width));
    EXPECT_GE(now, 0.999 * before) << width;
    EXPECT_LE(now, 1.01 * most) << width;
    before = now;
  }
  EXPECT_NEAR(needed("vector(-1 N * tanh(velocity.x / 20 mm/s), 0 N)"), 50, 0.5);
}

TEST(Steps, FrictionWithinAWindowIsFound) {
  const double everywhere = needed("vector(-1 N * sign(velocity.x), 0 N)");
  EXPECT_NEAR(needed("vector(if abs(x - 31 mm) < 4 mm then -1 N * sign(velocity.x) else 0 N, 0 N)"), everywhere,
              0.02 * everywhere + 0.01);
}

// On a circle of radius r around a crest of the curl, F sin(2 pi x / L) along y gains F r 2 pi J1(2 pi r / L) a turn,
// at the speed v so many watt as F v J1; the largest J1 is 0.5819.
TEST(Circles, GainTheEnergyOfACurlOfShortWaves) {
  const double speed = 2 * pi * grading::hand.radius * grading::hand.frequency;
  for (const double period : {2.0, 4.0, 9.0, 20.0, 60.0})
    for (const double newton : {0.3, 2.0}) {
      const Grade grade = graded(fmt::format("    force = vector(0 N, {} N * sin(2 pi * x / {} mm))", newton, period));
      EXPECT_FALSE(grade.energy.conservative) << newton << " N, " << period << " mm";
      EXPECT_NEAR(grade.energy.watt(), newton * speed * 0.5819, 0.06 * newton * speed) << newton << " N, " << period;
      EXPECT_EQ(grade.standing, Standing::active);
    }
}

TEST(Circles, AJumpAlongWhichTheForcePushesGivesEnergy) {
  const Grade along = graded("    force = vector(0 N, if x > 13.7 mm then 1 N else 0 N)");
  EXPECT_FALSE(along.energy.conservative);
  const Grade across = graded("    force = vector(if x > 13.7 mm then 1 N else 0 N, 0 N)");
  EXPECT_TRUE(across.energy.conservative);
}

TEST(Circles, PotentialsOfShortWavesGainNothing) {
  for (const char* physical :
       {"    height h = noise2(x / 2 mm, y / 2 mm)\n    force = lateral(h, amplitude: 2 N)",
        "    height h = grating(x, period: 1 mm) + grating(y, period: 1.3 mm)\n    force = lateral(h, amplitude: 3 N)",
        "    force = vector(1 N * sin(2 pi * x / 0.5 mm), 0 N)",
        "    let away = hand - vector(10 mm, 3 mm)\n    force = if length(away) < 6 mm then -300 N/m * away else "
        "vector(0 N, 0 N)"})
    EXPECT_TRUE(graded(physical).energy.conservative) << physical;
}

TEST(OwnRate, IsThatOfTheFormula) {
  const auto rate = [](const std::string& wave) {
    return fastest_own_rate(Bank(compiling::compiled("    active 2 W\n    force = vector(0.2 N * " + wave + ", 0 N)")));
  };
  EXPECT_NEAR(rate("sin(2 pi * 600 Hz * time)"), 600, 0.01);
  EXPECT_NEAR(rate("cos(2 pi * phase(37 Hz))"), 37, 0.01);
  EXPECT_NEAR(rate("(fract(time * 250 Hz) - 0.5)"), 250, 0.01);
  EXPECT_EQ(rate("sin(2 pi * x / 4 mm)"), 0);
}

// sin(2 pi f k / n) for whole k, by hand.
TEST(OwnRate, FoldsAtHalfOfTheSamples) {
  EXPECT_DOUBLE_EQ(rate_when_sampled(440, 900), 440);
  EXPECT_DOUBLE_EQ(rate_when_sampled(600, 900), 300);
  EXPECT_DOUBLE_EQ(rate_when_sampled(900, 900), 0);
  EXPECT_DOUBLE_EQ(rate_when_sampled(1000, 900), 100);
  EXPECT_DOUBLE_EQ(rate_when_sampled(1250, 900), 350);
}

}  // namespace
}  // namespace wale::grade_steps_test
