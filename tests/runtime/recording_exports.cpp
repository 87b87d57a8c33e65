// Exports of recordings: CSV that reads back as a trace, and the force as sound.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>

#include "runtime/record/format.hpp"
#include "runtime/record/record_writer.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/schema/example_program.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/recording.hpp"
#include "wale/trace.hpp"

namespace wale::recording_exports_test {
namespace {

/// A recording of the given ticks.
Recording recording_of(const DeviceProfile& device, const std::vector<RecordedTick>& ticks) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.wrec";
  {
    const auto begun = RecordWriter::begin(file, {.device = device, .most_newton = 5}, true);
    RecordWriter& writer = **begun;
    writer.publish(1);
    for (const RecordedTick& tick : ticks) writer.append(tick);
    writer.end();
  }
  auto recording = Recording::open(file);
  if (!recording) throw std::runtime_error(in_words(recording.error()));
  return *std::move(recording);
}

/// `count` ticks; tick n has the force (0.01 n, -0.02 n) N.
std::vector<RecordedTick> rising(long count) {
  std::vector<RecordedTick> ticks;
  for (long i = 0; i < count; ++i)
    ticks.push_back({.period = i,
                     .elapsed = i > 0 ? 1u : 0u,
                     .revision = 1,
                     .force = Force(0.01f * static_cast<float>(i), -0.02f * static_cast<float>(i))});
  return ticks;
}

struct Wav {
  std::uint32_t riff_size = 0, rate = 0, frames = 0, data_size = 0;
  std::uint16_t format = 0, channels = 0, bits = 0;
  std::vector<float> left, right;
};

Wav wav_of(const Recording& recording) {
  std::ostringstream out;
  EXPECT_TRUE(write_wav(out, recording));
  const std::string bytes = out.str();
  const auto number = [&](std::size_t at, auto value) {
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 4) + bytes.substr(8, 8) + bytes.substr(38, 4) + bytes.substr(50, 4),
            "RIFFWAVEfmt factdata");
  Wav wav{.riff_size = number(4, std::uint32_t{}),
          .rate = number(24, std::uint32_t{}),
          .frames = number(46, std::uint32_t{}),
          .data_size = number(54, std::uint32_t{}),
          .format = number(20, std::uint16_t{}),
          .channels = number(22, std::uint16_t{}),
          .bits = number(34, std::uint16_t{})};
  EXPECT_EQ(wav.riff_size + 8, bytes.size());
  EXPECT_EQ(58 + wav.data_size, bytes.size());
  for (std::size_t at = 58; at + 8 <= bytes.size(); at += 8) {
    wav.left.push_back(number(at, 0.0f));
    wav.right.push_back(number(at + 4, 0.0f));
  }
  EXPECT_EQ(wav.left.size(), wav.frames);
  return wav;
}

TEST(RecordingAsSound, HoldsEachTicksForceAsAFractionOfThePeak) {
  const Wav wav = wav_of(recording_of(sandpaper(), rising(900)));
  EXPECT_EQ(wav.format, 3);  // IEEE float
  EXPECT_EQ(wav.channels, 2);
  EXPECT_EQ(wav.bits, 32);
  EXPECT_EQ(wav.rate, 44100u);
  ASSERT_EQ(wav.frames, 44100u);
  for (std::size_t i = 0; i < wav.left.size(); ++i) {
    const auto tick = static_cast<double>(i / 49);  // 44100 / 900
    ASSERT_NEAR(wav.left[i], 0.01 * tick / 10, 1e-6) << i;
    ASSERT_NEAR(wav.right[i], -0.02 * tick / 10, 1e-6) << i;
  }
}

TEST(RecordingAsSound, LastsAsLongAsTheRunAtAnyRateAndThroughSkippedPeriods) {
  DeviceProfile device = sandpaper();
  device.rate = 1000;
  std::vector<RecordedTick> ticks = rising(1500);
  for (std::size_t i = 700; i < ticks.size(); ++i) ticks[i].period += 500;
  ticks[700].elapsed = 501;
  ticks[700].skipped = 500;
  const Wav wav = wav_of(recording_of(device, ticks));
  EXPECT_EQ(wav.frames, 88200u);
  for (std::size_t i = 0; i < wav.left.size(); ++i) {
    const auto period = std::floor(static_cast<double>(i) * 1000 / 44100 + 1e-9);
    const double tick = period < 700 ? period : period < 1200 ? 699 : period - 500;
    ASSERT_NEAR(wav.left[i], 0.01 * tick / 10, 1e-6) << i;
  }
}

TEST(RecordingAsSound, OfAPadIsItsVibration) {
  const DeviceProfile pad = example::pad(PositionSource::touch).device;
  std::vector<RecordedTick> ticks = rising(static_cast<long>(pad.rate));
  for (RecordedTick& tick : ticks) tick.force = Force(static_cast<float>(pad.most()) / 2, 100);
  const Wav wav = wav_of(recording_of(pad, ticks));
  for (std::size_t i = 0; i < wav.left.size(); ++i) {
    ASSERT_NEAR(wav.left[i], 0.5 * std::sin(2 * std::numbers::pi * 100 * static_cast<double>(i) / 44100), 1e-6) << i;
    ASSERT_EQ(wav.right[i], wav.left[i]);
  }
}

TEST(RecordingAsSound, MoreThanAWavFileHoldsIsRefused) {
  std::vector<RecordedTick> ticks = rising(2);
  ticks[1].period = 12'000'000;  // 13 333 s of 352 800 bytes
  ticks[1].elapsed = 12'000'000;
  std::ostringstream out;
  const auto written = write_wav(out, recording_of(sandpaper(), ticks));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::unwritable_file);
  EXPECT_NE(written.error().sentence.find("4 GiB"), std::string::npos) << written.error().sentence;
  EXPECT_EQ(out.str(), "");
}

TEST(RecordingAsCsv, HasTheColumnsOfARecordAndMore) {
  std::vector<RecordedTick> ticks = rising(2);
  ticks[1] = {.period = 9,
              .lateness = 250000,
              .elapsed = 9,
              .skipped = 8,
              .counts = {2048, -1024},
              .contact = Contact::stale,
              .button = true,
              .inside = true,
              .patch = 3,
              .revision = 1,
              .guards = static_cast<std::uint32_t>(GuardBit::stale) | static_cast<std::uint32_t>(GuardBit::slew),
              .velocity = {0.5f, 0},
              .wanted = {1.25f, 0},
              .commanded = {1, 0},
              .force = {0.75f, 0},
              .interaction = Force(std::nanf(""))};
  std::ostringstream out;
  write_csv(out, recording_of(sandpaper(), ticks));
  EXPECT_EQ(out.str(),
            "t (s),x (m),y (m),vx (m/s),vy (m/s),force x (N),force y (N),interaction x (N),interaction y (N),"
            "lateness (s),skipped (periods),inside,counts x,counts y,program force x (N),program force y (N),"
            "commanded force x (N),commanded force y (N),patch,revision,contact,button,guards\n"
            "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,,1,good,0,\n"
            "0.01,0.1143,-0.05715,0.5,0,0.75,0,,,0.00025,8,1,2048,-1024,1.25,0,1,0,3,1,stale,1,slew + stale\n");
  const auto trace = read_trace(out.str());
  ASSERT_TRUE(trace);
  EXPECT_EQ(trace->points.size(), 2u);
}

}  // namespace
}  // namespace wale::recording_exports_test
