// What a child of `fork` has of its parent's stages, what is left of a thing that was moved from, and one device for two
// stages.
#include <gtest/gtest.h>

#include <climits>
#include <limits>
#include <memory>
#include <optional>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/forked.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/batch.hpp"
#include "wale/devices.hpp"
#include "wale/loop.hpp"
#include "wale/stage.hpp"

namespace wale::forking_test {
namespace {

/// A device that rests at its centre, and that notes commands.
class Resting : public Device {
 public:
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override { return reading; }
  Force command(Force force) noexcept override {
    commands.fetch_add(1);
    return answers ? *answers : force;
  }

  Reading reading;
  std::optional<Force> answers;
  std::atomic<long> commands = 0;

 private:
  DeviceProfile profile_ = sandpaper();
};

bool is_wrong_moment(const auto& result) { return !result && result.error().code == Code::wrong_moment; }

TEST(Forking, LeavesStagesToTheParent) {
  Resting device;
  std::optional<Stage> stage(std::in_place, device);
  Patch patch = *stage->add(push(1));
  std::optional<StageEdit> edit(stage->edit());
  edit->move(patch, {0, 0});
  ASSERT_TRUE(stage->start());
  const int left = in_a_child([&] {
    const long commands = device.commands;
    if (!is_wrong_moment(stage->start()) || !is_wrong_moment(stage->stop())) return 1;
    if (!is_wrong_moment(stage->run({.seconds = 0.01, .virtual_time = true}))) return 2;
    if (!is_wrong_moment(stage->add(push(1)))) return 3;
    if (!is_wrong_moment(patch.set("push", 1)) || !is_wrong_moment(patch.snapshot()) || patch.exists()) return 4;
    if (!is_wrong_moment(edit->commit())) return 5;
    if (stage->is_running() || stage->poll() != 0 || stage->now().ticks_run != 0) return 6;
    edit.reset();
    stage.reset();
    if (device.commands != commands) return 7;
#if !defined(__SANITIZE_THREAD__)  // it allows no threads after a fork
    // The child's own.
    Resting own;
    Stage another(own);
    if (!another.add(push(1)) || !another.run({.seconds = 0.01, .virtual_time = true})) return 8;
    if (!another.start() || !another.stop()) return 9;
#endif
    return 0;
  });
  EXPECT_EQ(left, 0);
  EXPECT_TRUE(stage->is_running()) << "the parent's run goes on";
  EXPECT_TRUE(stage->stop());
}

TEST(Forking, LeavesLoopsToTheParent) {
  Stage stage(sandpaper());
  ASSERT_TRUE(stage.add(push(1)));
  std::optional<Loop> loop(*Loop::begin(stage));
  const int left = in_a_child([&] {
    if (loop->step({}) != Force(0)) return 1;
    loop->exerted(Force(1));
    if (!is_wrong_moment(Loop::begin(stage))) return 2;
    loop.reset();
    return 0;
  });
  EXPECT_EQ(left, 0);
}

TEST(Forking, LeavesOpenedDevicesToTheParentAlsoSimulatedOnes) {
  auto device = open_device("simulated:sandpaper", {.hand = normal_hand()});
  ASSERT_TRUE(device) << in_words(device.error());
  Stage made_before(**device);
  const int left = in_a_child([&] {
    if ((*device)->sample().contact != Contact::lost || (*device)->command({1, 1}) != Force(0)) return 1;
    Stage stage(**device);
    const auto started = stage.start();
    if (!is_wrong_moment(started) || started.error().place.name != "device") return 2;
    device->reset();
    return 0;
  });
  EXPECT_EQ(left, 0);
  EXPECT_TRUE(made_before.start());
  EXPECT_TRUE(made_before.stop());
}

TEST(MovedFrom, ThingsSayIt) {
  Stage stage(sandpaper());
  const Patch patch = *stage.add(push(1));
  StageEdit edit = stage.edit();
  StageEdit taken(std::move(edit));
  // NOLINTBEGIN(bugprone-use-after-move)
  edit.set(patch, "push", 1), edit.move(patch, {0, 0}), edit.resize(patch, {.width = 1, .height = 1});
  edit.replace(patch, push(1)), edit.enable(patch), edit.bring(patch, {}), edit.remove(patch);
  EXPECT_TRUE(is_wrong_moment(edit.add(push(1))));
  EXPECT_TRUE(is_wrong_moment(edit.commit()));
  EXPECT_TRUE(taken.commit());

  Loop loop = *Loop::begin(stage);
  Loop moved(std::move(loop));
  EXPECT_EQ(loop.step({}), Force(0));
  loop.exerted(Force(1));
  loop = std::move(moved);
  EXPECT_TRUE(is_wrong_moment(Loop::begin(stage))) << "the run goes on";

  Batch batch(Bank(push(1)), 3);
  Batch other(std::move(batch));
  EXPECT_EQ(batch.size(), 0u);
  Hand hand;
  Force force(7);
  batch.enter({&hand, 1});
  batch.tick({&hand, 1}, {&force, 1});
  EXPECT_EQ(other.size(), 3u);

  Stage another(std::move(stage));
  EXPECT_TRUE(is_wrong_moment(stage.add(push(1))));
  EXPECT_TRUE(is_wrong_moment(stage.start()));
  EXPECT_TRUE(is_wrong_moment(stage.stop()));
  EXPECT_TRUE(is_wrong_moment(stage.run({.seconds = 1})));
  EXPECT_TRUE(is_wrong_moment(Loop::begin(stage)));
  EXPECT_EQ(stage.size(), 0u);
  EXPECT_FALSE(stage.is_running());
  EXPECT_EQ(stage.poll(), 0u);
  EXPECT_EQ(stage.now().ticks_run, 0);
  EXPECT_TRUE(is_wrong_moment(stage.edit().commit()));
  // NOLINTEND(bugprone-use-after-move)
  EXPECT_EQ(another.size(), 1u);
}

TEST(OneDevice, RunsOneOfItsStagesAtATime) {
  Resting device;
  Stage first(device), second(device);
  ASSERT_TRUE(first.add(push(1)) && second.add(push(1)));
  ASSERT_TRUE(first.start());
  EXPECT_TRUE(is_wrong_moment(second.start()));
  const auto run = second.run({.seconds = 0.01, .virtual_time = true});
  ASSERT_TRUE(is_wrong_moment(run));
  EXPECT_EQ(run.error().place.name, "device");
  EXPECT_TRUE(first.stop());
  EXPECT_TRUE(second.run({.seconds = 0.01, .virtual_time = true}));
  EXPECT_TRUE(first.run({.seconds = 0.01, .virtual_time = true}));
}

TEST(CustomDevice, CannotPutTheHandNowhere) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  Resting device;
  Stage stage(device);
  ASSERT_TRUE(stage.add(push(1)));
  const auto after_a_run = [&] {
    EXPECT_TRUE(stage.run({.seconds = 0.05, .virtual_time = true}));
    return stage.now();
  };
  for (const Force answer : {Force(none, 0), Force(0, infinite)}) {
    device.answers = answer;
    const Now now = after_a_run();
    EXPECT_EQ(now.force, Force(1, 0)) << "what was commanded";
  }
  device.answers.reset();
  for (const int far : {INT_MIN, INT_MAX}) {
    device.reading.counts = {far, 0};
    const Now now = after_a_run();
    EXPECT_EQ(now.guards.lost, now.ticks_run);
    EXPECT_EQ(now.position, glm::vec2(0));
    EXPECT_EQ(now.velocity, glm::vec2(0));
    EXPECT_EQ(now.force, Force(0));
  }
  device.reading.counts = {0, 0};
  device.reading.contact = static_cast<Contact>(77);
  EXPECT_EQ(after_a_run().force, Force(0));
}

}  // namespace
}  // namespace wale::forking_test
