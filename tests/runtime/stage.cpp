#include "wale/stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <thread>

#include "runtime/stage/player.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/placed.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/felt.hpp"

namespace wale::stage_test {
namespace {

constexpr float amplitude = 1.934f;  // roughness 0.6
constexpr double force_step = 10.0 / 2048;

RunResult good(Result<RunResult> run) {
  if (!run) {
    ADD_FAILURE() << in_words(run.error());
    return {};
  }
  return *std::move(run);
}

std::string refused(const Result<RunResult>& run) { return run ? "not refused" : run.error().sentence; }

RunResult run_virtual(const Program& program, const Motion& motion, double seconds) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), motion);
  Stage stage(joystick);
  Patch patch = *stage.add(program);
  return good(stage.run({.seconds = seconds, .virtual_time = true}));
}

Felt felt_in(const RunResult& run, float predicted = amplitude) {
  return measure(run.record,
                 {.position_step = sandpaper().position_step(), .predicted_amplitude = predicted, .settling = 0.25});
}

std::string csv(const Record& record) {
  std::ostringstream text;
  write_csv(text, record);
  return text.str();
}

/// A device that records its commands and moves as the test sets it.
class Notebook : public Device {
 public:
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override { elapsed += periods; }
  Reading sample() noexcept override {
    ++samples;
    return {.counts = counts, .contact = contact_at ? contact_at(samples) : Contact::good};
  }
  Force command(Force force) noexcept override {
    commands.push_back(force);
    return commanded = force;
  }

  DeviceProfile profile_ = sandpaper();
  glm::ivec2 counts{0};
  long elapsed = 0, samples = 0;
  std::function<Contact(long sample)> contact_at;
  std::vector<Force> commands;
  Force commanded{0};
};

TEST(Corduroy, RubbedAtFortyMillimetresGivesTheLevelBack) {
  const Program program = corduroy(amplitude);
  const RunResult run = run_virtual(program, Lateral{0.04, 1}, 10);
  const Felt felt = felt_in(run);
  EXPECT_EQ(run.ticks_run, 9000);
  EXPECT_EQ(run.ticks_missed, 0);
  EXPECT_NEAR(felt.force_rubbing.p99, amplitude, 0.01 * amplitude + force_step);  // 1 % and one step of force
  EXPECT_LE(felt.force.maximum, amplitude + force_step);
  EXPECT_NEAR(felt.force_rubbing.rms / amplitude, 0.576, 0.0576);
  EXPECT_LT(felt.stuck, 0.01);
  EXPECT_GT(felt.crossings, 1000);
  const auto levels = levels_back(Bank(program), felt);
  EXPECT_NEAR(levels.at(0).back->level, 0.6, 0.005);
  ASSERT_TRUE(felt.interaction);
  EXPECT_GT(felt.interaction->maximum, felt.force.maximum);
}

TEST(Corduroy, AHandWithATargetOfTenMillimetresSticks) {
  const Felt felt = felt_in(run_virtual(corduroy(amplitude), Lateral{0.01, 1}, 10));
  EXPECT_NEAR(felt.position_range, 0.0009, 0.0001);  // tests/reference/closed_loop.md, also the 79 %
  EXPECT_NEAR(felt.stuck, 0.79, 0.05);
  EXPECT_EQ(felt.crossings, 0);
}

TEST(Corduroy, IsSweptAsInTheReferenceSimulation) {
  const Program program = corduroy(amplitude);
  EXPECT_NEAR(felt_in(run_virtual(program, Lateral{0.04, 1}, 5)).position_range, 0.099, 0.0005);
  EXPECT_NEAR(felt_in(run_virtual(program, Lateral{0.04, 2}, 5)).position_range, 0.131, 0.0005);
}

TEST(Corduroy, TheInteractionForceIncludesInertiaAndFriction) {
  // tests/reference/closed_loop.md: 2.34 N for level 0.6 (2.1 to 2.5 N, depending on where on the ribs the hand turns)
  // and 1.08 N for level 0.1, where the actuator exerts 0.181 N.
  EXPECT_NEAR(felt_in(run_virtual(corduroy(amplitude), Lateral{0.04, 1, {0.0004, 0}}, 10)).interaction->maximum, 2.34,
              0.05);
  EXPECT_NEAR(felt_in(run_virtual(corduroy(0.181f), Lateral{0.04, 1}, 10), 0.181f).interaction->maximum, 1.08, 0.01);
}

TEST(Corduroy, NothingOscillatesWithTheTargetAtRest) {
  for (double x = 0; x < 0.0025; x += 0.0003) {
    const RunResult run = run_virtual(corduroy(amplitude), Rest{{x, 0.003}}, 4);
    Felt felt = measure(
        run.record, {.position_step = sandpaper().position_step(), .predicted_amplitude = amplitude, .settling = 1});
    EXPECT_EQ(felt.alternations, 0) << x;
    EXPECT_LE(felt.position_range, 1.01 * sandpaper().position_step()) << x;
    EXPECT_EQ(felt.stuck, 1) << x;
  }
}

TEST(Corduroy, StaysWithinItsAmplitudeRubbedInCircles) {
  const Felt felt = felt_in(run_virtual(corduroy(amplitude), Circular{0.04, 1}, 5));
  EXPECT_NEAR(felt.force_rubbing.p99, amplitude, 0.01 * amplitude + force_step);
  EXPECT_GT(felt.crossings, 500);
}

TEST(Stage, NoForceOnceTheDeviceIsStaleOrGone) {
  Notebook device;
  device.counts = {200, 0};
  device.contact_at = [](long sample) {
    return sample == 300 ? Contact::stale : sample >= 500 && sample < 600 ? Contact::lost : Contact::good;
  };
  Stage stage(device);
  Patch patch = *stage.add(spring(50));  // 0.56 N at 200 counts
  const RunResult run = good(stage.run({.seconds = 1, .virtual_time = true}));
  EXPECT_EQ(run.guards.stale, 1);
  EXPECT_EQ(run.guards.lost, 100);
  const float full = -50 * 200 * static_cast<float>(sandpaper().position_step()), step = 200.0f / 900;
  EXPECT_FLOAT_EQ(device.commands.at(298).x, full);
  EXPECT_EQ(device.commands.at(299), Force(0));
  EXPECT_NEAR(device.commands.at(300).x, -step, 1e-5f) << "it slews back";
  EXPECT_FLOAT_EQ(device.commands.at(498).x, full);
  for (int tick = 499; tick < 599; ++tick) ASSERT_EQ(device.commands.at(tick), Force(0)) << tick;
  EXPECT_NEAR(device.commands.at(599).x, -step, 1e-5f);
  EXPECT_FLOAT_EQ(device.commands.at(610).x, full);
}

TEST(Stage, NoForceAfterALongPauseOfTheLoop) {
  Notebook device;
  device.counts = {200, 0};
  Exchange<PlacedPatches> patches;
  patches.publish(placed(spring(50)));
  Record record;
  Player player(device, patches, record, 100);
  long period = 0;
  for (int tick = 0; tick < 50; ++tick, ++period) player.serve({period, 1, 0, 0});
  const float full = device.commanded.x;
  ASSERT_LT(full, -0.5f);
  player.serve({period += 17, 18, 17, 0});  // 19 ms
  EXPECT_EQ(device.commanded.x, full);
  player.serve({period += 20, 21, 20, 0});  // 22 ms
  EXPECT_EQ(device.commanded, Force(0));
  EXPECT_EQ(player.guards().overrun, 1);
  player.serve({++period, 1, 0, 0});
  EXPECT_LT(device.commanded.x, 0);
  EXPECT_GT(device.commanded.x, full);
}

TEST(Stage, ARecordKeepsTheLastBeatsThatItHasRoomFor) {
  for (const bool gets_room : {true, false}) {
    Notebook device;
    Exchange<PlacedPatches> patches;
    Record record;
    Player player(device, patches, record, 70'000);
    const auto serve = [&](long from, long to) {
      for (long period = from; period < to; ++period) {
        device.counts = {static_cast<int>(period % 2000), 0};
        player.serve({period, 1, 0, 0});
      }
    };
    serve(0, 15'000);
    while (gets_room && player.make_room()) continue;
    serve(15'000, 65'000);
    player.finish();
    const std::size_t kept = record.ticks.size();
    EXPECT_EQ(kept == 65'000, gets_room);
    EXPECT_GE(kept, 15'000u);
    const double rate = device.profile().rate;
    for (std::size_t i = 0; i < kept; ++i) {
      const auto period = static_cast<double>(65'000 - kept + i);
      ASSERT_DOUBLE_EQ(record.ticks[i].time, period / rate) << i << " of " << kept;
    }
    EXPECT_FALSE(player.make_room());
  }
}

/// At both ends of the range of tick rates, the run has the declared number of ticks and the handle exerts the level.
TEST(Stage, RunsAtAHundredTicksASecondAndAtTenThousand) {
  for (const double rate : {DeviceProfile::least_rate, DeviceProfile::most_rate}) {
    DeviceProfile profile = sandpaper();
    profile.rate = rate;
    SimulatedJoystick joystick(profile, normal_hand(), Lateral{0.02, 0.25});  // at most a third of a millimetre a tick
    Stage stage(joystick);
    constexpr float force = 0.3f;
    Patch patch = *stage.add(built_for(corduroy(force), profile));
    const RunResult run = good(stage.run({.seconds = 8, .virtual_time = true}));
    EXPECT_EQ(run.ticks_run, std::lround(8 * rate));
    EXPECT_EQ(run.record.seconds_per_tick, 1 / rate);
    const Felt felt = felt_in(run, force);
    EXPECT_NEAR(felt.force_rubbing.p99, force, 0.02 * force + force_step) << rate;
    EXPECT_GT(felt.crossings, 50) << rate;
  }
}

TEST(Stage, VirtualTimeIsTheSameBitForBit) {
  const Program program = corduroy(amplitude);
  EXPECT_FALSE(run_virtual(program, Lateral{0.04, 1}, 0.1).costs) << "no clock is read";
  const RunResult once = run_virtual(program, Lateral{0.04, 1}, 2), again = run_virtual(program, Lateral{0.04, 1}, 2);
  EXPECT_EQ(csv(once.record), csv(again.record));
}

TEST(Stage, VirtualTimeIsTheSameWithParametersSetOnTheWay) {
  const auto run = [] {
    SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
    Stage stage(joystick);
    Patch patch = *stage.add(corduroy(amplitude));
    const auto turn = [&](const Now& now) {
      EXPECT_TRUE(patch.set("wale", 0.001f + static_cast<float>(now.ticks_run % 4) * 0.001f));
    };
    return csv(good(stage.run({.seconds = 1, .virtual_time = true, .progress = turn})).record);
  };
  EXPECT_EQ(run(), run());
}

TEST(Stage, ARecordOfARunIsATrace) {
  const auto trace = read_trace(csv(run_virtual(oil(2), Lateral{0.04, 1}, 0.1).record));
  ASSERT_TRUE(trace);
  EXPECT_EQ(trace->points.size(), 90u);
  EXPECT_TRUE(trace->velocities_given);
}

TEST(Stage, RecordHasAHeaderWithUnitsAndALinePerTick) {
  Record record{.seconds_per_tick = 0.5, .ticks = {{}, {.time = 0.5}}};
  record.ticks[1] = {.time = 0.5,
                     .position = {0.1f, -0.25f},
                     .velocity = {1, 0},
                     .force = {1.5f, 0},
                     .interaction = {-2, 1e-7f},
                     .lateness = 0.25f,
                     .skipped = 3,
                     .inside = true};
  record.ticks[0].interaction = Force(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(csv(record),
            "t (s),x (m),y (m),vx (m/s),vy (m/s),force x (N),force y (N),interaction x (N),interaction y (N),"
            "lateness (s),skipped (periods),inside\n"
            "0,0,0,0,0,0,0,,,0,0,0\n"
            "0.5,0.1,-0.25,1,0,1.5,0,-2,1e-07,0.25,3,1\n");
}

TEST(Stage, ForceStartsAtZeroAndSlews) {
  Notebook device;
  Stage stage(device);
  Patch patch = *stage.add(push(2.1f));
  const RunResult run = good(stage.run({.seconds = 0.1, .virtual_time = true}));
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(run.record.ticks[i].force.x, (i + 1) * 200.0 / 900, 1e-4);
  EXPECT_EQ(run.record.ticks[9].force.x, 2.1f);
  EXPECT_EQ(run.guards.slew, 9);
  EXPECT_EQ(device.commanded, Force(0)) << "zero force on exit";
}

TEST(Stage, PatchEndsAtItsEdgeAndTheForceSlewsBothWays) {
  class Mover : public Notebook {
    void elapse(long periods) noexcept override {
      Notebook::elapse(periods);
      counts = {elapsed >= 100 && elapsed < 200 ? 800 : 0, 0};  // 44.6 mm
    }
  } device;
  Stage stage(device);
  Patch patch =
      *stage.add(push(2.1f), {.at = {0.01f, 0}, .size = PatchSize{.width = 0.06f, .height = 0.02f, .rim = 0}});
  const RunResult run = good(stage.run({.seconds = 300 / 900.0, .virtual_time = true}));
  const auto& ticks = run.record.ticks;
  EXPECT_TRUE(ticks[99].inside);
  EXPECT_EQ(ticks[99].force.x, 2.1f);
  EXPECT_FALSE(ticks[100].inside);
  EXPECT_NEAR(ticks[100].force.x, 2.1 - 200.0 / 900, 1e-4);
  EXPECT_EQ(ticks[150].force.x, 0);
  EXPECT_TRUE(ticks[200].inside);
  EXPECT_NEAR(ticks[200].force.x, 200.0 / 900, 1e-4);
  EXPECT_EQ(run.guards.slew, 27);
}

TEST(Stage, AChangedParameterArrivesWithTheNextTickAndSlews) {
  Notebook device;
  Stage stage(device);
  Patch patch = *stage.add(push(2));
  const auto turn = [&](const Now& now) {
    if (now.ticks_run == 90) {
      EXPECT_TRUE(patch.set("push", -2.0f));
    }
  };
  const RunResult run = good(stage.run({.seconds = 0.2, .virtual_time = true, .progress = turn}));
  EXPECT_EQ(run.record.ticks[89].force.x, 2);
  EXPECT_NEAR(run.record.ticks[90].force.x, 2 - 200.0 / 900, 1e-4);
  EXPECT_EQ(run.record.ticks[110].force.x, -2);
  EXPECT_EQ(patch.bank()->registers()[first_constant + 2], -2);
}

TEST(Stage, ANewPatchReplacesTheOldOneWhileItRuns) {
  Notebook device;
  Stage stage(device);
  Patch patch = *stage.add(push(2));
  const auto swap = [&](const Now& now) {
    if (now.ticks_run != 90) return;
    StageEdit edit = stage.edit();
    edit.remove(patch);
    EXPECT_TRUE(edit.add(push(1)));
    EXPECT_TRUE(edit.commit());
  };
  const RunResult run = good(stage.run({.seconds = 0.2, .virtual_time = true, .progress = swap}));
  EXPECT_NEAR(run.record.ticks[90].force.x, 2 - 200.0 / 900, 1e-4);
  EXPECT_EQ(run.record.ticks[110].force.x, 1);
}

TEST(Stage, AnEditTellsItsFirstError) {
  Stage stage(sandpaper());
  Patch patch = *stage.add(push(1)), other = *stage.add(push(2));
  const auto committed = [&](const auto& make) {
    StageEdit edit = stage.edit();
    make(edit);
    const Result<> done = edit.commit();
    EXPECT_FALSE(done);
    EXPECT_TRUE(patch.placement() && other.placement()) << "nothing has changed";
    EXPECT_TRUE(edit.commit()) << "the edit is empty";
    return done ? Error{} : done.error();
  };
  const Error own{.code = Code::unknown_name, .sentence = "there is none", .place = {.name = "mine"}};
  EXPECT_EQ(committed([&](StageEdit& edit) { edit.fail(own); }).place.name, "mine");
  EXPECT_EQ(committed([&](StageEdit& edit) { edit.move(patch, {NAN, 0}), edit.fail(own); }).place.name, "to");
  EXPECT_EQ(committed([&](StageEdit& edit) { edit.fail(own), edit.move(patch, {NAN, 0}); }).place.name, "mine");
  EXPECT_EQ(committed([&](StageEdit& edit) { edit.move(patch, {0, 0}), edit.fail(own), edit.remove(patch); }).place.name,
            "mine");
  for (const Error& none : {Error{}, Error{.code = Code::unused_name, .sentence = "so"},
                            Error{.code = static_cast<Code>(9999), .sentence = "so"},
                            Error{.code = Code::malformed_value, .sentence = " "}}) {
    const Error refused = committed([&](StageEdit& edit) { edit.fail(none); });
    EXPECT_EQ(refused.code, Code::malformed_value) << in_words(refused);
    EXPECT_TRUE(refused.place.name == "code" || refused.place.name == "sentence") << in_words(refused);
  }
  const Error removed = committed([&](StageEdit& edit) { edit.remove(patch), edit.move(patch, {0, 0}); });
  EXPECT_EQ(removed.code, Code::wrong_moment);
  EXPECT_EQ(removed.sentence, "an earlier call of the edit removes the patch");
}

TEST(Stage, TheHandFeelsThePatchInFront) {
  class Mover : public Notebook {
    void elapse(long periods) noexcept override {
      Notebook::elapse(periods);
      counts = {elapsed < 50 ? 0 : elapsed < 100 ? 300 : elapsed < 150 ? 600 : 1500, 0};  // 0, 16.7, 33.5, 83.7 mm
    }
  } device;
  Stage stage(device);
  Patch patch = *stage.add(push(1), {.size = PatchSize{.width = 0.1f, .height = 0.1f}});
  Patch second =
      *stage.add(push(2), {.at = {0.02f, 0}, .size = PatchSize{.width = 0.02f, .height = 0.02f}, .layer = 1});
  ASSERT_TRUE(stage.add(
      push(-1),
      {.at = {0.02f, 0}, .size = PatchSize{.width = 0.03f, .height = 0.02f}, .layer = 0}));  // behind the second
  ASSERT_TRUE(stage.add(push(-2), {.size = PatchSize{.width = 0.2f, .height = 0.2f}, .layer = -1}));
  const auto turn = [&](const Now& now) {
    if (now.ticks_run != 90) return;
    EXPECT_TRUE(second.set("push", 0.5f));
    EXPECT_TRUE(stage.add(
        push(-0.5f),
        {.at = {0.02f, 0}, .size = PatchSize{.width = 0.002f, .height = 0.002f}, .layer = 2}));  // not under the hand
  };
  const RunResult run = good(stage.run({.seconds = 240 / 900.0, .virtual_time = true, .progress = turn}));
  const auto& ticks = run.record.ticks;
  EXPECT_EQ(ticks[40].force.x, 1);
  EXPECT_NEAR(ticks[50].force.x, 1 + 200.0 / 900, 1e-4) << "from one patch to another the force slews";
  EXPECT_EQ(ticks[85].force.x, 2);
  EXPECT_EQ(ticks[99].force.x, 0.5f);
  EXPECT_EQ(ticks[140].force.x, -1);
  EXPECT_EQ(ticks[220].force.x, -2);
  EXPECT_EQ(second.bank()->registers()[first_constant + 2], 0.5f);
}

TEST(Stage, VelocityReachesTheProgramInMetresPerSecond) {
  class Mover : public Notebook {
    void elapse(long periods) noexcept override {
      Notebook::elapse(periods);
      counts = {static_cast<int>(elapsed), static_cast<int>(-2 * elapsed)};
    }
  } device;
  Stage stage(device);
  Patch patch = *stage.add(oil(2));
  const RunResult run = good(stage.run({.seconds = 0.1, .virtual_time = true}));
  const double speed = 0.2286 / 4096 * 900;
  EXPECT_NEAR(run.record.ticks.back().velocity.x, speed, 1e-7);
  EXPECT_NEAR(run.record.ticks.back().velocity.y, -2 * speed, 1e-7);
  EXPECT_NEAR(run.record.ticks.back().force.x, -2 * speed, 1e-6);
}

TEST(Stage, RefusesRunsThatAreImpossible) {
  Notebook device;
  Stage stage(device);
  EXPECT_EQ(refused(stage.run({.seconds = 1})), "nothing is on the stage");
  ASSERT_TRUE(stage.add(push(1)));
  EXPECT_EQ(refused(stage.run({.seconds = 0})), "the length of a run must be positive; asked for 0 s");
  EXPECT_EQ(refused(stage.run({.seconds = -2})), "the length of a run must be positive; asked for -2 s");
  EXPECT_EQ(refused(stage.run({.seconds = std::nan("")})), "the length of a run must be positive; asked for nan s");
  EXPECT_EQ(refused(stage.run({.seconds = 1e9})), "a run keeps at most 18641.4 s at 900 Hz; asked for 1e+09 s");
  Notebook still;
  still.profile_.mass = still.profile_.rate = 0;
  Stage without(still);
  EXPECT_EQ(refused(without.run({.seconds = 1})), "the device sandpaper declares no positive rate");
  for (const double most : {0.0, -1.0, std::nan("")}) {
    Stage weak(device, {.max_force = most});
    ASSERT_TRUE(weak.add(push(1)));
    EXPECT_EQ(refused(weak.run({.seconds = 1})), "the largest force allowed must be positive");
  }
  for (const int priority : {0, 100, -5}) {
    Stage other(device, {.priority = priority});
    ASSERT_TRUE(other.add(push(1)));
    EXPECT_EQ(refused(other.run({.seconds = 1})), "the priority of a loop must be in 1 .. 99");
  }
}

TEST(Stage, RefusesParametersThatAreMissingOrOutOfRange) {
  Notebook device;
  Stage stage(device);
  Patch patch = *stage.add(corduroy(amplitude));
  EXPECT_EQ(patch.set("whale", 0.002).error().sentence, "by hand has no parameter whale");
  EXPECT_EQ(patch.set("wale", 0.0075).error().sentence, "wale = 7.5 mm is not in its range 1 mm .. 5 mm");
  EXPECT_EQ(patch.set("wale", 1e300).error().sentence, "wale = 1e+303 mm is not in its range 1 mm .. 5 mm");
  for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL}) EXPECT_FALSE(patch.set("wale", none));
  EXPECT_EQ(patch.set("whale", 0.002).error().nearest, std::vector<std::string>{"wale"});
  EXPECT_EQ(patch.set("", 0.002).error().code, Code::malformed_value);
  EXPECT_EQ(patch.set("\xff", 0.002).error().code, Code::invalid_encoding);
  EXPECT_TRUE(patch.set("wale", 0.005f));
  EXPECT_TRUE(patch.set("wale", 0.005)) << "the range is one of floats";
  Patch other = *stage.add(oil(1));
  EXPECT_EQ(in_words(other.set("wale", 0.002).error()),
            "parameter: by hand has no parameter wale; it has no parameters");
}

TEST(Stage, RefusesProgramsBuiltForOtherFiguresOfTheDevice) {
  Notebook device;
  Stage stage(device);
  Patch patch = *stage.add(push(1));
  struct Other {
    double DeviceProfile::*figure;
    const char* name;
  };
  for (const auto& [figure, name] : {Other{&DeviceProfile::rate, "rate"},
                                     {&DeviceProfile::force_newton, "force"},
                                     {&DeviceProfile::workspace_diameter, "workspace"},
                                     {&DeviceProfile::position_counts, "position counts"}}) {
    DeviceProfile profile = device.profile_;
    profile.*figure *= 1.25;
    const Program other = built_for(push(1), profile);
    StageEdit edit = stage.edit();
    for (const Result<>& done : {stage.add(other) ? Result<>() : Result<>(stage.add(other).error()),
                                 patch.replace(other), edit.add(other) ? Result<>() : edit.add(other).error()}) {
      ASSERT_FALSE(done) << name;
      EXPECT_EQ(done.error().code, Code::other_figures);
      EXPECT_NE(done.error().sentence.find(std::string(name) + " "), std::string::npos) << done.error().sentence;
      EXPECT_FALSE(done.error().mend.empty());
    }
    // What no program counts on may differ.
    profile = device.profile_;
    profile.slew *= 2, profile.mass *= 2, profile.damping *= 2;
    EXPECT_TRUE(stage.add(built_for(push(1), profile)));
  }
}

TEST(Stage, AFractionOfASecondIsARun) {
  EXPECT_EQ(run_virtual(oil(2), Rest{}, 0.01).ticks_run, 9);
  EXPECT_EQ(run_virtual(oil(2), Rest{}, 1e-9).ticks_run, 1);
}

TEST(Stage, RunsInRealTime) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  Patch patch = *stage.add(corduroy(amplitude));
  int called = 0;
  const auto thread = std::this_thread::get_id();
  const auto turn = [&](const Now& now) {
    ++called;
    EXPECT_EQ(std::this_thread::get_id(), thread);
    EXPECT_GE(now.time, 0);
    EXPECT_TRUE(patch.set("wale", called % 2 == 0 ? 0.002f : 0.003f));
  };
  const RunResult run = good(stage.run({.seconds = 0.5, .progress = turn}));
  EXPECT_EQ(run.ticks_run + run.ticks_missed, 450);
  EXPECT_GT(run.ticks_run, 0);
  EXPECT_GE(called, 1);
  EXPECT_GE(run.lateness.maximum, run.lateness.p50);
  EXPECT_FALSE(run.scheduling.empty());
  EXPECT_EQ(run.scheduling, "ordinary priority") << "nothing else was asked for";
  ASSERT_TRUE(run.costs);
  for (const Times& step : run.costs->of) {
    EXPECT_LE(step.p50, step.p99);
    EXPECT_LE(step.maximum, run.costs->whole.maximum);
  }
  EXPECT_GT(run.costs->whole.p50, 0);
  EXPECT_EQ(run.scheduling.find('\n'), std::string::npos);
  EXPECT_EQ(joystick.command(Force(0)), Force(0));
}

TEST(Stage, ParametersMayBeSetFromManyThreadsDuringARealTimeRun) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  Patch patch = *stage.add(corduroy(amplitude));
  std::atomic<bool> done = false;
  const auto turn = [&] {
    for (int i = 0; !done; ++i) {
      EXPECT_TRUE(patch.set("wale", 0.001f + 0.0001f * static_cast<float>(i % 40)));
      std::this_thread::yield();
    }
  };
  std::thread first(turn), second(turn);
  const RunResult run = good(stage.run({.seconds = 0.3}));
  done = true;
  first.join();
  second.join();
  EXPECT_EQ(run.ticks_run + run.ticks_missed, 270);
  for (const TickRecord& tick : run.record.ticks) ASSERT_LE(std::abs(tick.force.x), amplitude + force_step);
}

TEST(Stage, StopsWhenToldAndLeavesNoForce) {
  for (const bool virtual_time : {true, false}) {
    Notebook device;
    Stage stage(device);
    Patch patch = *stage.add(push(2));
    std::atomic<bool> stop = false;
    const auto enough = [&](const Now&) { stop = true; };
    const RunResult run =
        good(stage.run({.seconds = 30, .virtual_time = virtual_time, .progress = enough, .stop = &stop}));
    EXPECT_LT(run.ticks_run, 27000);
    EXPECT_EQ(static_cast<long>(run.record.ticks.size()), run.ticks_run);
    EXPECT_EQ(device.commanded, Force(0));
  }
}

TEST(Stage, AnExceptionInProgressEndsTheRunWithoutForce) {
  for (const bool virtual_time : {true, false}) {
    Notebook device;
    Stage stage(device);
    Patch patch = *stage.add(push(2));
    const auto fail = [](const Now&) { throw std::runtime_error("terminal gone"); };
    EXPECT_THROW(stage.run({.seconds = 30, .virtual_time = virtual_time, .progress = fail}), std::runtime_error);
    EXPECT_EQ(device.commanded, Force(0));
    EXPECT_EQ(good(stage.run({.seconds = 0.01, .virtual_time = true})).ticks_run, 9);
  }
}

}  // namespace
}  // namespace wale::stage_test
