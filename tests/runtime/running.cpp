// Runs of their own threads, contacts, copies of memories, and what a run does to its process.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <functional>
#include <thread>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/runtime/recorded.hpp"
#include "wale/loop.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WALE_SANITIZED_PAGES 1  // a sanitizer's mlock does nothing
#else
#define WALE_SANITIZED_PAGES 0
#endif

namespace wale::running_test {
namespace {

/// A device whose reading is a function of the tick's number.
class Scripted : public Device {
 public:
  explicit Scripted(std::function<Reading(long)> reading, DeviceProfile profile = sandpaper())
      : profile_(std::move(profile)), reading_(std::move(reading)) {}
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override { return reading_(ticks++); }
  Force command(Force force) noexcept override {
    commanded_x = force.x;
    return force;
  }

  std::atomic<long> ticks = 0;
  std::atomic<float> commanded_x = 0;

 private:
  DeviceProfile profile_;
  std::function<Reading(long)> reading_;
};

/// Waits for something that other threads bring about. The time only ends a test that has failed.
bool comes(const std::function<bool()>& true_at_last) {
  for (int i = 0; i < 20000; ++i) {
    if (true_at_last()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST(Running, StartsOnceAndStopsOnceAndLeavesNoForce) {
  Scripted device([](long) { return Reading{}; });
  Stage stage(device);
  EXPECT_EQ(stage.stop().error().code, Code::wrong_moment) << "nothing was started";
  ASSERT_TRUE(stage.start()) << "also without a patch";
  EXPECT_TRUE(stage.is_running());
  EXPECT_EQ(stage.start().error().code, Code::wrong_moment);
  EXPECT_EQ(stage.run({.seconds = 1}).error().code, Code::wrong_moment);
  EXPECT_EQ(stage.run({.seconds = 1, .virtual_time = true}).error().code, Code::wrong_moment);
  EXPECT_EQ(Loop::begin(stage).error().code, Code::wrong_moment);
  Patch patch = *stage.add(push(1));
  EXPECT_TRUE(comes([&] { return device.commanded_x == 1; }));
  EXPECT_TRUE(stage.now().inside);
  EXPECT_EQ(stage.now().patch, patch);
  const auto result = stage.stop();
  ASSERT_TRUE(result);
  EXPECT_GT(result->ticks_run, 0);
  EXPECT_TRUE(result->record.ticks.empty()) << "an endless run keeps no record";
  EXPECT_EQ(device.commanded_x, 0);
  EXPECT_EQ(stage.stop().error().code, Code::wrong_moment);
  EXPECT_FALSE(stage.is_running());
  EXPECT_TRUE(stage.run({.seconds = 0.01, .virtual_time = true})) << "and it can run again";
  EXPECT_TRUE(stage.start());
}  // the destructor stops it

TEST(Running, AStageMayBeDestroyedInMidRun) {
  {
    auto device = std::make_unique<Scripted>([](long) { return Reading{}; });
    Stage stage(std::move(device));
    (void)*stage.add(push(1));
    ASSERT_TRUE(stage.start());
  }
  Scripted device([](long) { return Reading{}; });
  auto stage = std::make_unique<Stage>(device);
  ASSERT_TRUE(stage->add(push(1)));
  std::thread running([at = stage.get()] { EXPECT_TRUE(at->run({.seconds = 1000})); });
  EXPECT_TRUE(comes([&] { return device.ticks > 5; }));
  Patch patch = *stage->add(push(1));
  stage.reset();  // ends the run and waits for it
  running.join();
  EXPECT_EQ(device.commanded_x, 0);
  EXPECT_FALSE(patch.exists());
  // In `progress`, on the run's own thread.
  auto mine = std::make_unique<Stage>(device);
  ASSERT_TRUE(mine->add(push(1)));
  Stage& same = *mine;
  const auto ran = same.run({.seconds = 1, .virtual_time = true, .progress = [&](const Now&) { mine.reset(); }});
  ASSERT_TRUE(ran);
  EXPECT_EQ(ran->ticks_run, 90);
  // There too when another thread serves the ticks.
  auto last = std::make_unique<Stage>(device);
  ASSERT_TRUE(last->add(push(1)));
  Stage& running_stage = *last;
  ASSERT_TRUE(running_stage.run({.seconds = 1000, .progress = [&](const Now&) { last.reset(); }}));
  EXPECT_EQ(device.commanded_x, 0);
}

TEST(Running, ALoopOfOnesOwnGivesTheForcesOfARun) {
  const auto reading = [](long tick) {
    return Reading{.counts = {static_cast<int>(300 * std::sin(0.02 * static_cast<double>(tick))), 40}};
  };
  Scripted device(reading);
  Stage stage(device);
  (void)*stage.add(spring(400));
  const auto run = stage.run({.seconds = 1, .virtual_time = true});
  ASSERT_TRUE(run);
  Stage own(sandpaper());
  EXPECT_EQ(own.start().error().code, Code::wrong_moment) << "it has no device";
  EXPECT_EQ(own.run({.seconds = 1}).error().code, Code::wrong_moment);
  (void)*own.add(spring(400));
  auto loop = Loop::begin(own);
  ASSERT_TRUE(loop);
  for (long tick = 0; tick < 900; ++tick) ASSERT_EQ(loop->step(reading(tick)), run->record.ticks[tick].force) << tick;
  EXPECT_EQ(loop->step(reading(900), 30), Force(0)) << "nobody served it for 33 ms";
  EXPECT_EQ(own.now().guards.overrun, 1);
  EXPECT_EQ(own.now().ticks_missed, 29);
}

TEST(Running, ALoopMayOutliveItsStage) {
  auto stage = std::make_unique<Stage>(sandpaper());
  (void)*stage->add(push(1));
  auto loop = Loop::begin(*stage);
  ASSERT_TRUE(loop);
  stage.reset();
  for (int i = 0; i < 100; ++i) (void)loop->step({});
}

TEST(Contacts, AreToldInTheirOrderOnTheThreadThatPolls) {
  // Off, onto the left patch, with the button for ten ticks, over to the right one, off.
  Scripted device([](long tick) {
    const int x = tick < 100 ? -1500 : tick < 200 ? -300 : tick < 300 ? 300 : 1500;
    return Reading{.counts = {x, 0}, .button = tick >= 150 && tick < 160};
  });
  Stage stage(device);
  const PatchSize size{.width = 0.03f, .height = 0.03f};
  const Patch left = *stage.add(push(1), {.at = {-0.0167f, 0}, .size = size}),
              right = *stage.add(push(1), {.at = {0.0167f, 0}, .size = size});
  std::vector<ContactEvent> told;
  stage.on_contact([&](const ContactEvent& event) { told.push_back(event); });
  ASSERT_TRUE(stage.run({.seconds = 400 / 900.0, .virtual_time = true}));
  EXPECT_TRUE(told.empty()) << "only by poll";
  EXPECT_EQ(stage.poll(), 0u);
  using enum ContactKind;
  const struct {
    ContactKind kind;
    Patch patch;
    long tick;
  } expected[] = {{enter, left, 100}, {press, left, 150},  {release, left, 160},
                  {leave, left, 200}, {enter, right, 200}, {leave, right, 300}};
  ASSERT_EQ(told.size(), std::size(expected));
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].kind, expected[i].kind) << i;
    EXPECT_EQ(told[i].patch, expected[i].patch) << i;
    EXPECT_NEAR(told[i].time, static_cast<double>(expected[i].tick) / 900, 1e-9) << i;
  }
  EXPECT_EQ(stage.poll(), 0u);
  EXPECT_EQ(told.size(), std::size(expected));
}

TEST(Contacts, AReceiverMayPollAndNameAnotherOne) {
  Scripted device([](long tick) { return Reading{.counts = {tick % 100 < 50 ? 0 : 1800, 0}}; });
  Stage stage(device);
  (void)*stage.add(push(1));
  int first = 0, second = 0;
  stage.on_contact([&](const ContactEvent&) {
    ++first;
    EXPECT_EQ(stage.poll(), 0u);
    stage.on_contact([&](const ContactEvent&) { ++second; });
  });
  ASSERT_TRUE(stage.run({.seconds = 400 / 900.0, .virtual_time = true}));  // on and off four times
  EXPECT_EQ(stage.poll(), 0u);
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 7);
}

TEST(Contacts, BeyondTheQueueAreDroppedAndCounted) {
  Scripted device([](long tick) { return Reading{.counts = {tick % 2 == 0 ? 0 : 1800, 0}}; });
  Stage stage(device);
  (void)*stage.add(push(1));
  std::size_t told = 0;
  stage.on_contact([&](const ContactEvent&) { ++told; });
  ASSERT_TRUE(stage.run({.seconds = 2, .virtual_time = true}));  // on and off 1800 times
  EXPECT_EQ(stage.poll(), 1800 - most_contacts_waiting);
  EXPECT_EQ(told, most_contacts_waiting);
  stage.on_contact(nullptr);
  ASSERT_TRUE(stage.run({.seconds = 2, .virtual_time = true}));
  EXPECT_EQ(stage.poll(), 0u);
}

TEST(Stage, WithoutADeviceTakesNothing) {
  Stage stage(std::unique_ptr<Device>{});
  EXPECT_EQ(stage.add(push(1)).error().code, Code::other_device);
  EXPECT_EQ(stage.run({.seconds = 1}).error().code, Code::wrong_moment);
  EXPECT_EQ(stage.start().error().code, Code::wrong_moment);
}

TEST(Stage, WithoutADeviceHasNoLoop) {
  Stage stage{std::unique_ptr<Device>()};
  const auto loop = Loop::begin(stage);
  ASSERT_FALSE(loop);
  EXPECT_EQ(loop.error().code, Code::wrong_moment);
  EXPECT_NE(loop.error().sentence.find("has no device"), std::string::npos);
}

TEST(Snapshots, HaveTheStatesOfATick) {
  // The bead follows a hand that has moved 20 mm; by semi-implicit Euler its place is known.
  Scripted device([](long tick) { return Reading{.counts = {tick < 5 ? 0 : 358, 0}}; });
  Stage stage(device);
  Patch patch = *stage.add(bead(200));
  EXPECT_EQ(patch.snapshot()->memory.states()[0], 0) << "no run yet";
  const double hand = 358 * sandpaper().position_step(), dt = 1 / 900.0;
  double place = 0, speed = 0;
  long stepped = 0;
  const auto look = [&](const Now& now) {
    for (; stepped < now.ticks_run; ++stepped) {
      speed += 200 * ((stepped < 5 ? 0 : hand) - place) * dt;
      place += speed * dt;
    }
    const auto snapshot = patch.snapshot();
    ASSERT_TRUE(snapshot);
    float nearest = 1;
    for (const float state : snapshot->memory.states()) nearest = std::min(nearest, std::abs(state - float(place)));
    EXPECT_LT(nearest, 1e-4f) << now.ticks_run;
  };
  ASSERT_TRUE(stage.run({.seconds = 1, .virtual_time = true, .progress = look}));
  const auto after = patch.snapshot();
  ASSERT_TRUE(after);
  EXPECT_EQ(after->memory.grid(0)[4], 1) << "the bead has written into its track";
  EXPECT_EQ(&after->bank.program().decoded(), &after->memory.program().decoded());
}

TEST(Snapshots, AreCopiedByTheLoopWhileItRuns) {
  Scripted device([](long) { return Reading{}; });
  Stage stage(device);
  Patch patch = *stage.add(bead(200)), absent = *stage.add(bead(200));
  ASSERT_TRUE(absent.enable(false));
  ASSERT_TRUE(stage.start());
  EXPECT_TRUE(comes([&] { return stage.now().inside; }));
  std::vector<std::thread> askers;
  for (int i = 0; i < 3; ++i)
    askers.emplace_back([&] {
      for (int n = 0; n < 20; ++n) {
        const auto snapshot = patch.snapshot();
        ASSERT_TRUE(snapshot) << in_words(snapshot.error());
        EXPECT_EQ(snapshot->memory.grid(0)[4], 1);
      }
    });
  for (std::thread& each : askers) each.join();
  const auto other = absent.snapshot();
  ASSERT_TRUE(other) << in_words(other.error());
  EXPECT_EQ(other->memory.grid(0)[4], 0);
  (void)stage.stop();
  EXPECT_EQ(patch.snapshot()->memory.grid(0)[4], 1);
}

/// kB, of this process.
long locked_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (long value = 0; word == "VmLck:" && status >> value) return value;
  return -1;
}

TEST(Running, DoesNothingToItsProcessThatNobodyAskedFor) {
  const long before = locked_kilobytes();
  std::atomic<int> policy = -1;
  Scripted device([&](long) {
    int now = -1;
    sched_param parameters{};
    pthread_getschedparam(pthread_self(), &now, &parameters);
    policy = now;
    return Reading{};
  });
  Stage stage(device);
  (void)*stage.add(push(1));
  ASSERT_TRUE(stage.start());
  EXPECT_TRUE(comes([&] { return stage.now().ticks_run > 3; }));
  EXPECT_EQ(policy, SCHED_OTHER);
  EXPECT_EQ(locked_kilobytes(), before);
  EXPECT_EQ(stage.stop()->scheduling, "ordinary priority");
  EXPECT_EQ(locked_kilobytes(), before);
  Stage asking(device, {.lock_memory = true});
  (void)*asking.add(push(1));
  ASSERT_TRUE(asking.start());
  EXPECT_TRUE(comes([&] { return asking.now().ticks_run > 3; }));
  const long during = locked_kilobytes();
  const auto result = asking.stop();
  if (!WALE_SANITIZED_PAGES && result->scheduling.find("memory locked") != std::string::npos) {
    EXPECT_GT(during, before);
  }
  EXPECT_LT(during, before + 1024) << "the loop's own pages only";
}

/// From four threads at once; the recording then has every change at the tick at which it was felt.
TEST(Running, AllChangesFromFourThreadsAreRecordedAndReplayBitForBit) {
  const TemporaryFolder folder;
  Stage stage(std::make_unique<SimulatedJoystick>(sandpaper(), normal_hand(), Lateral{0.04, 1}),
              {.max_force = 3, .record = RecordTo{folder / "a.wrec", "simulated"}});
  Patch still = *stage.add(corduroy(1.934f));
  std::vector<Program> programs{spring(40), bead(300), oil(2), corduroy(1)};
  ASSERT_TRUE(stage.start());
  std::vector<std::thread> changing;
  for (unsigned thread = 0; thread < 4; ++thread)
    changing.emplace_back([&, thread] {
      std::vector<Patch> mine;
      for (unsigned i = 0; i < 60; ++i) {
        const float x = 0.001f * static_cast<float>((i * 7 + thread * 11) % 60) - 0.03f;
        mine.push_back(*stage.add(
            programs[(i + thread) % 4],
            {.at = {x, 0}, .size = PatchSize{.width = 0.03f, .height = 0.05f}, .layer = static_cast<float>(i % 2)}));
        EXPECT_TRUE(still.set("wale", 0.001f + 0.00005f * static_cast<float>((i + 13 * thread) % 80)));
        EXPECT_TRUE(mine[mine.size() / 2].move({-x, 0.001f}));
        EXPECT_TRUE(mine.front().enable(i % 5 != 0));
        if (i % 6 == 0) {
          EXPECT_TRUE(mine.back().replace(programs[i % 4]));
        }
        if (i % 4 == 0) {
          EXPECT_TRUE(mine.back().resize({.width = 0.02f, .height = 0.02f, .rim = 0.001f}));
        }
        if (i % 9 == 0) {
          StageEdit edit = stage.edit();
          edit.move(still, {0.0001f * static_cast<float>(i), 0});
          edit.bring(mine.back(), {.layer = 2});
          EXPECT_TRUE(edit.commit());
        }
        if (mine.size() > 20) {
          EXPECT_TRUE(mine.front().remove());
          mine.erase(mine.begin());
        }
        (void)stage.now();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
  for (std::thread& each : changing) each.join();
  const auto result = stage.stop();
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->record_problem);
  const Recording recording = recorded::opened(folder / "a.wrec");
  EXPECT_TRUE(recording.complete());
  EXPECT_GT(std::ranges::count(recording.events(), RecordedEvent::Kind::put, &RecordedEvent::kind), 50);
  EXPECT_GT(std::ranges::count(recording.events(), RecordedEvent::Kind::remove, &RecordedEvent::kind), 10);
  recorded::expect_same(recording);
}

}  // namespace
}  // namespace wale::running_test
