// Where memory or threads end: a call has done all or nothing, and no thread of a run ends the process.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <wale/runtime.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "schema/home_process.hpp"
#include "tests/runtime/failing_memory.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/forked.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::without_memory_test {
namespace {

constexpr WaleCode short_of_resources = WALE_CODE_short_of_resources;

WaleText text(const char* of) { return {of, WALE_ZERO_ENDED}; }

/// A stage of the C interface with one patch, and what is needed for more.
struct Scene {
  WaleProgram* program = nullptr;
  WaleDevice* device = nullptr;
  WaleStage* stage = nullptr;
  WalePatch* patch = nullptr;

  Scene() {
    const auto bytes = write_patch_program(push(1).description());
    WaleDeviceOptions hand{};
    hand.size = sizeof hand;
    hand.hand_mass = 0.5, hand.hand_damping = 6, hand.hand_stiffness = 135;
    wale_program_load(bytes.data(), bytes.size(), &program, nullptr);
    wale_device_open(text("simulated"), &hand, &device, nullptr);
    wale_stage_create(device, nullptr, &stage, nullptr);
    wale_stage_add(stage, program, nullptr, &patch, nullptr);
  }
  ~Scene() {
    wale_patch_free(patch), wale_stage_free(stage), wale_device_free(device), wale_program_free(program);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
};

/// Calls again and again, with one more allocation each time, until it succeeds. `unchanged` looks after each failure.
void starve(const char* what, const std::function<WaleCode(Scene&)>& call,
            const std::function<bool(Scene&)>& unchanged, bool while_running) {
  for (long enough = 0; enough < 500; ++enough) {
    Scene scene;
    ASSERT_NE(scene.patch, nullptr);
    if (while_running) {
      ASSERT_EQ(wale_stage_start(scene.stage, nullptr), 0);
    }
    const std::size_t handles = wale_handles();
    failing_memory::left = enough;
    const WaleCode code = call(scene);
    failing_memory::left = -1;
    if (code == 0) return;
    // While a run is under way its own threads may have failed too, which ends the run.
    ASSERT_EQ(code, short_of_resources) << what << " with " << enough;
    ASSERT_TRUE(unchanged(scene)) << what << " with " << enough;
    ASSERT_EQ(wale_handles(), handles) << what << " with " << enough;
  }
  FAIL() << what << " never succeeds";
}

TEST(WithoutMemory, ACallHasDoneAllOrNothing) {
  if (!failing_memory::is_wired()) GTEST_SKIP() << "a sanitizer allocates";
  const auto one_patch = [](Scene& scene) { return wale_stage_size(scene.stage) == 1; };
  for (const bool running : {false, true}) {
    starve("add", [](Scene& scene) {
      WalePatch* added = nullptr;
      const WaleCode code = wale_stage_add(scene.stage, scene.program, nullptr, &added, nullptr);
      wale_patch_free(added);
      return code;
    }, one_patch, running);
    starve("add, no handle", [](Scene& scene) {
      return wale_stage_add(scene.stage, scene.program, nullptr, nullptr, nullptr);
    }, one_patch, running);
    starve("remove", [](Scene& scene) { return wale_patch_remove(scene.patch, nullptr); },
           [](Scene& scene) { return wale_patch_exists(scene.patch) == 1; }, running);
    starve("set", [](Scene& scene) { return wale_patch_set(scene.patch, text("push"), 2, nullptr); }, one_patch, running);
    for (const bool removes : {false, true}) {
      starve("commit", [&](Scene& scene) {
        const long enough = failing_memory::left.exchange(-1);
        WaleEdit* edit = nullptr;
        WalePatch *first = nullptr, *second = nullptr;
        wale_stage_edit(scene.stage, &edit, nullptr);
        wale_edit_add(edit, scene.program, nullptr, &first, nullptr);
        wale_edit_add(edit, scene.program, nullptr, &second, nullptr);
        wale_edit_set(edit, scene.patch, text("push"), 2, nullptr);
        if (removes) wale_edit_remove(edit, second, nullptr);
        failing_memory::left = enough;
        const WaleCode code = wale_edit_commit(edit, nullptr);
        failing_memory::left = -1;
        EXPECT_EQ(wale_patch_exists(first), code == 0);
        EXPECT_EQ(wale_patch_exists(second), code == 0 && !removes);
        // What failed can be done again.
        if (code != 0) {
          EXPECT_EQ(wale_stage_size(scene.stage), 1u);
          EXPECT_EQ(wale_edit_commit(edit, nullptr), 0);
          EXPECT_EQ(wale_stage_size(scene.stage), removes ? 2u : 3u);
        }
        wale_edit_free(edit), wale_patch_free(first), wale_patch_free(second);
        return code;
      }, [](Scene&) { return true; }, running);
    }
  }
}

/// What a child does that has no memory left after so many allocations: 0 for success, 1 for short_of_resources.
int outcome_of(WaleCode code) { return code == 0 ? 0 : code == short_of_resources ? 1 : 2; }

TEST(WithoutMemory, NoThreadOfARunEndsTheProcess) {
  if (!failing_memory::is_wired()) GTEST_SKIP() << "a sanitizer allocates";
  using Deed = std::function<int(Scene&, long enough)>;
  const std::vector<std::pair<const char*, Deed>> deeds = {
      {"run",
       [](Scene& scene, long enough) {
         WaleRunOptions options{};
         options.size = sizeof options, options.seconds = 0.03;
         failing_memory::left = enough;
         const WaleCode code = wale_stage_run(scene.stage, &options, nullptr, nullptr);
         failing_memory::left = -1;
         return outcome_of(code);
       }},
      {"start",
       [](Scene& scene, long enough) {
         failing_memory::left = enough;
         WaleCode code = wale_stage_start(scene.stage, nullptr);
         if (code == 0) std::this_thread::sleep_for(std::chrono::milliseconds(40));
         failing_memory::left = -1;
         if (code == 0) code = wale_stage_stop(scene.stage, nullptr, nullptr);
         return outcome_of(code);
       }},
      {"change",
       [](Scene& scene, long enough) {
         wale_stage_start(scene.stage, nullptr);
         std::this_thread::sleep_for(std::chrono::milliseconds(10));
         failing_memory::left = enough;
         WaleCode code = wale_patch_set(scene.patch, text("push"), 2, nullptr);
         if (code == 0) std::this_thread::sleep_for(std::chrono::milliseconds(40));
         failing_memory::left = -1;
         const WaleCode stopped = wale_stage_stop(scene.stage, nullptr, nullptr);
         return outcome_of(code != 0 ? code : stopped);
       }},
      {"loop", [](Scene& scene, long enough) {
         WaleLoop* loop = nullptr;
         failing_memory::left = enough;
         const WaleCode code = wale_loop_begin(scene.stage, &loop, nullptr);
         WaleReading reading{};
         reading.size = sizeof reading;
         for (int i = 0; code == 0 && i < 40; ++i) {
           wale_loop_step(loop, &reading, 1);
           std::this_thread::sleep_for(std::chrono::milliseconds(1));
         }
         failing_memory::left = -1;
         wale_loop_free(loop);
         return outcome_of(code);
       }}};
  for (const auto& [what, deed] : deeds) {
    const Deed& does = deed;
    const auto outcome = [&does](long enough) {
      return in_a_child([&] {
        Scene scene;
        return does(scene, enough);
      });
    };
    for (long enough = 0; enough < 90; enough += enough < 30 ? 1 : 3) {
      const int result = outcome(enough);
      ASSERT_TRUE(result == 0 || result == 1) << what << " with " << enough << ": " << result;
    }
    EXPECT_EQ(outcome(1'000'000), 0) << what << " has enough at last";
  }
}

TEST(WithoutMemory, WhatEachProcessHasOfItsOwnIsLeftAndDestroyed) {
  if (!failing_memory::is_wired()) GTEST_SKIP() << "a sanitizer allocates";
  const auto destroyed = [](std::unique_ptr<PerProcess<std::vector<int>>>& all) {
    failing_memory::left = 0;
    all.reset();
    failing_memory::left = -1;
    return 0;
  };
  auto unused = std::make_unique<PerProcess<std::vector<int>>>(), used = std::make_unique<PerProcess<std::vector<int>>>();
  (**used).assign(100, 1);
  EXPECT_EQ(in_a_child([&] { return destroyed(used) + destroyed(unused); }), 0);
  EXPECT_EQ((**used).size(), 100u);
  destroyed(used), destroyed(unused);
}

#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
TEST(WithoutMemory, ARunThatCannotBeginLeavesNoRecording) {
  const TemporaryFolder folder;
  const int done = in_a_child([&] {
    // So large stacks fit into the limit of the process one after the other: the threads of a recorded run are three.
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, std::size_t{64} << 20);
    pthread_setattr_default_np(&attributes);
    rlimit before{};
    getrlimit(RLIMIT_AS, &before);
    SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.02, 1});
    Stage stage(joystick, {.record = RecordTo{folder / "a.wrec", {}}});
    if (!stage.add(push(1))) return 1;
    int refused = 0, done_at_last = 0;
    for (rlim_t room = 32; room <= 1024 && done_at_last < 2; room += 32) {
      long pages = 0;
      std::ifstream("/proc/self/statm") >> pages;
      rlimit narrow = before;
      narrow.rlim_cur = static_cast<rlim_t>(pages) * 4096 + (room << 20);
      if (setrlimit(RLIMIT_AS, &narrow) != 0) return 2;
      const bool starts = refused % 2 == 1;
      Code code{};
      bool good = false;
      if (starts) {
        const auto done = stage.start();
        good = done.has_value();
        if (!good) code = done.error().code;
      } else {
        const auto done = stage.run({.seconds = 0.02});
        good = done.has_value();
        if (!good) code = done.error().code;
      }
      if (setrlimit(RLIMIT_AS, &before) != 0) return 3;
      if (good && starts && !stage.stop()) return 7;
      if (!good && code != Code::short_of_resources) return 4;
      if (std::filesystem::exists(folder / "a.wrec") != good) return 5;
      if (good) std::filesystem::remove(folder / "a.wrec");
      refused += !good, done_at_last += good;
    }
    return refused >= 3 && done_at_last == 2 ? 0 : 6;
  });
  EXPECT_EQ(done, 0);
}
#endif

}  // namespace
}  // namespace wale::without_memory_test
