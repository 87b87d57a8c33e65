// The guards in the loop with the simulated joystick: the motion of a device of known mass and damping under sampled
// and held control, compared with control theory and tests/reference/closed_loop.md.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "runtime/stage/guards.hpp"
#include "tests/runtime/figures.hpp"

namespace wale::closed_loop_test {
namespace {

using Field = std::function<glm::dvec2(glm::dvec2 position)>;

/// The device of the reference without friction, and without slew and, unless `encoder`, without quantisation. The
/// stiffest passive spring on it is 2 b / T.
DeviceProfile frictionless(bool encoder) {
  DeviceProfile profile = sandpaper();
  profile.friction = 0;
  profile.slew = 0;
  if (!encoder) profile.position_counts = profile.force_counts = 1 << 26;
  return profile;
}

double stiffest_passive(const DeviceProfile& profile) { return 2 * profile.damping * profile.rate; }

struct Outcome {
  double late_speed = 0;  ///< m/s, the highest in the last two seconds
  long acted = 0;
};

struct Scene {
  DeviceProfile profile;
  HandModel hand;
  Motion motion;
};

Outcome run(const Scene& scene, const Field& field, double seconds, bool guarded, glm::dvec2 push = glm::dvec2(0)) {
  SimulatedJoystick joystick(scene.profile, scene.hand, scene.motion);
  Guards guards(scene.profile);
  const long ticks = std::lround(seconds * scene.profile.rate), last = std::lround(2 * scene.profile.rate);
  Outcome outcome;
  for (long n = 0; n < ticks; ++n) {
    joystick.elapse(1);
    const glm::dvec2 position = glm::dvec2(joystick.sample().counts) * scene.profile.position_step();
    const Force wanted(n < 20 ? push : field(position));
    const Force calmed = guards(wanted, position, 1);
    const Force actual = joystick.command(guarded ? calmed : wanted);
    guards.commanded(guarded ? actual : Force(calmed));
    if (n >= ticks - last) outcome.late_speed = std::max(outcome.late_speed, glm::length(joystick.velocity()));
  }
  outcome.acted = guards.counts().passivity;
  return outcome;
}

Field spring(double stiffness) {
  return [=](glm::dvec2 position) { return -stiffness * position; };
}

/// A wall at x >= 0.
Field wall(double stiffness) {
  return [=](glm::dvec2 position) { return glm::dvec2(-stiffness * std::max(0.0, position.x), 0); };
}

/// Ribs 2.5 mm apart whose force is limited to its amplitude, like corduroy.
Field ribs(double amplitude) {
  return [=](glm::dvec2 position) {
    const double sine = std::sin(2 * std::numbers::pi * position.x / 0.0025);
    return glm::dvec2(amplitude * glm::clamp(1.3 * sine, -1.0, 1.0), 0);
  };
}

TEST(ClosedLoop, ASpringOfTwiceThePassiveStiffnessIsCalmed) {
  for (const bool encoder : {false, true}) {
    SCOPED_TRACE(encoder);
    const Scene scene{frictionless(encoder), no_hand, Rest{}};
    const Field field = spring(2 * stiffest_passive(scene.profile));
    EXPECT_GT(run(scene, field, 20, false, {0.5, 0}).late_speed, 0.2) << "without the guards it diverges";
    const Outcome calmed = run(scene, field, 20, true, {0.5, 0});
    EXPECT_LT(calmed.late_speed, 0.1);
    EXPECT_GT(calmed.acted, 0);
  }
}

TEST(ClosedLoop, AWallOfTwiceThePassiveStiffnessIsCalmed) {
  // A light hand of 0.2 kg, 0.5 N s/m and 135 N/m leans on it, with a target 10 mm inside.
  for (const bool encoder : {false, true}) {
    SCOPED_TRACE(encoder);
    const HandModel light{.mass = 0.2, .damping = 0.5, .stiffness = 135};
    const Scene scene{frictionless(encoder), light, Rest{{0.01, 0}}};
    const Field field = wall(2 * 2 * (scene.profile.damping + light.damping) * scene.profile.rate);
    const double unguarded = run(scene, field, 20, false, {-8, 0}).late_speed;
    EXPECT_GT(unguarded, 0.08) << "without the guards it oscillates";
    EXPECT_LT(run(scene, field, 20, true, {-8, 0}).late_speed, 0.1 * unguarded);
  }
}

/// The stiffest passive spring, in N/m, with a delay of `ticks` and the damping of device and hand: the bound of
/// Colgate and Schenkel with a delay, b / (T / 2 + t).
double stiffest_passive(const Scene& scene, double ticks) {
  return (scene.profile.damping + scene.hand.damping) * scene.profile.rate / (0.5 + ticks);
}

DeviceProfile late(DeviceProfile profile, double ticks) {
  profile.delay_x = profile.delay_y = ticks / profile.rate;
  profile.damping_known = true;
  return profile;
}

TEST(ClosedLoop, AWallOfTwiceThePassiveStiffnessIsCalmedWithADelay) {
  const HandModel light{.mass = 0.2, .damping = 0.5, .stiffness = 135};
  for (const bool encoder : {false, true})
    for (const double ticks : {1.0, 2.0, 2.7}) {
      SCOPED_TRACE(testing::Message() << ticks << " ticks late" << (encoder ? ", encoder" : ""));
      const Scene leaning{late(frictionless(encoder), ticks), light, Rest{{0.01, 0}}};
      const Field stiff = wall(2 * stiffest_passive(leaning, ticks));
      const double unguarded = run(leaning, stiff, 20, false, {-8, 0}).late_speed;
      const Outcome calmed = run(leaning, stiff, 20, true, {-8, 0});
      EXPECT_LT(calmed.late_speed, 0.1);
      EXPECT_LT(calmed.late_speed, unguarded);
      const Scene alone{late(frictionless(encoder), ticks), no_hand, Rest{}};
      const Field spring_of_twice = spring(2 * stiffest_passive(alone, ticks));
      EXPECT_GT(run(alone, spring_of_twice, 20, false, {0.5, 0}).late_speed, 0.2);
      EXPECT_LT(run(alone, spring_of_twice, 20, true, {0.5, 0}).late_speed, 0.1);
    }
}

TEST(ClosedLoop, PassiveFieldsWithADelayAreNotChanged) {
  for (const bool encoder : {false, true})
    for (const double ticks : {1.0, 2.0, 2.7})
      for (const double share : {0.1, 0.5, 0.9}) {
        SCOPED_TRACE(testing::Message() << share << ", " << ticks << " ticks late");
        const Scene alone{late(frictionless(encoder), ticks), no_hand,
                          Rest{{0.012, 0.006}}};  // the handle is released there
        const double stiffness = share * stiffest_passive(alone, ticks);
        EXPECT_EQ(run(alone, spring(stiffness), 10, true, stiffness * glm::dvec2(-0.012, -0.006)).acted, 0);
        const Scene leaning{late(frictionless(encoder), ticks), normal_hand(), Lateral{0.02, 1}};
        EXPECT_EQ(run(leaning, wall(stiffness), 10, true).acted, 0);
        // The ribs' steepest slope is 1.3 A 2 pi / 2.5 mm.
        const double amplitude = share * stiffest_passive(alone, ticks) * 0.0025 / (1.3 * 2 * std::numbers::pi);
        const Scene rubbing{late(sandpaper(), ticks), normal_hand(), Lateral{0.04, 1}};
        EXPECT_EQ(run(rubbing, ribs(amplitude), 5, true).acted, 0);
      }
}

TEST(ClosedLoop, PassiveSpringsAndWallsAreNotChanged) {
  for (const bool encoder : {false, true})
    for (const double share : {0.1, 0.5, 0.9}) {
      SCOPED_TRACE(share);
      const Scene alone{frictionless(encoder), no_hand, Rest{}};
      const double stiffness = share * stiffest_passive(alone.profile);
      EXPECT_EQ(run(alone, spring(stiffness), 10, true, {1, 0.5}).acted, 0);
      const Scene leaning{frictionless(encoder), normal_hand(), Lateral{0.02, 1}};
      EXPECT_EQ(run(leaning, wall(stiffness), 10, true).acted, 0);
    }
}

TEST(ClosedLoop, ARubbedTextureIsNotChanged) {
  const HandModel light{.mass = 0.2, .damping = 2.5, .stiffness = 60};
  const HandModel firm{.mass = 0.9, .damping = 12, .stiffness = 400};
  // The steepest slope is 1.3 A 2 pi / 2.5 mm. At 0.5 N it is passive on the device alone (1800 N/m).
  for (const HandModel& hand : {normal_hand(), light, firm})
    for (const double amplitude : {0.1, 0.5})
      for (const Motion& motion : {Motion(Lateral{0.04, 1}), Motion(Lateral{0.02, 0.5}), Motion(Circular{0.03, 1})}) {
        const Scene scene{sandpaper(), hand, motion};
        EXPECT_EQ(run(scene, ribs(amplitude), 5, true).acted, 0) << amplitude << " N, hand of " << hand.mass << " kg";
      }
  // Corduroy needs 2.8 N s/m, more than the damping of the device but less than that of a hand.
  for (const HandModel& hand : {normal_hand(), firm})
    for (const Motion& motion : {Motion(Lateral{0.04, 1}), Motion(Circular{0.03, 1})})
      EXPECT_EQ(run({sandpaper(), hand, motion}, ribs(1.934), 5, true).acted, 0) << hand.mass << " kg";
}

/// At constant speed over a spring, the loop gains K dx^2 / 2 - b dx^2 / T per tick, since the held force is that of
/// the place before.
TEST(PassivityObserver, MetersTheGainOfAHeldSpring) {
  DeviceProfile profile = frictionless(false);
  PassivityObserver observer(profile);
  const double stiffness = 5000, step = 1e-5;
  double expected = 0;
  for (int tick = 0; tick < 300; ++tick) {
    const glm::dvec2 position(-0.01 + step * tick, 0);
    const Force field(-stiffness * position);
    observer(field, position, 1);
    observer.commanded(field);
    // Towards the centre the spring's force is smaller than the held force, which is a gain.
    if (tick > 0) expected += stiffness * step * step / 2 - profile.damping * step * step * profile.rate;
    ASSERT_NEAR(observer.gained(), expected, 1e-4 * expected + 1e-12) << tick;
  }
  EXPECT_EQ(observer.acted(), 0) << "0.5 mJ is allowed at 50 N and this speed";
}

TEST(PassivityObserver, ItsForceIsDampingAndBounded) {
  DeviceProfile profile = frictionless(false);
  profile.damping = 0;
  PassivityObserver observer(profile);
  // The actual force always pushes along the motion, so every tick is a gain.
  long acted = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double x = 0.001 * std::sin(0.2 * tick), before = 0.001 * std::sin(0.2 * (tick - 1));
    const Force field(0.5f * static_cast<float>(x > 0 ? -1 : 1), 0);
    const Force calmed = observer(field, {x, 0}, 1);
    observer.commanded(Force(20 * (x - before) * 900, 0));
    if (calmed == field) continue;
    ++acted;
    const double damping = (field.x - calmed.x) / ((x - before) * profile.rate);
    ASSERT_GT(damping, 0);
    ASSERT_LE(damping, 0.1 * profile.mass * profile.rate * 1.0001);
  }
  EXPECT_GT(acted, 0);
  EXPECT_EQ(acted, observer.acted());
}

/// The observer's damping adds to a force that already opposes the motion; the sum stays within the user's limit.
TEST(PassivityObserver, ItsForceStaysWithinTheUsersLimit) {
  constexpr double most = 0.5;
  Guards guards(frictionless(false), most);
  double last = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double x = 0.001 * std::sin(0.2 * tick), step = x - std::exchange(last, x);
    const Force force = guards(Force(step > 0 ? -most : most, 0), {x, 0}, 1);
    ASSERT_LE(glm::length(force), most * 1.00001) << tick;
    guards.commanded(Force(20 * step * 900, 0));  // an actuator that goes along with the hand
  }
  EXPECT_GT(guards.counts().passivity, 0);
}

TEST(PassivityObserver, CountsADelayOnlyWhereTheDampingIsKnown) {
  DeviceProfile known = late(frictionless(false), 2), assumed = known;
  assumed.damping_known = false;
  PassivityObserver with(known), without(assumed), prompt(frictionless(false));
  for (int tick = 0; tick < 300; ++tick) {
    const glm::dvec2 position(0.001 * std::sin(0.07 * tick), 0);
    const Force field(-500.0 * position);
    for (PassivityObserver* observer : {&with, &without, &prompt})
      (*observer)(field, position, 1), observer->commanded(field);
    ASSERT_EQ(without.gained(), prompt.gained());
  }
  EXPECT_GT(with.gained(), prompt.gained());
}

TEST(PassivityObserver, WithoutAKnownMassItOnlyMeters) {
  DeviceProfile profile = frictionless(true);
  profile.mass = 0;
  PassivityObserver observer(profile);
  for (int tick = 0; tick < 500; ++tick) {
    const glm::dvec2 position(0.001 * std::sin(0.5 * tick), 0);
    const Force field(-9000.0 * position);
    ASSERT_EQ(observer(field, position, 1), field);
    observer.commanded(field);
  }
}

/// The work of a field on a hand in J: by the forces after the energy meter, and by the forces before it.
struct Work {
  double let = 0, asked = 0;
  long held = 0;
};

Work work_of(const std::function<glm::dvec2(glm::dvec2 position, glm::dvec2 velocity, double time)>& field,
             const Motion& path, double range, double active, double seconds) {
  const DeviceProfile profile = frictionless(true);
  EnergyMeter meter(profile);
  meter.allow(range, active);
  Work work;
  glm::dvec2 last{0}, last_let{0}, last_asked{0};
  for (long n = 0; n < std::lround(seconds * profile.rate); ++n) {
    const TracePoint at = wale::at(path, static_cast<double>(n) / profile.rate);
    const glm::dvec2 asked = field(at.position, at.velocity, at.time), let(meter(Force(asked), at.position, 1));
    if (n > 0) {
      work.asked += 0.5 * glm::dot(asked + last_asked, at.position - last);
      work.let += 0.5 * glm::dot(let + last_let, at.position - last);
    }
    last = at.position, last_let = let, last_asked = asked;
  }
  work.held = meter.held();
  return work;
}

TEST(EnergyMeter, DoesNotChangePotentialsAndResistances) {
  const auto conservative = [](glm::dvec2 place, glm::dvec2, double) { return -80.0 * place + ribs(1.9)(place); };
  const auto resisting = [](glm::dvec2 place, glm::dvec2 velocity, double) { return -3.0 * velocity + ribs(1)(place); };
  // 1/2 80 N/m (70 mm)^2, and for the ribs 1.9 N over half a period.
  const double range = 0.5 * 80 * 0.07 * 0.07 + 1.9 * 0.00125;
  for (const Motion& path : {Motion(Lateral{0.05, 1.3, {0.02, 0}}), Motion(Circular{0.03, 2, {0.01, 0.02}})}) {
    EXPECT_EQ(work_of(conservative, path, range, 0, 60).held, 0);
    EXPECT_EQ(work_of(resisting, path, range, 0, 60).held, 0);
  }
}

TEST(EnergyMeter, ASourceGivesItsRangeAndThenItsWatts) {
  const auto swirl = [](glm::dvec2 place, glm::dvec2, double) { return 20.0 * glm::dvec2(-place.y, place.x); };
  const auto pushing = [](glm::dvec2, glm::dvec2 velocity, double) { return 2.0 * velocity; };
  const auto own_beat = [](glm::dvec2, glm::dvec2, double time) {
    return glm::dvec2(2 * std::cos(2 * std::numbers::pi * time), 0);  // in step with the hand
  };
  const Lateral stroke{0.04, 1};
  const Circular circle{0.04, 1};
  struct Case {
    std::function<glm::dvec2(glm::dvec2, glm::dvec2, double)> field;
    Motion path;
  };
  for (const auto& [field, path] : {Case{swirl, circle}, Case{pushing, stroke}, Case{own_beat, stroke}})
    for (const double active : {0.0, 0.02}) {
      const double seconds = 30, range = 0.05;
      const Work work = work_of(field, path, range, active, seconds);
      ASSERT_GT(work.asked, 2 * (range + active * seconds));
      EXPECT_LE(work.let, range + (active + 0.002) * seconds + 1e-6);
      EXPECT_GE(work.let, 0.9 * (range + active * seconds)) << "the allowed energy is not withheld";
      EXPECT_GT(work.held, 0);
    }
}

/// The device's limit of active power holds where a program declares more.
TEST(EnergyMeter, TheDeviceLimitsTheActivePower) {
  constexpr double range = 0.01, seconds = 30;
  for (const double cap : {0.0, 0.02, 5.0}) {
    DeviceProfile profile = frictionless(true);
    profile.mass = 0;  // without a mass the passivity observer does not act
    profile.active_watt = cap;
    Guards guards(profile);
    guards.allow(range, 0.1);
    double given = 0;
    glm::dvec2 last(0), last_force(0);
    for (long n = 0; n < std::lround(seconds * profile.rate); ++n) {
      const TracePoint at = wale::at(Lateral{0.04, 1}, static_cast<double>(n) / profile.rate);
      const Force force = guards(Force(8.0 * at.velocity), at.position, 1);  // about 0.25 W
      if (n > 0) given += 0.5 * glm::dot(last_force + glm::dvec2(force), at.position - last);
      last = at.position, last_force = force;
    }
    const double watts = cap > 0 ? std::min(cap, 0.1) : 0.1;
    EXPECT_NEAR(given / seconds, watts, 0.1 * watts + 0.003) << cap;
    EXPECT_GT(guards.counts().energy, 0);
  }
}

}  // namespace
}  // namespace wale::closed_loop_test
