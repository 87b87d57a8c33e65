// Patches that move while they are felt, against a search of all patches.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::moving_test {
namespace {

/// A handle that the test moves and that notes its forces. It has no mass and the fastest slew, so the guards do not
/// change a program's force.
class Led : public Device {
 public:
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {
    ++ticks;
    if (lead) lead(ticks);
  }
  Reading sample() noexcept override { return {.counts = counts}; }
  Force command(Force force) noexcept override {
    commands.push_back(force);
    return force;
  }

  DeviceProfile profile_ = [] {
    DeviceProfile profile = sandpaper();
    profile.slew = 1e9, profile.mass = 0;
    return profile;
  }();
  long ticks = -1;                 // the beat that is served
  std::function<void(long)> lead;  // between this beat's patches and its position
  glm::ivec2 counts{0};
  std::vector<Force> commands;
};

RunResult run_of(Stage& stage, long ticks) {
  auto run = stage.run({.seconds = static_cast<double>(ticks) / 900, .virtual_time = true});
  if (!run) throw std::runtime_error(in_words(run.error()));
  return *std::move(run);
}

/// Like `push`, with an active power above any that occurs.
Program pushing(float force) {
  PatchProgram program = push(force).description();
  program.active_watt = 100;
  auto loaded = Program::load(std::move(program));
  return *std::move(loaded);
}

/// A patch on the workspace, for the plain search.
struct Lying {
  glm::vec2 position;
  PatchSize size;
  float layer, force;
};

float felt_at(const std::vector<Lying>& all, glm::dvec2 point) {
  const Lying* found = nullptr;
  for (const Lying& each : all) {
    const auto x = static_cast<float>(point.x - static_cast<double>(each.position.x));
    const auto y = static_cast<float>(point.y - static_cast<double>(each.position.y));
    if (std::abs(x) > each.size.width / 2 || std::abs(y) > each.size.height / 2) continue;
    if (!found || each.layer >= found->layer) found = &each;
  }
  return found ? found->force : 0;
}

TEST(Moving, TheFeltPatchIsThatOfASearchOfAllPatches) {
  std::mt19937 random(1995);
  std::uniform_real_distribution<float> place(-0.05f, 0.05f), size(0.004f, 0.04f), force(-0.3f, 0.3f);
  Led device;
  Stage stage(device);
  std::vector<Lying> lying;
  std::vector<Patch> patches;
  const auto add = [&] {
    const Lying next{{place(random), place(random)},
                     {.width = size(random), .height = size(random)},
                     static_cast<float>(random() % 3),
                     force(random)};
    patches.push_back(*stage.add(pushing(next.force), {.at = next.position, .size = next.size, .layer = next.layer}));
    lying.push_back(next);
  };
  for (int i = 0; i < 40; ++i) add();
  std::vector<float> expected;
  device.lead = [&](long tick) {
    device.counts += glm::ivec2(static_cast<int>(random() % 61) - 30, static_cast<int>(random() % 61) - 30);
    device.counts = glm::clamp(device.counts, glm::ivec2(-900), glm::ivec2(900));
    expected.push_back(felt_at(lying, glm::dvec2(device.counts) * device.profile_.position_step()));
    // Changes for the next beat.
    for (unsigned moves = random() % 4; moves > 0; --moves) {
      const std::size_t patch = random() % std::min<std::size_t>(lying.size(), tick < 1000 ? 5 : lying.size());
      lying[patch].position = {place(random), place(random)};
      EXPECT_TRUE(patches[patch].move(lying[patch].position));
    }
    if (random() % 20 == 0) {
      const std::size_t patch = random() % lying.size();
      lying[patch].force = force(random);
      EXPECT_TRUE(patches[patch].set("push", lying[patch].force));
    }
    if (random() % 100 == 0) add();
  };
  constexpr long ticks = 3000;
  run_of(stage, ticks);
  ASSERT_EQ(expected.size(), static_cast<std::size_t>(ticks));
  long felt = 0;
  for (long tick = 0; tick < ticks; ++tick) {
    ASSERT_EQ(device.commands[tick].x, expected[tick]) << tick;
    felt += expected[tick] != 0;
  }
  EXPECT_GT(felt, ticks / 4);
  EXPECT_GT(lying.size(), 50u);
  // A new run begins where the last one ended.
  device.commands.clear(), expected.clear();
  device.lead = [&](long) {
    device.counts = {static_cast<int>(random() % 1800) - 900, static_cast<int>(random() % 1800) - 900};
    expected.push_back(felt_at(lying, glm::dvec2(device.counts) * device.profile_.position_step()));
  };
  run_of(stage, 300);
  for (long tick = 0; tick < 300; ++tick) ASSERT_EQ(device.commands[tick].x, expected[tick]) << tick;
}

TEST(Moving, SlewsOnlyForThePatchUnderTheHand) {
  Led device;
  device.profile_.slew = 200;
  Stage stage(device);
  Patch patch = *stage.add(spring(50), {.size = PatchSize{.width = 0.02f, .height = 0.02f}});
  Patch another = *stage.add(spring(50), {.at = {0.1f, 0}, .size = PatchSize{.width = 0.02f, .height = 0.02f}});
  device.counts = {100, 0};  // 5.58 mm
  device.lead = [&](long tick) {
    EXPECT_TRUE(another.move({0.1f, 0.0001f * static_cast<float>(tick % 100)}));
    if (tick == 99) {
      EXPECT_TRUE(patch.move({0.01f, 0}));
    }
  };
  const RunResult run = run_of(stage, 200);
  const double here = 100 * sandpaper().position_step(), before = -50 * here, after = -50 * (here - 0.01);
  const double step = 200.0 / 900;
  EXPECT_NEAR(device.commands[50].x, before, 1e-5);
  EXPECT_NEAR(device.commands[99].x, before, 1e-5);
  EXPECT_NEAR(device.commands[100].x, before + step, 1e-5) << "within one tick";
  EXPECT_NEAR(device.commands[101].x, before + 2 * step, 1e-5);
  EXPECT_NEAR(device.commands[110].x, after, 1e-5);
  EXPECT_EQ(run.guards.slew, 1 + 2) << "at the start and after the move";
}

TEST(Moving, AHandThatStaysOnAPatchKeepsItsMemory) {
  Led device;
  Stage stage(device);
  Patch patch = *stage.add(bead(500));
  device.lead = [&](long tick) {
    if (tick == 9) {
      EXPECT_TRUE(patch.move({0.005f, 0}));
    }
  };
  run_of(stage, 20);
  EXPECT_EQ(device.commands[9].x, 0);
  // The bead keeps its place on the patch, 5 mm from the hand. After a new entry it would be at the hand.
  EXPECT_NEAR(device.commands[10].x, 500 * 0.005, 1e-4);
}

TEST(Moving, RefusesInvalidPlaces) {
  Led device;
  Stage stage(device);
  Patch patch = *stage.add(push(1));
  EXPECT_EQ(patch.move({std::nanf(""), 0}).error().sentence, "the position to which a patch is moved must be finite");
  EXPECT_FALSE(patch.move({0, std::numeric_limits<float>::infinity()}));
  EXPECT_TRUE(patch.move({0.5f, 0}));
  run_of(stage, 3);
  EXPECT_EQ(device.commands.at(1), Force(0)) << "it was moved before the run";
}

TEST(Moving, FromAnyThreadDuringARealTimeRun) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  Patch patch = *stage.add(corduroy(1));
  Patch another = *stage.add(spring(20), {.size = PatchSize{.width = 0.02f, .height = 0.02f}});
  std::atomic<bool> done = false;
  std::thread mover([&] {
    for (int i = 0; !done; ++i) {
      EXPECT_TRUE((i % 2 == 0 ? patch : another).move({0.001f * static_cast<float>(i % 7), 0}));
      std::this_thread::yield();
    }
  });
  const auto run = stage.run({.seconds = 0.3});
  done = true;
  mover.join();
  ASSERT_TRUE(run);
  EXPECT_EQ(run->ticks_run + run->ticks_missed, 270);
}

}  // namespace
}  // namespace wale::moving_test
