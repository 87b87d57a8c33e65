// Forces by motion and time that are no single friction, viscosity or swing.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/read/cues.hpp"
#include "compiler/read/tolerances.hpp"
#include "tests/standard/standard.hpp"

namespace wale::motion_test {
namespace {

using standard::material;

Bank pushing(const std::string& statements) {
  return Bank(material("\nmaterial m { physical {\n" + statements + "\n} }", "m"));
}

const Declarations& declared() {
  static const auto common = common_modules();
  return common->declarations;
}

ForceReading found_in(const std::string& statements) { return read(pushing(statements), declared()); }
Cues cues_in(const std::string& statements) {
  const Bank bank = pushing(statements);
  return cues_of(bank, read(bank, declared()));
}
Description described(const std::string& statements) { return describe(pushing(statements), declared()); }

TEST(ReadingMotion, ABristleIsReadOnAWayThatIsLongEnough) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 12; ++i) {
    const double size = between(0.3, 9), path = between(1e-3, 65e-3), viscosity = i % 3 == 0 ? between(0.3, 3) : 0;
    const std::string text =
        fmt::format("force = sticky({} N, stiffness: {} N/m) + viscous({} N s/m)", size, size / path, viscosity);
    const OpposingForce found = found_in(text).opposing;
    EXPECT_NEAR(found.friction, size, 0.03 * size) << text;
    EXPECT_NEAR(found.damping, viscosity, std::max(least_damping, 0.03 * viscosity)) << text;
    EXPECT_FALSE(found.friction_grows) << text;
  }
}

TEST(ReadingMotion, ABristleThatOutlastsThePatchIsSoMuchAtLeast) {
  const ForceReading found = found_in("force = sticky(0.8 N, stiffness: 3 N/m)");
  EXPECT_TRUE(found.opposing.friction_grows);
  EXPECT_NEAR(found.opposing.friction, 3 * 0.15, 0.03);
  const Description told = described("force = sticky(0.8 N, stiffness: 3 N/m)");
  EXPECT_NE(description_text(told).find("the friction is at least 0.4"), std::string::npos);
}

// A spring gives back on the way back what it took on the way forth, wherever its rest is; no friction does.
TEST(ReadingMotion, ASpringToARememberedPlaceIsNoFriction) {
  const std::string pressed = "state g : position = hand in -100 mm .. 100 mm\nnext g = if button then g else hand\n";
  for (const double stiffness : {20.0, 50.0, 120.0}) {
    const std::string came =
        fmt::format("state g : position = hand in -100 mm .. 100 mm\nforce = {} N/m * (g - hand)", stiffness);
    const OpposingForce found = found_in(came).opposing;
    EXPECT_EQ(found.friction, 0) << came;
    EXPECT_FALSE(found.friction_grows || found.friction_cut) << came;
    EXPECT_EQ(description_text(described(came)).find("stickiness"), std::string::npos) << came;
    const OpposingForce damped = found_in(came + " + viscous(3 N s/m)").opposing;
    EXPECT_EQ(damped.friction, 0) << came;
    EXPECT_NEAR(damped.damping, 3, 0.1) << came;
    const std::string text = description_text(
        described(pressed + fmt::format("force = (if button then {} N/m else 0 N/m) * (g - hand)", stiffness)));
    EXPECT_EQ(text.find("friction"), std::string::npos) << text;
  }
  // Its rest slips when it is 30 mm behind, as that of a bristle does.
  const OpposingForce slips = found_in(
                                  "state g : position = hand in -100 mm .. 100 mm\n"
                                  "next g = hand + (g - hand) * min(1, 30 mm / max(length(g - hand), 0.01 mm))\n"
                                  "force = 50 N/m * (g - hand)")
                                  .opposing;
  EXPECT_NEAR(slips.friction, 1.5, 0.06);
}

// A friction along an oblique axis and another across it, each by the sign of the hand's speed along its own axis
// alone.
TEST(ReadingMotion, TwoFrictionsAlongObliqueAxesAreToldAlongThese) {
  std::mt19937 random(31);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 10; ++i) {
    const double size = between(0.5, 2), across = size * between(0.2, 0.8), degrees = between(8, 82);
    const double damping = i % 2 == 0 ? 0 : between(0.5, 3);
    const std::string text = fmt::format(
        "let u = rotate(vector(1, 0), {0} deg)\nlet w = rotate(vector(0, 1), {0} deg)\nforce = -{1} N * "
        "sign(dot(velocity, u)) * u - {2} N * sign(dot(velocity, w)) * w + viscous({3} N s/m)",
        degrees, size, across, damping);
    const OpposingForce found = found_in(text).opposing;
    EXPECT_NEAR(found.friction, size, 0.03 * size) << text;
    EXPECT_NEAR(found.friction_across, across, 0.03 * size) << text;
    const double axis = std::atan2(found.friction_axis.y, found.friction_axis.x) * 180 / 3.14159265;
    EXPECT_NEAR(std::remainder(axis - degrees, 180), 0, 2) << text;
    EXPECT_NEAR(found.damping, damping, 0.05) << text;
  }
}

// What a wall takes from a hand that goes into it is the wall's, and no drag of the room before it.
TEST(ReadingMotion, AnObliqueWallsDampingIsNoDragBesideIt) {
  for (const char* way : {"vector(0.6, 0.8)", "vector(0.8, -0.6)", "vector(-0.28, 0.96)"}) {
    const auto wall = [&](const char* damping) {
      return fmt::format(
          "let d = {}\nlet into = dot(hand, d) - 20 mm\nforce = (if into > 0 mm then -250 N/m * into - {} N s/m * "
          "max(0 m/s, dot(velocity, d)) else 0 N) * d + viscous(1 N s/m)",
          way, damping);
    };
    const Cues damped = cues_in(wall("3")), plain = cues_in(wall("0"));
    for (const CueKind kind : {CueKind::drag, CueKind::drag_across, CueKind::drag_axis, CueKind::viscosity_across}) {
      EXPECT_EQ(damped[kind].has_value(), plain[kind].has_value()) << way << " " << static_cast<int>(kind);
    }
    EXPECT_NEAR(damped[CueKind::viscosity].value_or(0), 1, 0.1) << way;
  }
}

TEST(ReadingMotion, ADragAlongOneAxisKeepsItsAxisOnALongWay) {
  const OpposingForce found = found_in("force = vector(sticky(4 N).x, 0 N)").opposing;
  EXPECT_NEAR(found.friction, 4, 0.12);
  EXPECT_NEAR(found.friction_across, 0, least_force);
  EXPECT_NEAR(std::abs(found.friction_axis.x), 1, 1e-3);
}

TEST(ReadingMotion, APowerOfTheSpeedIsNoViscosity) {
  struct Power {
    const char* force;
    double exponent, at_200;
  };
  for (const Power& each :
       {Power{"force = -7 N s^2/m^2 * length(velocity) * velocity", 2, 0.28},
        Power{"force = -90 N s^3/m^3 * dot(velocity, velocity) * velocity", 3, 0.72},
        Power{"force = -1.5 N * normalise(velocity) * sqrt(length(velocity) / 1 m/s)", 0.5, 0.6708}}) {
    const OpposingForce found = found_in(each.force).opposing;
    EXPECT_FALSE(found.explained) << each.force;
    EXPECT_EQ(found.damping, 0) << each.force;
    EXPECT_EQ(found.friction, 0) << each.force;
    EXPECT_NEAR(found.exponent, each.exponent, 0.02) << each.force;
    EXPECT_NEAR(found.unexplained_at(0.2), each.at_200, 0.01 * each.at_200) << each.force;
  }
  const std::string text = description_text(described("force = -7 N s^2/m^2 * length(velocity) * velocity"));
  EXPECT_NE(text.find("grows with the square of the speed"), std::string::npos) << text;
}

TEST(ReadingMotion, ADragOfSomeSpeedsOnlyHasNoNegativeFriction) {
  const OpposingForce slow =
      found_in("force = if length(velocity) < 0.11 m/s then viscous(10 N s/m) else vector(0 N, 0 N)").opposing;
  EXPECT_FALSE(slow.explained);
  EXPECT_NEAR(slow.unexplained_at(0.05), 0.5, 0.01);
  EXPECT_NEAR(slow.unexplained_at(0.4), 0, least_force);
  const OpposingForce fast =
      found_in("force = -10 N s/m * max(0, 1 - 0.1 m/s / max(length(velocity), 1e-6 m/s)) * velocity").opposing;
  EXPECT_FALSE(fast.explained);
  EXPECT_EQ(fast.friction, 0);
  EXPECT_NEAR(fast.unexplained_at(0.4), 3, 0.03);
  // Stokes and a saturating drag are their own laws.
  EXPECT_TRUE(found_in("force = viscous(5 N s/m)").opposing.explained);
  EXPECT_NEAR(found_in("force = -hold(20 N s/m * velocity, 3 N)").opposing.friction, 3, 3e-3);
  // What pushes along is said to.
  EXPECT_NEAR(found_in("active 2 W\nforce = 0.3 N * normalise(velocity)").opposing.friction, -0.3, 0.01);
}

TEST(ReadingMotion, ADragThatSaturatesIsToldWithBothFigures) {
  for (const double viscosity : {1.0, 3.0, 5.0, 8.0, 20.0})
    for (const double limit : {0.3, 0.5, 0.8, 1.0, 1.4}) {
      const double whole = limit / viscosity;
      if (whole < 0.03 || whole > 0.39) continue;
      const std::string text = fmt::format("force = viscous({} N s/m) limit {} N", viscosity, limit);
      const OpposingForce found = found_in(text).opposing;
      EXPECT_TRUE(found.explained) << text;
      if (whole >= 0.2) {
        EXPECT_NEAR(found.damping, viscosity, 0.02 * viscosity) << text;
        EXPECT_NEAR(found.limit, limit, 0.02 * limit) << text;
        EXPECT_EQ(found.friction, 0) << text;
      } else {
        EXPECT_NEAR(found.friction, limit, 0.02 * limit) << text;
        EXPECT_NEAR(found.rise(), viscosity, 0.04 * viscosity) << text;
        EXPECT_EQ(found.damping, 0) << text;
      }
    }
  EXPECT_EQ(found_in("force = sticky(0.3 N)").opposing.rise(), 0);
  const Cues saturating = cues_in("force = viscous(1 N s/m) limit 0.3 N"), dry = cues_in("force = sticky(0.3 N)");
  EXPECT_TRUE(saturating[CueKind::viscosity_limit]);
  EXPECT_FALSE(dry[CueKind::viscosity]);
  // A smooth curve is neither.
  const OpposingForce smooth =
      found_in("force = -0.8 N * tanh(length(velocity) / 200 mm/s) * normalise(velocity)").opposing;
  EXPECT_FALSE(smooth.explained);
  EXPECT_NEAR(smooth.unexplained_at(0.05), 0.8 * std::tanh(0.25), 0.01);
}

TEST(ReadingMotion, ADragThatChangesWithTimeIsToldByItsMeanIfItHasOne) {
  const OpposingForce swings = found_in("force = viscous(4 N s/m) * (1 + sin(2 pi * phase(3 Hz)))").opposing;
  EXPECT_TRUE(swings.changes_in_time && swings.explained);
  EXPECT_NEAR(swings.damping, 4, 0.1);
  EXPECT_NEAR(swings.least_in_time, 0, 0.02);
  EXPECT_NEAR(swings.most_in_time, 1.6, 0.02);
  const OpposingForce fades = found_in("active 1 W\nforce = sticky(0.7 N) * exp(-time / 2 s)").opposing;
  EXPECT_TRUE(fades.changes_in_time);
  EXPECT_FALSE(fades.explained);
  EXPECT_EQ(fades.friction, 0);
  EXPECT_EQ(fades.damping, 0);
  for (const char* steady : {"force = sticky(0.7 N)", "force = viscous(4 N s/m) + sticky(0.4 N)",
                             "active 1 W\nforce = viscous(4 N s/m) + vector(0.5 N * sin(2 pi * phase(30 Hz)), 0 N)"})
    EXPECT_FALSE(found_in(steady).opposing.changes_in_time) << steady;
}

TEST(ReadingMotion, AFrictionThatTheDeviceCutsIsSoMuchAtLeast) {
  for (const char* force : {"force = sticky(40 N, stiffness: 2000 N/m)", "force = sticky(30 N)"}) {
    const OpposingForce found = found_in(force).opposing;
    EXPECT_TRUE(found.friction_cut) << force;
    EXPECT_NEAR(found.friction, 10, 0.01) << force;
  }
  const OpposingForce whole = found_in("force = sticky(8 N, stiffness: 90 N/m)").opposing;
  EXPECT_FALSE(whole.friction_cut);
  EXPECT_NEAR(whole.friction, 8, 0.2);
  EXPECT_EQ(whole.one_way(), glm::dvec2(0));
}

TEST(ReadingMotion, WhatPushesNowhereAlikeIsNoConstantPush) {
  for (const char* force :
       {"force = vector(if velocity.x > 0 m/s then -0.5 N else 0 N, 0 N)", "force = vector(1 N * sign(x), 0 N)"})
    EXPECT_LT(glm::length(found_in(force).constant), least_force) << force;
  EXPECT_NEAR(glm::length(found_in("force = spring(400 N/m, rest: vector(100 mm, 0 mm))").constant), 10, 0.01);
}

TEST(ReadingMotion, OneWayAndPartOfThePatchAreSaid) {
  const OpposingForce right =
      found_in("force = vector(if velocity.x > 0 m/s then -5 N s/m * velocity.x else 0 N, 0 N)").opposing;
  EXPECT_EQ(right.damping, 0);
  EXPECT_NEAR(right.forward.x, 1, 0.01);
  EXPECT_NEAR(right.backward.x, 0, 0.01);
  EXPECT_NEAR(right.one_way().x, -0.5, 0.01);
  const OpposingForce part = found_in("force = viscous(if x > 0 mm then 10 N s/m else 2 N s/m)").opposing;
  EXPECT_EQ(part.damping, 0);
  EXPECT_NEAR(part.least_by_place, 0.4, 0.01);
  EXPECT_NEAR(part.most_by_place, 2, 0.02);
  // Ways that hardly differ keep their mean.
  const OpposingForce nap =
      found_in("force = if velocity.x > 0 m/s then viscous(5 N s/m) else viscous(4 N s/m)").opposing;
  EXPECT_NEAR(nap.damping, 4.5, 0.05);
  EXPECT_NEAR(nap.forward.x - nap.backward.x, 0.2, 0.01);
  // A program with memory is read by strokes.
  const OpposingForce halves = found_in("force = sticky(if x > 0 mm then 1 N else 0.2 N)").opposing;
  EXPECT_EQ(halves.friction, 0);
  EXPECT_NEAR(halves.least_by_place, 0.2, 0.01);
  EXPECT_NEAR(halves.most_by_place, 1, 0.03);
  const OpposingForce pile = read(Bank(standard::made("std.nap", "napped_cloth")), declared()).opposing;
  EXPECT_EQ(pile.friction, 0);
  EXPECT_NEAR(pile.forward.y, 0.3, 0.01);
  EXPECT_NEAR(pile.backward.y, 1.2, 0.04);
  const Cues one = cues_in("force = vector(if velocity.x > 0 m/s then -5 N s/m * velocity.x else 0 N, 0 N)"),
             other = cues_in("force = vector(if velocity.x < 0 m/s then -5 N s/m * velocity.x else 0 N, 0 N)");
  EXPECT_NEAR(one[CueKind::one_way_x].value_or(0), -other[CueKind::one_way_x].value_or(0), 0.01);
  EXPECT_LT(one[CueKind::one_way_x].value_or(0), -0.4);
}

TEST(ReadingMotion, AMemoryThatLagsIsNoDragOnOneWay) {
  for (const double lag : {0.05, 0.1, 0.2, 0.4})
    for (const char* state : {"hand", "x"}) {
      const bool both = std::string(state) == "hand";
      const std::string force = both ? "-80 N/m * (hand - p)" : "vector(-80 N/m * (x - p), 0 N)";
      const OpposingForce found = found_in(fmt::format("active 9 W\nstate p : position = {0} in -200 mm .. 200 mm\n"
                                                       "p' = ({0} - p) / {1} s\nforce = {2}",
                                                       state, lag, force))
                                      .opposing;
      EXPECT_EQ(found.one_way(), glm::dvec2(0)) << state << " " << lag;
    }
}

TEST(ReadingMotion, WhatFadesIsToldOnce) {
  for (const char* force : {"vector(2 N * exp(-time / 1 s), 0 N)", "vector(0 N, 1.3 N * exp(-time / 0.7 s))"}) {
    const Description found = described(std::string("active 9 W\nforce = ") + force);
    EXPECT_GT(found.other.slowly, 1) << force;
    EXPECT_EQ(found.unread, 0) << force;
  }
}

TEST(ReadingTime, AWaveThatTravelsNeitherResistsNorPushes) {
  for (const char* phase : {"3 Hz * time", "phase(5 Hz)"})
    for (const char* period : {"20 mm", "3 mm"}) {
      const std::string text =
          fmt::format("active 2 W\nforce = vector(1 N * sin(2 * pi * (x / {} - {})), 0 N)", period, phase);
      const Cues cues = cues_in(text);
      for (const CueKind none : {CueKind::viscosity, CueKind::friction, CueKind::push_x, CueKind::push_y, CueKind::drag,
                                 CueKind::slow_drag, CueKind::fast_drag, CueKind::other_force})
        EXPECT_FALSE(cues[none]) << text << ": " << cue_table()[static_cast<std::size_t>(none)].name;
      EXPECT_NEAR(cues[CueKind::amplitude].value_or(0), 1, 0.03) << text;
      EXPECT_NEAR(cues[CueKind::sway].value_or(0), 1, 0.03) << text;
    }
}

TEST(ReadingTime, NoiseHasNoRateAndNoPush) {
  for (const char* step : {"3 ms", "5 ms", "12 ms"}) {
    const std::string text = fmt::format(
        "active 2 W\nforce = 0.5 N * vector(2 * noise(time / {0}) - 1, 2 * noise(time / {0} + 999.5) - 1)", step);
    const Description told = described(text);
    const Cues cues = cues_in(text);
    EXPECT_FALSE(cues[CueKind::vibration_frequency]) << text;
    EXPECT_FALSE(cues[CueKind::sway]) << text;
    EXPECT_FALSE(cues[CueKind::push_x]) << text;
    EXPECT_FALSE(cues[CueKind::push_y]) << text;
    EXPECT_GT(cues[CueKind::noise_in_time].value_or(0), 0.3) << text;
    EXPECT_LE(cues[CueKind::noise_in_time].value_or(0), told.bound.newton) << text;
  }
  // A train of short pulses and a square wave have their rates.
  EXPECT_NEAR(cues_in("active 2 W\nforce = vector(if fract(14 Hz * time) < 0.1 then 1 N else 0 N, 0 N)")
                  [CueKind::vibration_frequency]
                      .value_or(0),
              14, 0.3);
}

TEST(ReadingTime, WhatMayComeLaterIsSaidAndNoGoodGrade) {
  for (const char* force :
       {"if time > 100 s then vector(3 N, 0 N) else vector(0 N, 0 N)",
        "vector(3 N * clamp(time / 600 s - 1, 0, 1), 0 N)", "vector(if t > 30 then 3 N else 0 N, 0 N)"}) {
    const std::string text = fmt::format("active 1 W\nstate t = 0 in 0 .. 100\nt' = 1 / 1 s\nforce = {}", force);
    const Description told = described(text);
    EXPECT_EQ(told.grade.standing, Standing::unknown) << text;
    EXPECT_FALSE(told.grade.assumed_standing()) << text;
    EXPECT_NEAR(told.grade.later_newton, 3, 1e-3) << text;
    EXPECT_EQ(told.no_percept, "it does not push in the first 8 s") << text;
    EXPECT_TRUE(cues_in(text)[CueKind::later_force]) << text;
  }
  // Swings come back, and a spring or the device's limit hides nothing.
  for (const char* force : {"vector(0.7 N * sin(2 * pi * phase(0.5 Hz)), 0 N)",
                            "vector(0.7 N * sin(2 * pi * 3 Hz * time), 0 N)", "vibrate(0.5 N)"})
    EXPECT_EQ(described(fmt::format("active 1 W\nforce = {}", force)).grade.later_newton, 0) << force;
  EXPECT_GT(
      described("active 1 W\nforce = spring(50 N/m) + (if time > 20 s then vector(3 N, 0 N) else vector(0 N, 0 N))")
          .other.later,
      3);
}

TEST(ReadingTime, NoFigureIsLargerThanTheProvedBound) {
  for (const char* text : {"active 2 W\nforce = spring(24 N/m) + vector(2.9 N * sin(2 * pi * phase(111 Hz)), 0 N)",
                           "active 2 W\nforce = spring(50 N/m) + vector(1 N * sin(2 * pi * phase(1 Hz)), 0 N)",
                           "active 2 W\nforce = vector(0.7 N * sin(2 * pi * phase(0.5 Hz)), 0 N)",
                           "force = vector(1 N * sin(2 * pi * (x / 10 mm + x^2 / 400 mm / 1 mm)), 0 N)",
                           "force = vector(14 N * sin(2 * pi * x / 3 mm), 0 N)"}) {
    const Description told = described(text);
    const double bound = told.bound.newton * (1 + 1e-5);
    EXPECT_LE(told.force.p99_newton, told.force.max_newton) << text;
    EXPECT_LE(told.force.max_newton, bound) << text;
    EXPECT_LE(told.sway.amplitude, told.force.max_newton * 1.001) << text;
    EXPECT_LE(told.texture->force.amplitude, bound) << text;
    EXPECT_LE(told.texture->force.amplitude, told.force.max_newton * 1.021) << text;
  }
}

}  // namespace
}  // namespace wale::motion_test
