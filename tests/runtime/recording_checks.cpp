// The checks of a recording, and what a loop of one's own records.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "tests/runtime/forked.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/runtime/recorded.hpp"
#include "wale/loop.hpp"
#include "wale/runtime.h"

namespace wale::recording_checks_test {
namespace {

using namespace recorded;
using namespace recording_format;

/// As RECORDING.md describes it.
std::uint32_t check_in_words_of_four(std::span<const std::byte> bytes) {
  std::uint32_t sum = 0x57414c45;
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
      word |= std::to_integer<std::uint32_t>(bytes[at + i]) << 8 * i;
    sum = (sum ^ word) * 0x9e3779b1u;
    sum ^= sum >> 15;
  }
  return sum;
}

TEST(RecordingChecks, AreThoseOfTheDescription) {
  TickEntry entry;
  entry.sequence = 7, entry.period = 9, entry.force = {1, 2}, entry.flags = 8;
  EXPECT_EQ(check_of(entry), check_in_words_of_four(std::as_bytes(std::span(&entry, 1)).first(92)));
}

TEST(RecordingChecks, DetectEachChangedWord) {
  const TemporaryFolder folder;
  Puppet device(roaming);
  Stage stage(device, {.record = RecordTo{folder / "a.wrec", {}}});
  ASSERT_TRUE(stage.add(corduroy(1.934f)));
  run(stage, {.seconds = 0.02, .virtual_time = true});
  std::vector<std::byte> bytes = bytes_of(folder / "a.wrec");
  ASSERT_TRUE(Recording::read(bytes, "whole"));
  // The places that checks cover.
  std::vector<std::size_t> words;
  const auto cover = [&](std::size_t begin, std::size_t size) {
    for (std::size_t at = begin; at + 4 <= begin + size; at += 4) words.push_back(at);
  };
  cover(0, sizeof(FileHeader));
  for (std::size_t chunk = first_chunk; chunk < bytes.size(); chunk += chunk_size) {
    ChunkHeader kind;
    std::memcpy(&kind, bytes.data() + chunk, sizeof kind);
    cover(chunk, sizeof kind);
    std::size_t at = chunk + chunk_header_size;
    if (kind.kind == ChunkKind::ticks) {
      for (TickEntry entry;; at += sizeof entry) {
        std::memcpy(&entry, bytes.data() + at, sizeof entry);
        if (entry.sequence == 0) break;
        cover(at, sizeof entry);
      }
      continue;
    }
    for (EventHeader event;; at += aligned(sizeof event + event.size - 1)) {
      std::memcpy(&event, bytes.data() + at, sizeof event);
      if (event.size == 0) break;
      cover(at, sizeof event + event.size - 1);
    }
  }
  ASSERT_GT(words.size(), 600u);
  std::uint32_t random = 1995;
  for (const std::size_t at : words) {
    for (int times = 0; times < 2; ++times) {
      random = random * 1664525 + 1013904223;
      const std::uint32_t change = times == 0 ? 1u << random % 32 : random | 1;
      std::uint32_t word = 0;
      std::memcpy(&word, bytes.data() + at, sizeof word);
      const std::uint32_t changed = word ^ change;
      std::memcpy(bytes.data() + at, &changed, sizeof word);
      EXPECT_FALSE(Recording::read(bytes, "changed")) << "at byte " << at;
      std::memcpy(bytes.data() + at, &word, sizeof word);
    }
  }
}

TEST(RecordingChecks, ALoopRecordsWhatTheActuatorExerted) {
  const TemporaryFolder folder;
  {
    Stage stage(sandpaper(), {.record = RecordTo{folder / "a.wrec", {}}});
    ASSERT_TRUE(stage.add(spring(4000)));  // so stiff that the passivity observer acts
    auto loop = Loop::begin(stage);
    ASSERT_TRUE(loop);
    for (long i = 0; i < 900; ++i) {
      const Force commanded = loop->step({.counts = {static_cast<int>(i * 37 % 200) - 100, 0}});
      loop->exerted(commanded * 0.5f);
      if (i % 3 == 0) loop->exerted(commanded * 0.25f);
      if (i % 50 == 0) loop->exerted(Force(std::numeric_limits<float>::quiet_NaN()));
      EXPECT_EQ(stage.now().force, commanded * (i % 3 == 0 ? 0.25f : 0.5f));
    }
  }
  const Recording recording = opened(folder / "a.wrec");
  ASSERT_EQ(recording.ticks(), 900u);
  for (std::size_t i = 0; i < 900; ++i)
    ASSERT_EQ(recording.tick(i).force, recording.tick(i).commanded * (i % 3 == 0 ? 0.25f : 0.5f)) << i;
  expect_same(recording);
}

TEST(RecordingChecks, PeriodsBeyondAllMeasureAreAGapEachTimeAndCanBeRead) {
  const TemporaryFolder folder;
  constexpr long gaps[] = {std::numeric_limits<long>::max(), 1L << 32, (1L << 32) + 1, 1L << 61, 100, -5,
                           std::numeric_limits<long>::min()};
  long overruns = 0;
  {
    Stage stage(sandpaper(), {.record = RecordTo{folder / "a.wrec", {}}});
    ASSERT_TRUE(stage.add(push(1)));
    auto loop = Loop::begin(stage);
    ASSERT_TRUE(loop);
    for (int round = 0; round < 300; ++round) {
      for (const long gap : gaps) {
        const long before = stage.now().guards.overrun;
        const Force force = loop->step({}, gap);
        const bool first = round == 0 && gap == gaps[0], is_gap = gap > 18 && !first;
        EXPECT_EQ(stage.now().guards.overrun - before, is_gap) << gap;
        if (is_gap) EXPECT_EQ(force, Force(0)) << gap;
        overruns += is_gap;
      }
    }
  }
  const Recording recording = opened(folder / "a.wrec");
  EXPECT_EQ(recording.ticks(), 300 * std::size(gaps));
  expect_same(recording);
  EXPECT_EQ(overruns, 300 * 5 - 1);
}

TEST(RecordingChecks, CallsOfAParentsStageAreRefusedInAChild) {
  WaleProfile profile{};
  profile.size = sizeof profile;
  ASSERT_EQ(wale_profile({"sandpaper", WALE_ZERO_ENDED}, &profile, nullptr), 0);
  WaleStage* stage = nullptr;
  ASSERT_EQ(wale_stage_create_for(&profile, nullptr, &stage, nullptr), 0);
  const int left = in_a_child([&] {
    WaleEdit* edit = nullptr;
    WalePatch* patch = nullptr;
    WaleRun* run = nullptr;
    WaleLoop* loop = nullptr;
    WaleRunOptions options{};
    options.size = sizeof options, options.seconds = 0.01;
    std::size_t dropped = 0;
    const WaleCode codes[] = {wale_stage_edit(stage, &edit, nullptr),
                              wale_stage_on_contact(stage, [](const WaleContact*, void*) {}, nullptr, nullptr),
                              wale_stage_poll(stage, &dropped, nullptr),
                              wale_stage_run(stage, &options, &run, nullptr),
                              wale_stage_start(stage, nullptr),
                              wale_stage_stop(stage, &run, nullptr),
                              wale_loop_begin(stage, &loop, nullptr)};
    int number = 1;
    for (const WaleCode code : codes) {
      if (code != WALE_CODE_wrong_moment) return number;
      ++number;
    }
    return edit == nullptr && patch == nullptr && run == nullptr && loop == nullptr ? 0 : 50;
  });
  EXPECT_EQ(left, 0);
  wale_stage_free(stage);
}

TEST(RecordingChecks, FiguresThatNoDeviceHasAreRefusedBeforeARun) {
  const double none = std::nan("");
  const auto with = [](double DeviceProfile::*figure, double value) {
    DeviceProfile profile = sandpaper();
    profile.*figure = value;
    return profile;
  };
  constexpr double DeviceProfile::*figures[] = {
      &DeviceProfile::workspace_diameter, &DeviceProfile::position_counts, &DeviceProfile::force_newton,
      &DeviceProfile::force_counts, &DeviceProfile::rate, &DeviceProfile::speed_limit, &DeviceProfile::slew,
      &DeviceProfile::continuous_newton, &DeviceProfile::heating_seconds, &DeviceProfile::active_watt,
      &DeviceProfile::velocity_window, &DeviceProfile::velocity_noise_counts, &DeviceProfile::patch_width,
      &DeviceProfile::patch_height, &DeviceProfile::patch_rim, &DeviceProfile::mass, &DeviceProfile::damping,
      &DeviceProfile::friction, &DeviceProfile::delay_x, &DeviceProfile::delay_y, &DeviceProfile::bandwidth_x,
      &DeviceProfile::bandwidth_y};
  const auto refused_by_a_loop = [](const DeviceProfile& profile) {
    Stage stage(profile);
    const auto loop = Loop::begin(stage);
    return !loop && loop.error().code == Code::unusable_device;
  };
  for (const auto figure : figures)
    for (const double value : {none, -1.0, HUGE_VAL, 1e300})
      EXPECT_TRUE(refused_by_a_loop(with(figure, value))) << std::size_t(&figure - figures) << ": " << value;
  for (const double rate : {1e-320, 0.5, 99.0, 1e10})
    EXPECT_TRUE(refused_by_a_loop(with(&DeviceProfile::rate, rate))) << rate;
  EXPECT_TRUE(refused_by_a_loop(with(&DeviceProfile::delay_x, 5)));
  EXPECT_FALSE(refused_by_a_loop(sandpaper()));
  WaleProfile in_c{};
  in_c.size = sizeof in_c;
  ASSERT_EQ(wale_profile({"sandpaper", WALE_ZERO_ENDED}, &in_c, nullptr), 0);
  in_c.position_counts = 1e300;
  WaleStage* stage = nullptr;
  EXPECT_EQ(wale_stage_create_for(&in_c, nullptr, &stage, nullptr), WALE_CODE_malformed_value);
}

}  // namespace
}  // namespace wale::recording_checks_test
