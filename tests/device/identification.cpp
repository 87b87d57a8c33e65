// Identification of a simulated handle with every orientation of axes and motors: free, in a loose hand, with friction,
// and blocked.
#include "runtime/device/identification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/runtime/programs.hpp"
#include "wale/simulated.hpp"

namespace wale::identification_test {
namespace {

using Lie = std::array<SignedAxis, 2>;

std::vector<Lie> every_lie() {
  std::vector<Lie> all;
  for (const int first : {0, 1})
    for (const int a : {1, -1})
      for (const int b : {1, -1}) all.push_back({{{first, a}, {1 - first, b}}});
  return all;
}

/// A handle with rotated or mirrored axes and motors. Its axis `axes[i].axis` grows, up to the sign, when the handle moves
/// to the right (i = 0) or away (i = 1), and its motor `motors[i].axis` pushes there.
class TurnedHandle {
 public:
  TurnedHandle(DeviceProfile profile, HandModel hand, Lie axes, Lie motors)
      : joystick_(std::move(profile), hand, Rest{}), axes_(axes), motors_(motors) {}

  glm::ivec2 counts() {
    joystick_.elapse(1);
    const Reading reading = joystick_.sample();
    glm::ivec2 own(0);
    for (std::size_t i = 0; i < 2; ++i) own[axes_[i].axis] = axes_[i].sign * reading.counts[static_cast<int>(i)];
    return own;
  }
  void push(Force own) {
    Force force(0);
    for (std::size_t i = 0; i < 2; ++i)
      force[static_cast<int>(i)] = static_cast<float>(motors_[i].sign) * own[motors_[i].axis];
    joystick_.command(force);
  }
  glm::dvec2 position() const { return joystick_.position(); }

 private:
  SimulatedJoystick joystick_;
  Lie axes_, motors_;
};

constexpr HandModel no_hand{.mass = 0, .damping = 0, .stiffness = 0};
constexpr long longest = 60'000;  // ticks

struct Ran {
  Identified found;
  double largest = 0;   // N, the largest command
  double steepest = 0;  // N, from tick to tick, while rising
  double furthest = 0;  // m from where it began
};

Ran identify(TurnedHandle& handle, const DeviceProfile& profile, const IdentifyOptions& options = {}) {
  Identification identification(profile, options);
  Ran ran;
  Force before(0);
  for (long tick = 0; !identification.is_done(); ++tick) {
    if (tick > longest) throw std::runtime_error("the identification does not end");
    const Force force = identification.tick(handle.counts());
    EXPECT_TRUE(force.x == 0 || force.y == 0) << "one motor at a time";
    ran.largest = std::max({ran.largest, double{std::abs(force.x)}, double{std::abs(force.y)}});
    for (const int axis : {0, 1})
      ran.steepest = std::max(ran.steepest, double{std::abs(force[axis])} - double{std::abs(before[axis])});
    ran.furthest = std::max(ran.furthest, glm::length(handle.position()));
    handle.push(before = force);
  }
  EXPECT_EQ(identification.tick({0, 0}), Force(0)) << "no force after the end";
  ran.found = identification.result();
  return ran;
}

/// Expects a correct wiring: with it, a push to the right moves the handle to the right, and its position says so.
void expect_right(const Identified& found, const Lie& axes, const Lie& motors) {
  ASSERT_TRUE(found.axes_settled && found.motors_settled) << found.problem;
  TurnedHandle handle(sandpaper(), no_hand, axes, motors);
  const glm::ivec2 before = handle.counts();
  for (const std::size_t i : {0u, 1u}) {
    const SignedAxis motor = (*found.motors_settled)[i];
    Force own(0);
    own[motor.axis] = static_cast<float>(2 * motor.sign);
    glm::ivec2 after = before;
    for (int tick = 0; tick < 100; ++tick) {
      handle.push(own);
      after = handle.counts();
    }
    const SignedAxis axis = (*found.axes_settled)[i], other = (*found.axes_settled)[1 - i];
    EXPECT_GT(axis.sign * (after - before)[axis.axis], 20);
    EXPECT_LT(std::abs((after - before)[other.axis]), i == 0 ? 2 : 10'000);
    if (i == 0) handle = TurnedHandle(sandpaper(), no_hand, axes, motors), handle.counts();
  }
}

TEST(Identification, FindsEveryOrderAndSignOfAxesAndMotors) {
  for (const Lie& axes : every_lie())
    for (const Lie& motors : every_lie()) {
      TurnedHandle handle(sandpaper(), no_hand, axes, motors);
      expect_right(identify(handle, sandpaper()).found, axes, motors);
    }
}

TEST(Identification, WorksInALooseHand) {
  const HandModel loose{.mass = 0.3, .damping = 3, .stiffness = 60};
  for (const Lie& motors : every_lie()) {
    const Lie straight{{{0, 1}, {1, 1}}};
    TurnedHandle handle(sandpaper(), loose, straight, motors);
    expect_right(identify(handle, sandpaper()).found, straight, motors);
  }
}

TEST(Identification, PushesWithLittleForceThatRisesSlowly) {
  TurnedHandle handle(sandpaper(), no_hand, {{{0, 1}, {1, 1}}}, {{{0, 1}, {1, 1}}});
  const Ran ran = identify(handle, sandpaper());
  EXPECT_LE(ran.largest, 1.0);  // friction is 0.15 N; a fifth of the device's force would be 2 N
  EXPECT_LE(ran.steepest, 2.0 / 900);
  EXPECT_LT(ran.furthest, 0.03);
  for (const MotorAnswer& answer : ran.found.motors) EXPECT_GT(answer.newton, sandpaper().friction);
}

TEST(Identification, FrictionAboveTheForceIsAProblem) {
  DeviceProfile stiff = sandpaper();
  stiff.friction = 3;  // N, and a fifth of 10 N is 2 N
  TurnedHandle handle(stiff, no_hand, {{{0, 1}, {1, 1}}}, {{{0, 1}, {1, 1}}});
  const Ran ran = identify(handle, stiff);
  EXPECT_FALSE(ran.found.motors_settled);
  EXPECT_EQ(ran.found.problem,
            "its x motor: nothing moved: its friction is greater than the force, or the handle is blocked");
  EXPECT_FLOAT_EQ(static_cast<float>(ran.largest), 2);
}

TEST(Identification, NeverPushesHarderThanTheUserAllows) {
  DeviceProfile stiff = sandpaper();
  stiff.friction = 1;
  TurnedHandle handle(stiff, no_hand, {{{0, 1}, {1, 1}}}, {{{0, 1}, {1, 1}}});
  const Ran ran = identify(handle, stiff, {.most_newton = 0.5});
  EXPECT_FALSE(ran.found.motors_settled);
  EXPECT_FLOAT_EQ(static_cast<float>(ran.largest), 0.5);
}

/// Runs an identification on a handle whose place (m) is a function of the force and the tick.
Ran steered(const std::function<glm::dvec2(Force, long)>& where, const IdentifyOptions& options = {}) {
  const DeviceProfile profile = sandpaper();
  Identification identification(profile, options);
  Ran ran;
  Force force(0);
  for (long tick = 0; !identification.is_done() && tick < longest; ++tick)
    force = identification.tick(glm::ivec2(where(force, tick) / profile.position_step()));
  EXPECT_TRUE(identification.is_done());
  ran.found = identification.result();
  return ran;
}

TEST(Identification, ABlockedAxisIsReported) {
  const Ran ran = steered([](Force force, long) { return glm::dvec2(0.01 * force.x, 0); });
  EXPECT_TRUE(ran.found.motors[0].moves);
  EXPECT_EQ(ran.found.problem,
            "its y motor: nothing moved: its friction is greater than the force, or the handle is blocked");
}

TEST(Identification, AnAxisThatIsBlockedOneWayIsFoundByTheOther) {
  const Ran ran =
      steered([](Force force, long) { return glm::dvec2(std::min(0.0f, 0.01f * force.x), -0.01 * force.y); });
  ASSERT_TRUE(ran.found.motors_settled);
  EXPECT_EQ((*ran.found.motors_settled)[0], (SignedAxis{0, 1}));
  EXPECT_EQ((*ran.found.motors_settled)[1], (SignedAxis{1, -1}));
}

TEST(Identification, AmbiguousMotionIsNotSettled) {
  const auto problem = [](const std::function<glm::dvec2(Force, long)>& where) { return steered(where).found.problem; };
  EXPECT_EQ(problem([](Force force, long) { return glm::dvec2(0.01 * (force.x + force.y)); }),
            "its x motor: the handle moved along both axes alike");
  EXPECT_EQ(problem([](Force force, long) { return glm::dvec2(0.01 * std::abs(force.x), 0.01 * force.y); }),
            "its x motor: the handle moved differently each way; perhaps a hand held it");
  EXPECT_EQ(problem([](Force force, long) { return glm::dvec2(0.01 * (force.x + force.y), 0); }),
            "both motors moved the handle along the same axis");
}

TEST(Identification, APersonShowsItsAxes) {
  // A stick that is turned by a quarter on the desk: its x grows away from the user, its y to the left. Its motors push
  // along its own axes.
  DeviceProfile profile = sandpaper();
  Identification identification(profile, {.asks = true});
  Force force(0);
  const double far = 0.3 * profile.workspace_diameter / 2;
  for (long tick = 0; !identification.is_done() && tick < longest; ++tick) {
    glm::dvec2 own = glm::dvec2(force) * 0.01;
    if (identification.request().find("to the right") != std::string_view::npos) own = {0, -far};
    if (identification.request().find("away from you") != std::string_view::npos) own = {far, 0};
    force = identification.tick(glm::ivec2(own / profile.position_step()));
  }
  const Identified found = identification.result();
  ASSERT_TRUE(found.axes_settled) << found.problem;
  EXPECT_EQ(*found.axes_settled, (Lie{{{1, -1}, {0, 1}}}));
  EXPECT_EQ(*found.motors_settled, (Lie{{{1, -1}, {0, 1}}}));
}

TEST(Identification, WithoutAnAnswerTheAxesStay) {
  const Ran ran =
      steered([](Force force, long) { return glm::dvec2(-0.01 * force.y, 0.01 * force.x); }, {.asks = true});
  ASSERT_TRUE(ran.found.axes_settled);
  EXPECT_EQ(*ran.found.axes_settled, (Lie{{{0, 1}, {1, 1}}}));
  EXPECT_EQ(*ran.found.motors_settled, (Lie{{{1, -1}, {0, 1}}}));
}

}  // namespace
}  // namespace wale::identification_test
