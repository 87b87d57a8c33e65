// Every patch prototype against its formula in Appendix B of the thesis, as printed or with the physically correct
// sign, at random hands and parameters.
#include <cmath>
#include <functional>

#include "tests/sandpaper/reading.hpp"

namespace wale::sandpaper::prototypes_test {
namespace {

constexpr double dt = 1.0 / 900;

struct Place {
  Pair p, v, a;  ///< position, velocity and acceleration
};
using Law = std::function<Pair(const Place&, Parameters&)>;

double sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// The remainder that is never negative.
double wrapped(double value, double divisor) {
  const double rest = std::fmod(value, divisor);
  return rest < 0 ? rest + divisor : rest;
}

/// A triangle wave of slope 4 through 0, by the arcsine of a sine.
double triangle(double t) { return 2 / M_PI * std::asin(std::sin(2 * M_PI * t)); }

/// The force as a device of 10 N gives it.
Pair limited(Pair force) { return {std::clamp(force.x, -10.0, 10.0), std::clamp(force.y, -10.0, 10.0)}; }

/// Compares a material with its law at a few hundred hands. Where the law jumps, rounding may fall on either side, so
/// the force must lie between the law's values within a micrometre.
void expect_law(Module& module, const std::string& material, const Law& law, int hands = 400) {
  const Program program = module.program(material);
  const PatchSize size = program.default_size();
  std::mt19937 random(1995);
  for (int i = 0; i < hands; ++i) {
    Parameters parameters = i % 4 == 0 ? default_parameters(program) : random_parameters(program, random);
    Bank bank = bank_with(program, parameters);
    const Place place{{uniform(random, 0.499 * size.width), uniform(random, 0.499 * size.height)},
                      {uniform(random, 0.9), uniform(random, 0.9)},
                      {uniform(random, 20), uniform(random, 20)}};
    Hand hand;
    hand.position = {place.p.x, place.p.y};
    hand.velocity = {place.v.x, place.v.y};
    hand.acceleration = {place.a.x, place.a.y};
    const Force force = tick(bank, hand);
    Pair low{1e9, 1e9}, high{-1e9, -1e9};
    for (const double dx : {-1e-6, 0.0, 1e-6}) {
      for (const double dy : {-1e-6, 0.0, 1e-6}) {
        const Place near{place.p + Pair{dx, dy}, place.v, place.a};
        const Pair f = limited(law(near, parameters));
        low = {std::min(low.x, f.x), std::min(low.y, f.y)};
        high = {std::max(high.x, f.x), std::max(high.y, f.y)};
      }
    }
    const double slack = 2e-5;
    ASSERT_GE(force.x, low.x - slack) << material << " " << place.p.x << " " << place.p.y;
    ASSERT_LE(force.x, high.x + slack) << material << " " << place.p.x << " " << place.p.y;
    ASSERT_GE(force.y, low.y - slack) << material << " " << place.p.x << " " << place.p.y;
    ASSERT_LE(force.y, high.y + slack) << material << " " << place.p.x << " " << place.p.y;
  }
}

TEST(Prototypes, FollowTheirFormulas) {
  Module module("prototypes.wale");
  const std::map<std::string, Law> laws{
      {"Spring", [](const Place& h, Parameters& q) { return -q["k"] * h.p; }},
      {"Bump", [](const Place& h, Parameters& q) { return q["k"] * h.p; }},
      {"Viscous", [](const Place& h, Parameters& q) { return -q["b"] * h.v; }},
      {"AntiViscous", [](const Place& h, Parameters& q) { return q["b"] * h.v; }},
      {"Nap",
       [](const Place& h, Parameters& q) {
         return Pair{-q["b"] * h.v.x, std::abs(-q["b"] * h.v.y)};
       }},
      {"Null", [](const Place&, Parameters&) { return Pair{}; }},
      {"Bowl",
       [](const Place& h, Parameters& q) {
         return Pair{-sign(h.p.x) * std::pow(std::abs(h.p.x) / q["reach"], 1.5),
                     -sign(h.p.y) * std::pow(std::abs(h.p.y) / q["reach"], 1.5)};
       }},
      {"BowlAsPrinted",
       [](const Place& h, Parameters& q) {
         const double P = 1 / q["reach"];
         return Pair{h.p.x * P * std::sqrt(std::abs(h.p.x * P)), h.p.y * P * std::sqrt(std::abs(h.p.y * P))};
       }},
      {"Wave",
       [](const Place& h, Parameters& q) {
         return Pair{-q["A"] * std::sin(h.p.x / q["f"]), -q["A"] * std::sin(h.p.y / q["f"])};
       }},
      {"Cusp",
       [](const Place& h, Parameters& q) {
         return Pair{wrapped(std::abs(h.p.x / q["f"]), 2 * q["A"]) - q["A"], 0};
       }},
      {"Const",
       [](const Place&, Parameters& q) {
         return Pair{q["v1"], q["v2"]};
       }},
      {"Ridge",
       [](const Place& h, Parameters& q) {
         return Pair{q["k"] * (wrapped(h.p.x, q["wavelength"]) - q["ridgewidth"]), 0};
       }},
      {"Minus",
       [](const Place& h, Parameters& q) {
         const double T = q["ahead"];
         const Pair M = h.p + T * h.v + (T * T / 2) * h.a;
         return q["k"] * (h.p - M);
       }},
      {"MinusAsPrinted",
       [](const Place& h, Parameters& q) {
         const double T = q["ahead"];
         const Pair M = h.p + T * h.v + (T * T / 2) * h.a;
         return Pair{q["k"] * (h.p.x - M.x), q["k"] * (M.y - h.p.y)};
       }},
      {"Circle",
       [](const Place& h, Parameters& q) {
         return Pair{-q["k"] * h.p.y, q["k"] * h.p.x};
       }},
      {"CircleAsPrinted", [](const Place& h, Parameters& q) { return q["k"] * h.p; }},
      {"Buckle",
       [](const Place& h, Parameters& q) {
         return Pair{q["v1"] * h.p.x - q["v2"] * h.p.y, q["v1"] * h.p.y - q["v2"] * h.p.x};
       }},
      {"BuckleSpiral",
       [](const Place& h, Parameters& q) {
         return Pair{q["v1"] * h.p.x - q["v2"] * h.p.y, q["v1"] * h.p.y + q["v2"] * h.p.x};
       }},
      // The hand has just entered, and the object is at the hand.
      {"ATNSpring", [](const Place&, Parameters&) { return Pair{}; }},
      {"ATNSpringAsPrinted", [](const Place&, Parameters&) { return Pair{}; }},
  };
  for (const auto& name : module.names()) EXPECT_EQ(laws.count(name), 1u) << name << " has no formula here";
  for (const auto& [name, law] : laws) expect_law(module, name, law);
}

TEST(Prototypes, TheAttractedObjectMovesByItsShareEveryTick) {
  Module module("prototypes.wale");
  for (const auto& [name, direction] : {std::pair{"ATNSpring", 1.0}, std::pair{"ATNSpringAsPrinted", -1.0}}) {
    const Program program = module.program(name);
    const Parameters q{{"k", 25.0}, {"lag", 0.25}};
    Bank bank = bank_with(program, q);
    Memory memory(program);
    Hand hand;
    hand.position = {0.03f, -0.02f};
    memory.enter(bank, hand);
    Pair object{0.03f, -0.02f};
    for (int i = 0; i < 900; ++i) {
      const double t = i * dt;
      hand.position = {0.03 + 0.02 * std::sin(9 * t), -0.02 + 0.05 * std::sin(5 * t)};
      const Pair J{hand.position.x, hand.position.y};
      const Force force = tick(bank, memory, hand);
      const Pair expected = direction * 25.0 * (object - J);
      ASSERT_NEAR(force.x, expected.x, 1e-4) << name << " tick " << i;
      ASSERT_NEAR(force.y, expected.y, 1e-4) << name << " tick " << i;
      object = object + (dt / 0.25) * (J - object);
    }
  }
}

TEST(TriangleWave, IsALocalSpringAndASawtoothAsPrinted) {
  Module module("triangle_wave.wale");
  expect_law(module, "TriangleWave", [](const Place& h, Parameters& q) {
    return Pair{-q["amp"] * triangle(h.p.x / q["wavelength"]), -q["amp"] * triangle(h.p.y / q["wavelength"])};
  });
  // force.x = abs((Jx % wavelength) * amp / wavelength) - amp, C's remainder with the sign of Jx.
  expect_law(module, "TriangleWaveAsPrinted", [](const Place& h, Parameters& q) {
    const double wavelength = q["wavelength"], amp = q["amp"];
    return Pair{std::abs(std::fmod(h.p.x, wavelength) * amp / wavelength) - amp,
                std::abs(std::fmod(h.p.y, wavelength) * amp / wavelength) - amp};
  });
}

TEST(TextbookObjects, FollowNewton) {
  Module module("textbook.wale");
  expect_law(module, "InertialMass", [](const Place& h, Parameters& q) { return -q["M"] * h.a; });
  expect_law(module, "SecondOrder",
             [](const Place& h, Parameters& q) { return -1.0 * (q["M"] * h.a + q["B"] * h.v + q["K"] * h.p); });
  expect_law(module, "MenuDetents", [](const Place& h, Parameters& q) {
    const double line = q["line"];
    return Pair{0, -q["k"] * (h.p.y - line * std::floor(h.p.y / line + 0.5))};
  });
  expect_law(module, "HardWall", [](const Place& h, Parameters& q) {
    if (h.p.x <= 0) return Pair{};
    const double damping = h.v.x > 0 ? q["damping"] : q["damping"] * q["release"];
    return Pair{std::min(0.0, -q["stiffness"] * h.p.x - damping * h.v.x), 0};  // a wall never pulls
  });
  // F = m g tan(slope), downhill, by a difference instead of a derivative, outside of the fading rim.
  const Program hill = module.program("StylusOnAHill");
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    Parameters q = random_parameters(hill, random);
    Bank bank = bank_with(hill, q);
    Hand hand;
    hand.position = {uniform(random, 0.074), uniform(random, 0.074)};
    const auto height = [&](double x, double y) {
      return q["height"] * std::exp(-(x * x + y * y) / (2 * q["width"] * q["width"]));
    };
    const double e = 1e-6, x = hand.position.x, y = hand.position.y;
    const Force force = tick(bank, hand);
    EXPECT_NEAR(force.x, -q["mass"] * 9.80665 * (height(x + e, y) - height(x - e, y)) / (2 * e), 1e-4);
    EXPECT_NEAR(force.y, -q["mass"] * 9.80665 * (height(x, y + e) - height(x, y - e)) / (2 * e), 1e-4);
  }
}

}  // namespace
}  // namespace wale::sandpaper::prototypes_test
