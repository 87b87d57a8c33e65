// Patches by their handles, edits, and what is refused.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/loop.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::handles_test {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

/// A device with the fastest slew and without a mass, so that the guards do not change a program's force.
DeviceProfile direct() {
  DeviceProfile profile = sandpaper();
  profile.slew = 1e9, profile.mass = 0;
  return profile;
}

/// `push` with an active power above any that occurs.
Program pushing(float force) {
  PatchProgram program = push(force).description();
  program.active_watt = 100;
  return *Program::load(std::move(program));
}

/// Steps a loop until all changes so far are felt, and gives the force.
Force settled(Loop& loop, const Stage& stage, long revision, const Reading& reading = {}) {
  Force force = loop.step(reading);
  while (stage.now().revision < revision) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    force = loop.step(reading);
  }
  return force;
}

TEST(Handles, NameNothingOnceThePatchOrTheStageIsGone) {
  Patch never;
  EXPECT_FALSE(never.exists());
  EXPECT_EQ(never.set("push", 1).error().code, Code::wrong_moment);
  std::optional<Stage> stage(std::in_place, direct());
  Patch first = *stage->add(push(1)), copy = first;
  EXPECT_EQ(first, copy);
  EXPECT_TRUE(first.remove());
  EXPECT_EQ(copy.remove().error().code, Code::wrong_moment);
  Patch second = *stage->add(push(2));
  EXPECT_EQ(second.number(), first.number()) << "the slot is used again";
  EXPECT_NE(second, first);
  EXPECT_FALSE(first.exists());
  EXPECT_FALSE(first.set("push", 1));
  EXPECT_EQ(second.bank()->registers()[first_constant + 2], 2);
  EXPECT_EQ(stage->size(), 1u);
  StageEdit edit = stage->edit();
  edit.set(second, "push", 3);
  stage.reset();
  for (const auto& deed : {second.set("push", 1), second.move({0, 0}), second.resize({.width = 1, .height = 1}),
                           second.replace(push(1)), second.enable(), second.bring({}), second.remove(), edit.commit()})
    EXPECT_EQ(deed.error().code, Code::wrong_moment);
  EXPECT_FALSE(second.bank());
  EXPECT_FALSE(second.snapshot());
}

TEST(Handles, RefuseWhatMakesNoSense) {
  Stage stage(direct());
  const auto refused = [&](const PatchOptions& options) {
    const auto added = stage.add(push(1), options);
    return added ? Code{} : added.error().code;
  };
  for (const float bad : {none, infinite, -infinite}) {
    EXPECT_EQ(refused({.at = {bad, 0}}), Code::malformed_value);
    EXPECT_EQ(refused({.at = {0, bad}}), Code::malformed_value);
    EXPECT_EQ(refused({.layer = bad}), Code::malformed_value);
    EXPECT_EQ(refused({.size = PatchSize{.width = bad, .height = 1}}), Code::malformed_value);
    EXPECT_EQ(refused({.size = PatchSize{.width = 1, .height = 1, .rim = bad}}), Code::malformed_value);
  }
  for (const float bad : {0.0f, -1.0f}) EXPECT_EQ(refused({.size = PatchSize{1, bad, 0}}), Code::malformed_value);
  EXPECT_EQ(refused({.size = PatchSize{1, 1, -0.1f}}), Code::malformed_value);
  EXPECT_EQ(stage.size(), 0u);
  Patch patch = *stage.add(push(1));
  EXPECT_EQ(patch.resize({.width = -1, .height = 1}).error().code, Code::malformed_value);
  EXPECT_EQ(patch.bring({.layer = none}).error().code, Code::malformed_value);
  EXPECT_EQ(patch.move({none, 0}).error().code, Code::malformed_value);
  EXPECT_EQ(patch.set("push", none).error().code, Code::malformed_value);
  EXPECT_EQ(patch.set("pull", 1).error().code, Code::unknown_name);
  PatchProgram other = push(1).description();
  other.device.name = "another";
  EXPECT_EQ(stage.add(*Program::load(other)).error().code, Code::other_device);
  EXPECT_EQ(patch.replace(*Program::load(other)).error().code, Code::other_device);
}

TEST(Handles, ChangeWhatTheHandFeels) {
  Stage stage(direct());
  Patch back = *stage.add(pushing(1)), front = *stage.add(pushing(2));
  auto loop = Loop::begin(stage);
  ASSERT_TRUE(loop);
  EXPECT_EQ(settled(*loop, stage, 1).x, 2);
  const auto becomes = [&](const Result<>& done, float expected) {
    EXPECT_TRUE(done) << in_words(done.error());
    float force = loop->step({}).x;
    for (int i = 0; i < 5000 && force != expected; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      force = loop->step({}).x;
    }
    EXPECT_EQ(force, expected);
  };
  becomes(front.set("push", 2.5f), 2.5f);
  becomes(front.enable(false), 1);
  becomes(front.enable(), 2.5f);
  becomes(back.bring({.layer = 0}), 1);
  becomes(front.bring({.layer = 0}), 2.5f);
  becomes(back.bring({.layer = 1}), 1);
  becomes(back.move({0.1f, 0}), 2.5f);
  becomes(back.move({0, 0}), 1);
  becomes(back.resize({.width = 0.001f, .height = 0.001f}), 1);
  becomes(back.move({0.001f, 0}), 2.5f);
  becomes(front.replace(pushing(3)), 2.5f);  // the parameter was set, and is kept
  becomes(front.remove(), 0);
  EXPECT_FALSE(stage.now().patch);
  becomes(back.move({0, 0}), 1);
  ASSERT_TRUE(stage.now().patch);
  EXPECT_EQ(*stage.now().patch, back);
}

TEST(Edits, AreFeltAtOneTickOrNotAtAll) {
  Stage stage(direct());
  Patch one = *stage.add(pushing(1)), other = *stage.add(pushing(2), {.at = {0.2f, 0}});
  auto loop = Loop::begin(stage);
  ASSERT_TRUE(loop);
  (void)settled(*loop, stage, 1);
  std::atomic<bool> done = false;
  std::thread changing([&] {
    for (int i = 1; i <= 200; ++i) {
      StageEdit edit = stage.edit();
      edit.move(one, {i % 2 == 0 ? 0 : 0.2f, 0});
      edit.move(other, {i % 2 == 0 ? 0.2f : 0, 0});
      // Its bank is new each time, so the moves wait for it.
      edit.set(i % 2 == 0 ? one : other, "push", 3 + 0.01f * static_cast<float>(i));
      EXPECT_TRUE(edit.commit());
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    done = true;
  });
  float last = 1;
  long changes = 0;
  while (!done) {
    const float force = loop->step({}).x;
    // Never both away, never the old value of the one that came.
    EXPECT_TRUE(force == 1 || force > 3) << force;
    changes += force != last;
    last = force;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  changing.join();
  EXPECT_GT(changes, 3);
}

TEST(Edits, WithAMistakeChangeNothing) {
  Stage stage(direct());
  Patch patch = *stage.add(push(1));
  StageEdit edit = stage.edit();
  Patch added = *edit.add(push(2));
  EXPECT_FALSE(added.exists()) << "not before it is committed";
  edit.set(patch, "push", 4);
  edit.set(added, "push", 100);
  const auto committed = edit.commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, Code::malformed_value);
  EXPECT_FALSE(added.exists());
  EXPECT_EQ(patch.bank()->registers()[first_constant + 2], 1);
  EXPECT_TRUE(edit.commit()) << "it is empty now";
  Patch again = *edit.add(push(2));
  edit.set(again, "push", 5);
  edit.move(patch, {0.1f, 0});
  EXPECT_TRUE(edit.commit());
  EXPECT_EQ(again.bank()->registers()[first_constant + 2], 5);
  edit.remove(patch);
  edit.set(patch, "push", 1);
  EXPECT_EQ(edit.commit().error().code, Code::wrong_moment) << "after its removal";
  EXPECT_TRUE(patch.exists());
  Stage elsewhere(direct());
  StageEdit foreign = elsewhere.edit();
  foreign.move(patch, {0, 0});
  EXPECT_EQ(foreign.commit().error().code, Code::wrong_moment);
  {
    StageEdit forgotten = stage.edit();
    EXPECT_TRUE(forgotten.add(push(1)));
  }
  EXPECT_EQ(stage.size(), 2u);
}

TEST(Edits, APatchOfAnEditIsNotThereBeforeTheCommit) {
  Stage stage(sandpaper());
  StageEdit edit = stage.edit();
  Patch added = *edit.add(push(1));
  const auto early = added.set("push", 2);
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().code, Code::wrong_moment);
  EXPECT_NE(early.error().mend.find("commit"), std::string::npos);
  EXPECT_FALSE(added.exists());
  ASSERT_TRUE(edit.commit());
  EXPECT_TRUE(added.set("push", 2));
  std::optional<StageEdit> abandoned(stage.edit());
  Patch never = *abandoned->add(push(1));
  abandoned.reset();
  EXPECT_EQ(never.set("push", 2).error().mend.find("commit"), std::string::npos) << "nobody can commit it any more";
}

TEST(Handles, NumbersOfRemovedPatchesAreUsedAgain) {
  for (const bool running : {false, true}) {
    Stage stage(direct());
    std::optional<Result<Loop>> loop;
    if (running) loop.emplace(Loop::begin(stage));
    std::vector<Patch> there;
    std::uint32_t greatest = 0;
    const Program program = push(1);
    for (int i = 0; i < 5000; ++i) {
      there.push_back(*stage.add(program, {.at = {0.001f * static_cast<float>(i % 100), 0}}));
      greatest = std::max(greatest, there.back().number());
      if (there.size() > 50) {
        EXPECT_TRUE(there.front().remove());
        there.erase(there.begin());
      }
      if (loop && i % 10 == 0) (void)settled(**loop, stage, stage.now().revision + 1);
    }
    EXPECT_EQ(stage.size(), 50u);
    EXPECT_LT(greatest, running ? 200u : 51u);
  }
}

}  // namespace
}  // namespace wale::handles_test
