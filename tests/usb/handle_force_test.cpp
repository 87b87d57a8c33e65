// What is promised at the handle, in newtons: whatever is commanded and however packets come through, no packet leaves
// the device pushing harder than its trusted declaration and its user allow. The forces are those of the devices'
// models, which know no driver.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <thread>
#include <vector>

#include "runtime/device/falcon/falcon_plane.hpp"
#include "tests/usb/evdev_fake.hpp"
#include "tests/usb/falcon_bus.hpp"
#include "tests/usb/hidraw_fake.hpp"
#include "tests/usb/pid_bus.hpp"
#include "tests/usb/profiles.hpp"

namespace wale::test::handle_force {
namespace {

constexpr double newton = 10;      // of a model's full force along one axis
constexpr double rounding = 1e-9;  // of the model's own arithmetic

/// N at the handle of what a model's motors exert.
glm::dvec2 at_handle(const PidModel& model, const ForceLimits& limits) { return model.force() * limits.full(); }

/// How two effects or one are used, in each family: as it comes, without directions, and with room for one effect.
std::vector<PidFamily> all_arrangements() {
  std::vector<PidFamily> all;
  for (const PidFamily& family : all_families()) {
    all.push_back(family);
    all.push_back(family);
    all.back().has_direction = false;
    if (!family.has_pool) continue;
    all.push_back(family);
    all.back().simultaneous = 1;
  }
  return all;
}

/// Commands as programs give them: still ones, turning ones, jumps, and what is no force at all.
class Commands {
 public:
  explicit Commands(unsigned seed) : random_(seed) {}

  glm::dvec2 next() {
    if (left_-- == 0) {
      kind_ = static_cast<int>(random_() % 6);
      left_ = static_cast<int>(random_() % 60);
      held_ = {uniform_(random_), uniform_(random_)};
    }
    angle_ += 0.2;
    switch (kind_) {
      case 0: return held_;
      case 1: return {std::cos(angle_), std::sin(angle_)};
      case 2: return {uniform_(random_), uniform_(random_)};
      case 3: return random_() % 2 == 0 ? glm::dvec2(1, 0) : glm::dvec2(0, 1);
      case 4:
        return std::array<glm::dvec2, 4>{glm::dvec2(std::nan(""), 1), glm::dvec2(HUGE_VAL, -HUGE_VAL),
                                         glm::dvec2(5e-324, -1e300), glm::dvec2(-1, -1)}[random_() % 4];
      default: return held_ * std::sin(5 * angle_);
    }
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{-1.5, 1.5};
  int kind_ = 0, left_ = 0;
  glm::dvec2 held_{0};
  double angle_ = 0;
};

TEST(HandleForce, WhatTheOtherAxisStillHoldsCounts) {
  PidModel model(openffboard());
  PidBus bus(model, {.limits = {.peak = glm::dvec2(newton), .most_newton = 5}});
  bus.settle();
  const auto settle_at = [&](glm::dvec2 share) {
    double most = 0;
    for (int i = 0; i < 10; ++i) {
      bus.command(share, bus.now);
      bus.frame();
      most = std::max(most, newton * glm::length(model.force()));
    }
    return most;
  };
  EXPECT_NEAR(settle_at({0.5, 0}), 5, 1e-3);
  EXPECT_NEAR(settle_at({0, 0.5}), 5, 1e-3) << "and not 7.1 N in between";
  EXPECT_NEAR(newton * model.force().y, 5, 1e-3);
  EXPECT_NEAR(model.force().x, 0, 1e-12);
}

TEST(HandleForce, NoPacketOfAPidSessionExceedsTheLimits) {
  unsigned seed = 0;
  for (const PidFamily& family : all_arrangements())
    for (const int in_flight : {1, 2, 4})
      for (const glm::dvec2 gain : {glm::dvec2(1), glm::dvec2(2, 0.3)}) {
        PidModel model(family);
        model.logs = model.moves = false;
        model.faults.late = static_cast<int>(seed % 3);
        const double most = std::array{0.5, 3.0, 9.0, HUGE_VAL}[++seed % 4];
        const ForceLimits limits{.gain = gain, .peak = glm::dvec2(newton), .most_newton = most};
        PidBus bus(model, {.limits = limits, .most_in_flight = in_flight});
        bus.settle();
        ASSERT_EQ(bus.session.state(), hid::PidSession::State::running) << family.name;
        Commands commands(seed);
        for (int frame = 0; frame < 1500; ++frame) {
          if (frame % 2 == 0) bus.command(commands.next(), bus.now);
          bus.frame();
          ASSERT_LE(glm::length(at_handle(model, limits)), most * (1 + rounding))
              << family.name << ", frame " << frame << ", " << in_flight << " in flight, gain " << gain.x;
          // A direction of eight bits lets an effect push a little along the other axis too: 1.4 degrees.
          for (int axis = 0; axis < 2; ++axis)
            ASSERT_LE(std::abs(at_handle(model, limits)[axis]), newton * 1.03) << family.name;
        }
        EXPECT_EQ(model.wrong_reports, 0) << family.name;
        // And it gives what is allowed: all but a few steps, or what turning by eight bits costs.
        for (int frame = 0; frame < 30; ++frame) {
          bus.command({1, 0.7}, bus.now);
          bus.frame();
        }
        const bool is_one = bus.session.arrangement() == hid::Arrangement::combined;
        const glm::dvec2 share = hid::within(limits, {1, 0.7});
        const double asked = glm::length(share * limits.full()) / (is_one ? std::max(1.0, glm::length(share)) : 1);
        const double steps = 3 * glm::length(limits.full()) / family.magnitude_maximum;
        EXPECT_GE(glm::length(at_handle(model, limits)), 0.98 * asked - steps)
            << family.name << ", " << in_flight << " in flight, gain " << gain.x << ", at most " << most;
      }
}

/// Waits for a thread of the driver; throws when it has waited for long.
template <class Condition>
void wait_until(Condition holds) {
  for (int look = 0; look < 20'000; ++look) {
    if (holds()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  throw std::runtime_error("awaited in vain");
}

TEST(HandleForce, HidrawKeepsWithinTheUsersLimit) {
  PidModel model(openffboard());
  model.logs = model.moves = false;
  double most = 0;
  HidrawFake fake{std::move(model)};
  // After each report: the one before it is in force when the next one comes.
  fake.with_model([&](PidModel& of) {
    of.when_taken = [&](const auto&) { most = std::max(most, newton * glm::length(of.force())); };
  });
  HidPidDevice::Options options = NodeFake::options();
  options.most_newton = 4;
  const auto opened = HidPidDevice::open(nullptr, fake.descriptor(), trusted(joystick_profile()), options);
  ASSERT_TRUE(opened) << in_words(opened.error());
  HidPidDevice& device = **opened;
  Commands commands(7);
  wait_until([&] {
    const glm::dvec2 share = commands.next();
    device.command(Force(newton * share));
    return device.counts().forces_sent[0] > 200 && device.counts().forces_sent[1] > 200;
  });
  wait_until([&] {
    device.command({3, 4});
    return fake.with_model([&](PidModel& of) { return newton * glm::length(of.force()); }) > 3.99;
  });
  const Force exerted = device.command({3, 4});
  EXPECT_NEAR(exerted.x, 2.4, 1e-3) << "what it says is what it exerts";
  EXPECT_NEAR(exerted.y, 3.2, 1e-3);
  EXPECT_LE(fake.with_model([&](PidModel&) { return most; }), 4 * (1 + rounding));
}

TEST(HandleForce, NoUpdateOfEvdevExceedsTheLimitInAnyOrder) {
  EvdevFake fake;
  HidPidDevice::Options options = NodeFake::options();
  options.most_newton = 4;
  const auto opened = HidPidDevice::open(nullptr, fake.descriptor(), trusted(joystick_profile(), {1, 0.5}), options);
  ASSERT_TRUE(opened) << in_words(opened.error());
  HidPidDevice& device = **opened;
  EXPECT_EQ(device.arrangement(), hid::Arrangement::combined);
  Commands commands(8);
  wait_until([&] {
    const glm::dvec2 share = commands.next();
    device.command(Force(newton * share));
    return device.counts().forces_sent[0] > 200;
  });
  wait_until([&] {
    device.command({4, 0});
    return newton * fake.force().x > 3.99;
  });
  // Each update's level acts along the direction of any other one: the queue may have dropped what came between.
  int levels = 0;
  for (const std::string& line : fake.log()) {
    int effect = 0, level = 0, toward = 0;
    if (std::sscanf(line.c_str(), "upload %d level %d toward %d", &effect, &level, &toward) != 3) continue;
    ++levels;
    EXPECT_LE(newton * std::abs(level) / 32767, 4 * (1 + rounding)) << line;
    EXPECT_TRUE(effect == 0 || level == 0) << line;
  }
  EXPECT_GT(levels, 100);
}

TEST(HandleForce, EvdevsTwoEffectsKeepWithinThePeakByThemselves) {
  EvdevFake fake;
  const auto opened =
      HidPidDevice::open(nullptr, fake.descriptor(), trusted(joystick_profile(), {2, 1}), NodeFake::options());
  ASSERT_TRUE(opened) << in_words(opened.error());
  wait_until([&] {
    (*opened)->command({50, -50});
    const glm::dvec2 force = fake.force();
    return force.x > 0.49 && force.y > 0.99;
  });
  EXPECT_LE(fake.force().x * 2 * newton, newton * (1 + rounding)) << "a gain of 2: half of its steps are the peak";
}

using namespace falcon;

/// The model's force for these torques, with the handle where the encoders say.
glm::dvec3 exerted(const Torques& torques, const Encoders& encoders) {
  FalconModel model;
  model.place = *forward(angles_of(encoders));
  model.torques = {torques[0], torques[1], torques[2]};
  model.step();
  return model.force();
}

TEST(HandleForce, NoTorquesExceedTheLimitsWhereverTheFalconsHandleIs) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const double most = std::array{0.05, 0.5, 3.0, HUGE_VAL}[static_cast<std::size_t>(i) % 4];
    const double full = FalconModel::full_newton;
    const TorqueGate gate({.peak = glm::dvec2(full), .most_newton = most}, 3);
    const glm::dvec3 place =
        workspace_centre + glm::dvec3(0.045 * unit(random), 0.045 * unit(random), 0.02 * unit(random));
    const Encoders encoders = encoders_of(*inverse(place));
    Torques torques{};
    for (auto& each : torques) each = static_cast<std::int16_t>(4096 * unit(random));
    const Torques allowed = gate.within(torques, encoders);
    const glm::dvec3 force = exerted(allowed, encoders), whole = exerted(torques, encoders);
    ASSERT_LE(glm::length(force), most * (1 + 1e-6));
    ASSERT_LE(std::max(std::abs(force.x), std::abs(force.y)), full * (1 + 1e-6));
    ASSERT_LE(std::abs(force.z), 3 * (1 + 1e-6));
    const double share = std::min(
        {1.0, most / glm::length(whole), full / std::abs(whole.x), full / std::abs(whole.y), 3 / std::abs(whole.z)});
    EXPECT_GE(glm::length(force), share * glm::length(whole) * 0.98 - 0.02) << "and gives nearly what is allowed";
  }
  EXPECT_EQ(TorqueGate().within({100, 100, 100}, encoders_of(*inverse(workspace_centre))), Torques{});
  EXPECT_EQ(TorqueGate({.peak = glm::dvec2(8)}, 3).within({100, 100, 100}, {30000, -30000, 30000}), Torques{});
}

TEST(HandleForce, AMovingFalconKeepsWithinTheUsersLimitWithItsHold) {
  for (const double most : {0.5, 3.0}) {
    const ForceLimits limits = for_moving_handle({.peak = glm::dvec2(FalconModel::full_newton), .most_newton = most});
    FalconSessionOptions options;
    options.gate = TorqueGate(limits, HoldInPlane{}.most);
    FalconModel model({}, true);
    model.logs = false;
    FalconBus bus(model, options);
    FalconPlane plane(limits);
    ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == FalconSession::State::running; }));
    Commands commands(9);
    double largest = 0, fastest = 0;
    for (int tick = 0; tick < 4000; ++tick) {
      // A hand that leaves the plane, at half a metre a second.
      const double time = tick * 1e-3;
      model.hand = workspace_centre +
                   glm::dvec3(0.035 * std::sin(14 * time), 0.03 * std::cos(9 * time), 0.015 * std::sin(3 * time));
      model.hand_stiffness = 1000;
      ASSERT_TRUE(plane.see(bus.session.answer()->encoders, bus.session.heard()));
      const glm::dvec2 share = commands.next();
      bus.session.command(plane.push(FalconModel::full_newton * share, bus.now).torques, bus.now);
      bus.frame();
      largest = std::max(largest, glm::length(model.force()));
      fastest = std::max(fastest, glm::length(model.velocity));
    }
    EXPECT_GT(fastest, 0.3);
    EXPECT_GT(largest, 0.95 * most);
    EXPECT_LE(largest, most) << "also while the handle moves on after its encoders answered";
  }
}

TEST(HandleForce, AFalconThatHasNotAnsweredForLongGetsNoTorque) {
  FalconSessionOptions options;
  options.gate = TorqueGate({.peak = glm::dvec2(8)}, 3);
  FalconModel model({}, true);
  FalconBus bus(model, options);
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == FalconSession::State::running; }));
  const auto push = [&] {
    bus.session.command({500, 0, 0}, bus.now);
    bus.frame();
  };
  for (int i = 0; i < 10; ++i) push();
  EXPECT_EQ(model.torques.x, 500);
  model.faults.mute_after = model.answers;
  for (int i = 0; i < 60; ++i) push();
  EXPECT_EQ(model.torques, glm::ivec3(0)) << "where the handle is now, nobody knows";
}

}  // namespace
}  // namespace wale::test::handle_force
