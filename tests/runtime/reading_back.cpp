// What a program reads back: how patches lie, what a device lacks, how much of a recording is intact; and edits that fail.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "runtime/stage/device_figures.hpp"
#include "tests/runtime/failing_memory.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/runtime/recorded.hpp"
#include "wale/loop.hpp"

namespace wale::reading_back_test {
namespace {

using recorded::Puppet;

Reading at_rest(long) { return {}; }

/// A device that lacks a figure.
Puppet lacking(double DeviceProfile::*figure) {
  Puppet device(at_rest);
  device.profile_.*figure = 0;
  return device;
}

TEST(ReadingBack, ADeviceThatPushesNeedsASlew) {
  struct Lacks {
    double DeviceProfile::*figure;
    const char* name;
  };
  for (const auto& [figure, name] : {Lacks{&DeviceProfile::slew, "slew"}, {&DeviceProfile::speed_limit, "speed limit"},
                                     {&DeviceProfile::force_newton, "force"}, {&DeviceProfile::rate, "rate"}}) {
    Puppet device = lacking(figure);
    Stage stage(device);
    const auto begun = stage.start();
    ASSERT_FALSE(begun) << name;
    EXPECT_EQ(begun.error().code, Code::unusable_device);
    EXPECT_EQ(begun.error().place.name, name);
    EXPECT_EQ(begun.error().place.text, "0");
    EXPECT_EQ(begun.error().expected, std::string("a positive ") + name);
    EXPECT_EQ(begun.error().found, "0");
    Stage of_profile(device.profile_);
    EXPECT_FALSE(Loop::begin(of_profile)) << name;
  }
  struct Beyond {
    double DeviceProfile::*figure;
    double value;
    const char* name;
    const char* found;
  };
  for (const auto& [figure, value, name, found] :
       {Beyond{&DeviceProfile::slew, NAN, "slew", "nan"}, {&DeviceProfile::rate, 1e6, "rate", "1 000 000"},
        {&DeviceProfile::rate, -1, "rate", "-1"}, {&DeviceProfile::mass, NAN, "mass", "nan"},
        {&DeviceProfile::workspace_diameter, -0.5, "workspace", "-0.5"}}) {
    DeviceProfile profile = sandpaper();
    profile.*figure = value;
    Stage stage(profile);
    const auto begun = Loop::begin(stage);
    ASSERT_FALSE(begun) << name;
    EXPECT_EQ(begun.error().code, Code::unusable_device);
    EXPECT_EQ(begun.error().place.name, name) << in_words(begun.error());
    EXPECT_EQ(begun.error().found, found) << in_words(begun.error());
  }
  DeviceProfile slow = sandpaper();
  slow.slew = 0;
  EXPECT_TRUE(check_recorded_figures(slow)) << "what was recorded replays";
  slow.rate = 0;
  EXPECT_FALSE(check_recorded_figures(slow));
}

TEST(ReadingBack, APlacementIsWhatTheCallsHaveMade) {
  Puppet device(at_rest);
  Stage stage(device);
  const Shape oval = *Shape::ellipse(0.03f, 0.02f);
  Patch patch = *stage.add(corduroy(0.01f), {.at = {0.01f, -0.02f}, .layer = 3, .shape = oval});
  Placement lies = *patch.placement();
  EXPECT_EQ(lies.at, glm::vec2(0.01f, -0.02f));
  EXPECT_EQ(lies.size, (PatchSize{0.06f, 0.04f, lies.program.default_size().rim})) << "the shape's";
  EXPECT_EQ(lies.layer, 3);
  EXPECT_TRUE(lies.enabled);
  EXPECT_EQ(lies.shape, oval);
  EXPECT_EQ(lies.values, lies.program.default_parameters());
  EXPECT_EQ(patch.published().error().code, Code::wrong_moment) << "no run has had it";

  ASSERT_TRUE(patch.set("wale", 0.003));
  ASSERT_TRUE(patch.move({0.002f, 0}));
  ASSERT_TRUE(patch.resize({0.05f, 0.02f, 0.001f}));
  ASSERT_TRUE(patch.bring({.layer = -1}));
  ASSERT_TRUE(patch.enable(false));
  EXPECT_EQ(*patch.value("wale"), 0.003f);
  EXPECT_EQ(patch.values()->at(*lies.program.parameter("wale")), 0.003f);
  const auto unknown = patch.value("whale");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Code::unknown_name);
  EXPECT_EQ(unknown.error().nearest.front(), "wale");
  EXPECT_EQ(lies.value("whale").error().code, Code::unknown_name);
  EXPECT_EQ(lies.at, glm::vec2(0.01f, -0.02f)) << "a value of its own";
  lies = *patch.placement();
  EXPECT_EQ(lies.at, glm::vec2(0.002f, 0));
  EXPECT_EQ(lies.size, (PatchSize{0.05f, 0.02f, 0.001f}));
  EXPECT_EQ(lies.layer, -1);
  EXPECT_FALSE(lies.enabled);
  EXPECT_EQ(lies.shape, oval) << "as it was given";

  ASSERT_TRUE(patch.replace(oil(1)));
  EXPECT_EQ(&patch.placement()->program.decoded(), &patch.bank()->program().decoded());
  EXPECT_TRUE(patch.values()->empty());
  StageEdit edit = stage.edit();
  Patch later = *edit.add(push(1));
  EXPECT_EQ(later.placement().error().code, Code::wrong_moment) << "before its commit";
  edit.move(patch, {0.03f, 0});
  EXPECT_EQ(patch.placement()->at, glm::vec2(0.002f, 0)) << "an edit counts from its commit on";
  ASSERT_TRUE(edit.commit());
  EXPECT_EQ(patch.placement()->at, glm::vec2(0.03f, 0));
  ASSERT_TRUE(patch.remove());
  for (const Code code : {patch.placement().error().code, patch.published().error().code,
                          patch.value("wale").error().code, patch.values().error().code})
    EXPECT_EQ(code, Code::wrong_moment);
  EXPECT_EQ(Patch().placement().error().code, Code::wrong_moment);
}

TEST(ReadingBack, WhatIsPublishedIsWhatTheLoopHas) {
  Puppet device(at_rest);
  Stage stage(device);
  Patch patch = *stage.add(corduroy(0.01f));
  bool seen = false;
  const auto change = [&](const Now& now) {
    if (now.ticks_run != 90) return;
    EXPECT_EQ(*patch.published()->value("wale"), *patch.value("wale"));
    ASSERT_TRUE(patch.set("wale", 0.004));
    ASSERT_TRUE(patch.move({0.001f, 0}));
    EXPECT_EQ(patch.placement()->at, glm::vec2(0.001f, 0));
    EXPECT_EQ(patch.published()->at, glm::vec2(0)) << "the next tick has it";
    EXPECT_NE(*patch.published()->value("wale"), 0.004f);
    seen = true;
  };
  ASSERT_TRUE(stage.run({.seconds = 0.2, .virtual_time = true, .progress = change}));
  ASSERT_TRUE(seen);
  EXPECT_EQ(patch.published()->at, glm::vec2(0.001f, 0));
  EXPECT_EQ(*patch.published()->value("wale"), 0.004f);
  EXPECT_EQ(patch.snapshot()->placement.at, glm::vec2(0.001f, 0));
}

TEST(ReadingBack, ManyThreadsMayReadWhileTheStageRuns) {
  Puppet device(at_rest);
  Stage stage(device);
  Patch patch = *stage.add(corduroy(0.01f));
  ASSERT_TRUE(stage.start());
  std::atomic<bool> over = false;
  std::atomic<long> wrong = 0, read = 0;
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i)
    readers.emplace_back([&] {
      while (!over) {
        const auto lies = patch.placement();
        const auto felt = patch.published();
        if (!lies || lies->at.x != lies->at.y) ++wrong;  // one change moves both
        if (felt && felt->at.x != felt->at.y) ++wrong;
        ++read;
      }
    });
  for (int i = 0; i < 300; ++i) {
    const float to = 1e-5f * static_cast<float>(i);
    ASSERT_TRUE(patch.move({to, to}));
    EXPECT_EQ(patch.placement()->at, glm::vec2(to)) << "one's own changes are read at once";
    std::this_thread::yield();
  }
  over = true;
  for (std::thread& each : readers) each.join();
  ASSERT_TRUE(stage.stop());
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(read, 0);
}

TEST(ReadingBack, TheHandOfARunIsThatOnAPatch) {
  const Shape oval = *Shape::ellipse(0.03f, 0.02f);
  const Placement lies{.program = push(1), .at = {0.02f, 0.01f}, .size = {0.06f, 0.08f, 0.001f}, .shape = oval};
  const Now now{.time = 2, .position = {0.03f, 0.01f}, .velocity = {0.1f, 0.2f}};
  const Hand hand = hand_on(now, lies);
  EXPECT_NEAR(hand.position.x, 0.01f, 1e-7f);
  EXPECT_NEAR(hand.position.y, 0, 1e-7f);
  EXPECT_EQ(hand.workspace, now.position);
  EXPECT_EQ(hand.velocity, now.velocity);
  EXPECT_EQ(hand.time, 2);
  EXPECT_NEAR(hand.edge, oval.stretched({0.06f, 0.08f}).edge({0.01f, 0}).metres, 1e-6f);
  EXPECT_EQ(hand_on(now, {.program = push(1), .size = {1, 1, 0}}).edge, 0) << "a rectangle";
}

TEST(ReadingBack, ThePartOfARecordingThatIsIntactIsCounted) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.wrec";
  Puppet device(recorded::roaming);
  {
    Stage stage(device, {.record = RecordTo{.file = file, .hand = ""}});
    ASSERT_TRUE(stage.add(push(1)));
    recorded::run(stage, {.seconds = 2, .virtual_time = true});
  }
  EXPECT_EQ(*Recording::intact(file), 1800u);
  auto bytes = recorded::bytes_of(file);
  const std::string cut = folder / "cut.wrec";
  for (const std::size_t length : {bytes.size() - 100, bytes.size() / 2, bytes.size() / 3}) {
    std::ofstream(cut, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(length));
    const auto intact = Recording::intact(cut);
    ASSERT_TRUE(intact) << length;
    EXPECT_FALSE(Recording::open(cut)) << length;
    const auto part = Recording::open(cut, *intact);
    ASSERT_TRUE(part) << in_words(part.error());
    EXPECT_EQ(part->ticks(), *intact);
    EXPECT_FALSE(Recording::open(cut, *intact + 1)) << "it is all that there is";
  }
  std::ofstream(cut) << "no recording at all, but a text";
  EXPECT_EQ(Recording::intact(cut).error().code, Code::damaged_file);
  EXPECT_EQ(Recording::intact(folder / "none").error().code, Code::unreadable_file);
}

TEST(ReadingBack, ErrorsOfAStageSayWhatTheyFound) {
  Puppet device(at_rest);
  Stage stage(device);
  Patch patch = *stage.add(corduroy(0.01f));
  const float none = std::nanf("");
  const auto expect = [](const Result<>& refused, const char* argument, const char* found) {
    ASSERT_FALSE(refused) << argument;
    EXPECT_EQ(refused.error().place.name, argument);
    EXPECT_EQ(refused.error().place.text, found);
    EXPECT_EQ(refused.error().found, found);
    EXPECT_FALSE(refused.error().expected.empty()) << argument;
  };
  expect(patch.move({none, 0.5f}), "to", "nan, 0.5");
  expect(patch.resize({-1, 0.5f, 0}), "size", "-1, 0.5");
  expect(patch.resize({1, 1, -0.25f}), "size", "-0.25");
  expect(patch.bring({.layer = none}), "layer", "nan");
  expect(patch.set("wale", 0.0075), "value", "7.5 mm");
  const auto timeless = stage.run({.seconds = -2});
  expect(timeless ? Result<>() : timeless.error(), "seconds", "-2");

  DeviceProfile nameless = sandpaper();
  nameless.name.clear();
  Stage without_name(nameless), without_device(std::unique_ptr<Device>{});
  EXPECT_NE(without_name.add(push(1)).error().sentence.find("has no name"), std::string::npos);
  EXPECT_NE(without_device.add(push(1)).error().sentence.find("no device"), std::string::npos);
  Stage empty{DeviceProfile{}};
  EXPECT_NE(empty.add(push(1)).error().sentence.find("has no name"), std::string::npos);
  const auto begun = Loop::begin(empty);
  EXPECT_NE(begun.error().sentence.find("has no name"), std::string::npos) << in_words(begun.error());
  Stage recorded(std::make_unique<Puppet>(at_rest), {.record = RecordTo{"", "h"}});
  const auto unrecorded = recorded.start();
  expect(unrecorded, "record", "an empty text");
}

TEST(ReadingBack, AnEditWithoutMemoryForOneCallChangesNothing) {
  if (!failing_memory::is_wired()) GTEST_SKIP() << "a sanitizer allocates";
  const std::string long_name(100, 'w');
  for (long enough = 0; enough < 20; ++enough) {
    Puppet device(at_rest);
    Stage stage(device);
    Patch one = *stage.add(push(1)), other = *stage.add(push(1));
    StageEdit edit = stage.edit();
    edit.move(one, {0.01f, 0});
    bool thrown = false;
    const Program program = push(2);
    failing_memory::left = enough;
    try {
      edit.set(other, long_name, 1);
    } catch (const std::bad_alloc&) {
      thrown = true;
    }
    failing_memory::left = -1;
    const auto done = edit.commit();
    ASSERT_FALSE(done) << enough;
    EXPECT_EQ(done.error().code, thrown ? Code::short_of_resources : Code::unknown_name) << enough;
    EXPECT_FALSE(done.error().sentence.empty());
    EXPECT_EQ(one.placement()->at, glm::vec2(0)) << "nothing of it was done";
    edit.move(one, {0.02f, 0});
    EXPECT_TRUE(edit.commit()) << "the edit is empty again";
    EXPECT_EQ(one.placement()->at, glm::vec2(0.02f, 0));
    if (!thrown) return;
  }
  FAIL() << "it never succeeds";
}

TEST(ReadingBack, ARunThatFailsTellsNoForce) {
  Puppet device(at_rest);
  Stage stage(device);
  ASSERT_TRUE(stage.add(push(1)));
  ASSERT_TRUE(stage.run({.seconds = 0.1, .virtual_time = true}));
  EXPECT_NE(stage.now().force, Force(0)) << "the last tick's, by its documentation";
  const auto throws = [](const Now&) { throw std::runtime_error("no more"); };
  for (const bool unreal : {true, false}) {
    EXPECT_THROW(static_cast<void>(stage.run({.seconds = 1, .virtual_time = unreal, .progress = throws})),
                 std::runtime_error);
    EXPECT_GT(stage.now().ticks_run, 0);
    EXPECT_EQ(stage.now().force, Force(0)) << unreal;
    EXPECT_FALSE(stage.now().inside);
    EXPECT_FALSE(stage.is_running());
  }
}

}  // namespace
}  // namespace wale::reading_back_test
