// The dynamic modules against Newton's laws in double precision, and their energy.
#include <cmath>
#include <functional>

#include "tests/sandpaper/reading.hpp"

namespace wale::sandpaper::dynamics_test {
namespace {

constexpr double dt = 1.0 / 900;

/// A body that moves by semi-implicit Euler.
struct Body {
  Pair p, v;
  void pushed(Pair force, double mass) {
    v = v + (dt / mass) * force;
    p = p + dt * v;
  }
};

/// A path over the patch (m), rounded to floats.
Pair wandering(int i) {
  const double t = i * dt;
  return {static_cast<float>(0.03 * std::sin(4.1 * t) + 0.02 * std::sin(11 * t)),
          static_cast<float>(0.04 * std::cos(3.3 * t) - 0.01 * std::sin(17 * t))};
}

/// Runs a module and its model along the same path of the hand, and expects equal forces. The model returns its force
/// for a hand and then advances one tick.
void expect_alike(const std::string& material, const Parameters& parameters, int ticks, double tolerance,
                  const std::function<Pair(int, Pair)>& model, const std::function<Pair(int)>& path = wandering) {
  Module module("dynamics.wale");
  const Program program = module.program(material);
  Bank bank = bank_with(program, parameters);
  Memory memory(program);
  Hand hand;
  double largest = 0;
  for (int i = 0; i < ticks; ++i) {
    const Pair at = path(i);
    hand.position = {at.x, at.y};
    hand.time = i * dt;
    if (i == 0) memory.enter(bank, hand);
    const Force force = tick(bank, memory, hand);
    const Pair free = model(i, at);
    const Pair expected{std::clamp(free.x, -10.0, 10.0), std::clamp(free.y, -10.0, 10.0)};  // the device's limit
    largest = std::max(largest, size(expected));
    ASSERT_NEAR(force.x, expected.x, tolerance) << material << " tick " << i;
    ASSERT_NEAR(force.y, expected.y, tolerance) << material << " tick " << i;
  }
  EXPECT_GT(largest, 100 * tolerance) << "the forces are too small for the tolerance";
}

TEST(Dynamics, OneMassFollowsItsRecurrence) {
  for (const auto& [m, k, b] : {std::tuple{0.3, 80.0, 0.4}, std::tuple{0.05, 400.0, 0.0}, std::tuple{2.0, 10.0, 5.0}}) {
    Body body{wandering(0), {}};
    expect_alike("OneMass", {{"mass", m}, {"k", k}, {"b", b}}, 3000, 2e-3, [&](int, Pair hand) {
      const Pair pull = k * (hand - body.p);
      body.pushed(pull - b * body.v, m);
      return -1.0 * pull;
    });
  }
}

TEST(Dynamics, TwoMassesFollowTheirRecurrence) {
  Body first{wandering(0), {}}, second = first;
  const double m1 = 0.15, m2 = 0.4, k1 = 120, k2 = 90, b = 0.2;
  const Parameters q{{"mass1", m1}, {"mass2", m2}, {"k1", k1}, {"k2", k2}, {"b", b}};
  expect_alike("TwoMasses", q, 3000, 2e-3, [&](int, Pair hand) {
    const Pair upper = k1 * (hand - first.p), lower = k2 * (first.p - second.p);
    first.pushed(upper - lower - b * first.v, m1);
    second.pushed(lower - b * second.v, m2);
    return -1.0 * upper;
  });
}

/// Two balls, walls and a hand, each touching by a spring.
struct Balls {
  Body one{{0.05, 0.04}, {-0.2, 0.05}}, two{{-0.05, -0.03}, {0.1, 0.15}};
  double mass = 0.1, radius = 0.012, k = 300, b = 0.02;

  Pair contact(Pair apart) const {
    const double distance = size(apart);
    return distance > 0 && distance < 2 * radius ? (k * (2 * radius - distance) / distance) * apart : Pair{};
  }
  Pair walls(Pair p) const {
    const double half = 0.08 - radius;
    const auto beyond = [&](double c) { return c > half ? c - half : c < -half ? c + half : 0.0; };
    return {-k * beyond(p.x), -k * beyond(p.y)};
  }
  Pair step(Pair hand) {
    const Pair knock1 = contact(hand - one.p), knock2 = contact(hand - two.p), clash = contact(one.p - two.p);
    const Pair push1 = walls(one.p) + clash - knock1 - b * one.v, push2 = walls(two.p) - clash - knock2 - b * two.v;
    one.pushed(push1, mass);
    two.pushed(push2, mass);
    return knock1 + knock2;
  }
  double energy() const {
    const auto stored = [&](double depth) { return 0.5 * k * depth * depth; };
    double sum = 0.5 * mass * (dot(one.v, one.v) + dot(two.v, two.v));
    for (const Body& ball : {one, two})
      for (const double c : {ball.p.x, ball.p.y}) sum += stored(std::max(0.0, std::abs(c) - (0.08 - radius)));
    return sum + stored(std::max(0.0, 2 * radius - size(one.p - two.p)));
  }
};

TEST(Dynamics, MovingMassesFollowTheirRecurrence) {
  Balls balls;
  // The hand stays in the way of the first ball.
  expect_alike(
      "MovingMasses", {}, 1500, 5e-3, [&](int, Pair hand) { return balls.step(hand); },
      [](int) {
        return Pair{0.0f, 0.05f};
      });
}

TEST(Dynamics, MovingMassesKeepTheirEnergyWithoutDrag) {
  Module module("dynamics.wale");
  const Program program = module.program("MovingMasses");
  Bank bank = bank_with(program, {{"b", 0.0}});
  Memory memory(program);
  Hand hand;
  hand.position = {0.3f, 0.3f};  // out of reach
  memory.enter(bank, hand);
  Balls state;
  const double before = state.energy();
  ASSERT_NEAR(before, 0.5 * 0.1 * (0.2 * 0.2 + 0.05 * 0.05 + 0.1 * 0.1 + 0.15 * 0.15), 1e-9);
  for (int i = 0; i < 9000; ++i) {
    tick(bank, memory, hand);
    const auto s = memory.states();
    state.one = {{s[0], s[1]}, {s[2], s[3]}};
    state.two = {{s[4], s[5]}, {s[6], s[7]}};
    ASSERT_NEAR(state.energy(), before, 0.12 * before) << i;  // a contact lasts about 50 ticks
  }
}

TEST(Dynamics, SpringsPullAlongTheirLines) {
  Module module("dynamics.wale");
  const Program linear = module.program("LinearSpring"), radial = module.program("RadialSpring");
  std::mt19937 random(3);
  for (int i = 0; i < 400; ++i) {
    Hand hand;
    hand.position = {uniform(random, 0.09), uniform(random, 0.09)};
    const Pair p{hand.position.x, hand.position.y};
    Parameters q = random_parameters(linear, random);
    Bank line = bank_with(linear, q);
    const Pair u{std::cos(q["angle"]), std::sin(q["angle"])};
    Force force = tick(line, hand);
    EXPECT_NEAR(force.x, std::clamp(-q["k"] * dot(p, u) * u.x, -10.0, 10.0), 1e-4);
    EXPECT_NEAR(force.y, std::clamp(-q["k"] * dot(p, u) * u.y, -10.0, 10.0), 1e-4);
    q = random_parameters(radial, random);
    Bank ring = bank_with(radial, q);
    force = tick(ring, hand);
    const double pull = -q["k"] * (size(p) - q["rest"]) / size(p);
    EXPECT_NEAR(force.x, std::clamp(pull * p.x, -10.0, 10.0), 1e-4);
    EXPECT_NEAR(force.y, std::clamp(pull * p.y, -10.0, 10.0), 1e-4);
  }
}

TEST(Dynamics, TheAttractorFollowsItsRecurrence) {
  const double m = 0.05, k = 40, hold = 80, b = 1, radius = 0.04, turns = 1, swirls = 0.3;
  Body object{{0, 0}, {0, 0}};
  double furthest = 0, nearest = 1;
  expect_alike("Attractor", {}, 4000, 3e-3, [&](int i, Pair hand) {
    const double t = i * dt;
    const double distance = radius * (0.6 + 0.4 * std::cos(2 * M_PI * swirls * t));
    const Pair target{distance * std::cos(2 * M_PI * turns * t), distance * std::sin(2 * M_PI * turns * t)};
    furthest = std::max(furthest, size(target));
    nearest = std::min(nearest, size(target));
    const Pair pull = k * (hand - object.p);
    object.pushed(pull + hold * (target - object.p) - b * object.v, m);
    return -1.0 * pull;
  });
  EXPECT_NEAR(furthest, 0.04, 1e-4);
  EXPECT_NEAR(nearest, 0.008, 1e-4);
}

TEST(Dynamics, TheBrickFollowsItsRecurrence) {
  const double m = 0.5, k = 120, b = 0.8, friction = 0.6;
  Body brick;
  int stuck = 0, slid = 0;
  expect_alike(
      "BrickOnASpring", {}, 4000, 5e-3,
      [&](int, Pair hand) {
        const Pair pull = k * (hand - brick.p);
        const Pair free = brick.v + (dt / m) * (pull - b * brick.v);
        const double speed = size(free);
        brick.v = speed > friction * dt / m ? ((speed - friction * dt / m) / speed) * free : Pair{};
        (size(brick.v) > 0 ? slid : stuck)++;
        brick.p = brick.p + dt * brick.v;
        return -1.0 * pull;
      },
      [](int i) {
        return Pair{static_cast<float>(0.03 * std::sin(2 * i * dt)), static_cast<float>(0.01 * std::sin(3 * i * dt))};
      });
  EXPECT_GT(stuck, 50);
  EXPECT_GT(slid, 500);
}

TEST(Dynamics, TheBrickStaysUntilTheSpringPullsHarderThanFriction) {
  Module module("dynamics.wale");
  const Program program = module.program("BrickOnASpring");
  for (const double stretch : {0.0049, 0.0051}) {  // 120 N/m against 0.6 N: 5 mm
    Bank bank(program);
    Memory memory(program);
    Hand hand;
    memory.enter(bank, hand);
    hand.position = {stretch, 0.0};
    for (int i = 0; i < 900; ++i) tick(bank, memory, hand);
    EXPECT_EQ(memory.states()[0] > 0, stretch > 0.005);
    const Force rest = tick(bank, memory, hand);
    EXPECT_LE(std::abs(rest.x), 0.6 + 1e-4);
  }
}

/// The quantity that semi-implicit Euler conserves for a mass on a spring, in exact arithmetic.
double kept(Pair x, Pair v, double m, double k) {
  return 0.5 * m * dot(v, v) + 0.5 * k * dot(x, x) - 0.5 * k * dt * dot(x, v);
}

TEST(Dynamics, OneMassNeitherGainsNorLosesEnergyWithoutDragAndLosesItWith) {
  Module module("dynamics.wale");
  const Program program = module.program("OneMass");
  for (const double b : {0.0, 0.4}) {
    Bank bank = bank_with(program, {{"mass", 0.3}, {"k", 80.0}, {"b", b}});
    Memory memory(program);
    Hand hand;
    hand.position = {0.05f, 0.0f};
    memory.enter(bank, hand);
    hand.position = {0.0f, 0.0f};  // the mass swings about the hand
    const auto energy = [&] {
      const auto s = memory.states();
      return kept({s[0], s[1]}, {s[2], s[3]}, 0.3, 80);
    };
    const double before = energy();
    EXPECT_NEAR(before, 0.5 * 80 * 0.05 * 0.05, 1e-6);
    for (int i = 0; i < 4500; ++i) {
      tick(bank, memory, hand);
      if (b == 0) {
        ASSERT_NEAR(energy(), before, 2e-3 * before) << i;
      }
    }
    if (b > 0) {
      EXPECT_NEAR(energy() / before, std::exp(-b / 0.3 * 5), 0.3 * std::exp(-b / 0.3 * 5));
    }
  }
}

}  // namespace
}  // namespace wale::sandpaper::dynamics_test
