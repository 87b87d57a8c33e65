// What a run says of one of its patches, and when it says nothing.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/felt.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::felt_patch_test {
namespace {

constexpr PatchSize half{.width = 0.1f, .height = 0.1f, .rim = 0.005f};

/// A hand that goes to and fro over two patches, one on each side of the middle.
struct TwoPatches {
  SimulatedJoystick joystick{sandpaper(), normal_hand(), Lateral{0.04, 1}};
  Stage stage{joystick};
  Patch left = *stage.add(push(1), {.at = {-0.05f, 0}, .size = half});
  Patch right = *stage.add(push(2), {.at = {0.05f, 0}, .size = half});

  RunResult run(const RunOptions& options = {.seconds = 2, .virtual_time = true}) {
    auto done = stage.run(options);
    EXPECT_TRUE(done) << in_words(done.error());
    return done ? *std::move(done) : RunResult();
  }
};

Code code_of(const auto& result) {
  EXPECT_FALSE(result);
  return result ? Code{} : result.error().code;
}

TEST(FeltPatch, OnlyTicksOnThePatchCount) {
  TwoPatches two;
  const RunResult run = two.run();
  for (const bool is_left : {true, false}) {
    long ticks = 0;
    float largest = 0, smallest = 100;
    for (const TickRecord& tick : run.record.ticks) {
      if (tick.time < 0.5 || !tick.inside || (tick.position.x < 0) != is_left) continue;
      ++ticks;
      largest = std::max(largest, tick.force.x), smallest = std::min(smallest, tick.force.x);
    }
    ASSERT_GT(ticks, 200);
    const auto felt = measure(run, is_left ? two.left : two.right, {.settling = 0.5});
    ASSERT_TRUE(felt) << in_words(felt.error());
    EXPECT_NEAR(static_cast<double>(felt->felt.ticks), static_cast<double>(ticks), 10) << "the middle is one or the other's";
    EXPECT_FLOAT_EQ(felt->felt.force.maximum, largest);
    // 1 N or 2 N but for the moments of crossing over.
    EXPECT_NEAR(felt->felt.force.rms, is_left ? 1 : 2, 0.1);
  }
}

TEST(FeltPatch, EachPatchHasTheLevelOfItsOwnProgram) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  // Between them the force comes to rest, so that neither begins with the force of the other.
  const Patch rough = *stage.add(corduroy(1.934f), {.at = {-0.053f, 0}, .size = half});
  const Patch fine = *stage.add(corduroy(0.8f), {.at = {0.053f, 0}, .size = half});
  const auto run = stage.run({.seconds = 5, .virtual_time = true});
  ASSERT_TRUE(run);
  for (const auto& [patch, amplitude] : {std::pair(rough, 1.934f), std::pair(fine, 0.8f)}) {
    const auto felt = measure(*run, patch, {.settling = 0.5});
    ASSERT_TRUE(felt) << in_words(felt.error());
    EXPECT_NEAR(felt->felt.force_rubbing.p99, amplitude, 0.02 * amplitude + 10.0 / 2048);
  }
}

TEST(FeltPatch, APatchThatWasNotTouchedIsNotMeasured) {
  TwoPatches two;
  const Patch far = *two.stage.add(push(1), {.at = {0, 0.08f}, .size = PatchSize{.width = 0.01f, .height = 0.01f}});
  const auto felt = measure(two.run(), far);
  ASSERT_EQ(code_of(felt), Code::not_measured);
  EXPECT_NE(felt.error().sentence.find("never on the patch"), std::string::npos);
  EXPECT_FALSE(felt.error().mend.empty());
}

TEST(FeltPatch, APatchOfAnotherStageIsRefused) {
  TwoPatches two, other;
  EXPECT_EQ(code_of(measure(two.run(), other.left)), Code::wrong_moment);
}

TEST(FeltPatch, APatchThatHasChangedSinceTheRunIsRefused) {
  TwoPatches two;
  const RunResult run = two.run();
  ASSERT_TRUE(two.left.set("push", 3));
  const auto changed = measure(run, two.left);
  ASSERT_EQ(code_of(changed), Code::wrong_moment);
  EXPECT_NE(changed.error().sentence.find("changed since the run"), std::string::npos);
  ASSERT_TRUE(two.left.set("push", 1));
  EXPECT_TRUE(measure(run, two.left)) << "it is as it was";
  ASSERT_TRUE(two.left.move({-0.06f, 0}));
  EXPECT_TRUE(measure(run, two.left)) << "a place is no figure of it";
  two.run();
  EXPECT_TRUE(measure(run, two.left)) << "a later run changes nothing";
  ASSERT_TRUE(two.left.replace(push(4)));
  EXPECT_EQ(code_of(measure(run, two.left)), Code::wrong_moment);
  ASSERT_TRUE(two.right.remove());
  EXPECT_EQ(code_of(measure(run, two.right)), Code::wrong_moment);
}

TEST(FeltPatch, AfterAChangeDuringTheRunOnlyTheNewTicksCount) {
  TwoPatches two;
  RunOptions options{.seconds = 4, .virtual_time = true};
  options.progress = [&](const Now& now) {
    if (now.time > 1 && now.time < 1.11) {
      ASSERT_TRUE(two.left.set("push", 3));
    }
  };
  const RunResult run = two.run(options);
  const auto felt = measure(run, two.left, {.settling = 0.5});
  ASSERT_TRUE(felt) << in_words(felt.error());
  EXPECT_NEAR(felt->felt.force.rms, 3, 0.15);
}

TEST(FeltPatch, ARunWithoutARecordSaysSo) {
  TwoPatches two;
  ASSERT_TRUE(two.stage.start());
  const auto stopped = two.stage.stop();
  ASSERT_TRUE(stopped);
  const auto felt = measure(*stopped, two.left);
  ASSERT_EQ(code_of(felt), Code::not_measured);
  EXPECT_NE(felt.error().sentence.find("kept no record"), std::string::npos);
}

TEST(FeltPatch, OptionsOutsideTheirRangeAreRefused) {
  TwoPatches two;
  const RunResult run = two.run();
  const auto refused = [&](const MeasureOptions& options, long least, const char* name) {
    const auto felt = measure(run, two.left, options, least);
    ASSERT_EQ(code_of(felt), Code::malformed_value) << name;
    EXPECT_EQ(felt.error().place.name, name);
  };
  refused({.settling = -1}, 50, "settling");
  refused({.settling = HUGE_VAL}, 50, "settling");
  refused({.stuck_seconds = NAN}, 50, "stuck_seconds");
  refused({.stuck_counts = -0.5}, 50, "stuck_counts");
  refused({}, -3, "least_crossings");
  EXPECT_TRUE(measure(run, two.left, {}, 0));
}

TEST(FeltPatch, ASettlingLongerThanTheRunIsNamed) {
  TwoPatches two;
  const auto felt = measure(two.run(), two.left, {.settling = 9});
  ASSERT_EQ(code_of(felt), Code::not_measured);
  EXPECT_NE(felt.error().sentence.find("settling"), std::string::npos);
  EXPECT_FALSE(felt.error().mend.empty());
}

}  // namespace
}  // namespace wale::felt_patch_test
