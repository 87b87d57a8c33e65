// The force as sound, against closed forms of what was put in.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <wale/simulated.hpp>

#include "driven_window.hpp"
#include "feeling/sound.hpp"

namespace sandpaper {
namespace {

constexpr int rate = 48000;

wale::DeviceProfile profile() {
  wale::DeviceProfile device;
  device.rate = 900;
  device.force_newton = 10;
  return device;
}

/// So many frames of both channels, 1 the greatest.
std::vector<std::array<double, 2>> sounded(ForceSamples& samples, int frames) {
  const QByteArray data = samples.read(4ll * frames);
  std::vector<std::array<double, 2>> all;
  for (qsizetype i = 0; i + 3 < data.size(); i += 4) {
    std::int16_t both[2];
    std::memcpy(both, data.data() + i, sizeof both);
    all.push_back({both[0] / 32767.0, both[1] / 32767.0});
  }
  return all;
}

/// The amplitude of a sine of a whole number of periods within the samples.
double amplitude(const std::vector<std::array<double, 2>>& samples, int channel, double hertz) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    sum += samples[i][channel] * std::polar(1.0, -2 * std::numbers::pi * hertz * static_cast<double>(i) / rate);
  return 2 * std::abs(sum) / static_cast<double>(samples.size());
}

TEST(Sound, ASineOfForceIsOneOfTheSamePitchAndSize) {
  HeardForces forces;
  ForceSamples samples(forces);
  samples.begin(profile(), rate);
  // 5 N at 60 Hz along x and 2 N at 90 Hz along y, of 10 N: half and a fifth of the greatest. 900 ticks are 48 000 frames.
  std::vector<std::array<double, 2>> heard;
  for (int tick = 0; tick < 2700; tick += 9) {
    for (int i = tick; i < tick + 9; ++i) {
      const double turns = 2 * std::numbers::pi * i / 900;
      forces.put({static_cast<float>(5 * std::sin(60 * turns)), static_cast<float>(2 * std::sin(90 * turns))});
    }
    for (const auto& each : sounded(samples, 480)) heard.push_back(each);
  }
  const std::vector<std::array<double, 2>> second(heard.end() - rate, heard.end());
  // What is held for a tick is less by sin(x) / x.
  const auto held = [](double hertz) { return std::sin(std::numbers::pi * hertz / 900) / (std::numbers::pi * hertz / 900); };
  EXPECT_NEAR(amplitude(second, 0, 60), 0.5 * held(60), 0.002);
  EXPECT_NEAR(amplitude(second, 1, 90), 0.2 * held(90), 0.002);
  EXPECT_LT(amplitude(second, 0, 90), 0.002);
  EXPECT_LT(amplitude(second, 1, 60), 0.002);
}

TEST(Sound, WithoutTicksItFadesAndThenGoesOnWithWhatIsNew) {
  HeardForces forces;
  ForceSamples samples(forces);
  samples.begin(profile(), rate);
  const auto in_pieces = [&](int pieces) {  // of a fiftieth of a second, as a sound system asks for
    std::vector<std::array<double, 2>> all;
    for (int i = 0; i < pieces; ++i)
      for (const auto& each : sounded(samples, rate / 50)) all.push_back(each);
    return all;
  };
  for (int i = 0; i < 90; ++i) forces.put({10, -10});
  auto heard = in_pieces(3);
  EXPECT_EQ(heard.back()[0], 1);
  EXPECT_EQ(heard.back()[1], -1);
  heard = in_pieces(25);  // the last ticks, and then none
  for (std::size_t i = 1; i < heard.size(); ++i) ASSERT_LE(heard[i][0], heard[i - 1][0]) << i;  // without a click
  EXPECT_LT(heard.back()[0], 1e-3);
  // A loop that was late and puts a second's ticks at once: the old ones are left out.
  for (int i = 0; i < 900; ++i) forces.put({i < 800 ? -10.f : 5.f, 0});
  heard = in_pieces(1);
  EXPECT_NEAR(heard.back()[0], 0.5, 1e-3);
}

TEST(Sound, APadIsHeardAsItVibrates) {
  HeardForces forces;
  ForceSamples samples(forces);
  wale::DeviceProfile pad;
  for (const wale::DeclaredDevice& each : wale::Library().devices())
    if (each.profile.shaker) pad = each.profile;
  ASSERT_TRUE(pad.shaker);
  samples.begin(pad, rate);
  std::vector<std::array<double, 2>> heard;
  for (int i = 0; i < 50; ++i) {
    for (int tick = 0; tick < 9; ++tick) forces.put({static_cast<float>(pad.most() / 4), 150});
    for (const auto& each : sounded(samples, static_cast<int>(9 * rate / pad.rate))) heard.push_back(each);
  }
  const std::vector<std::array<double, 2>> steady(heard.end() - rate / 10, heard.end());
  EXPECT_NEAR(amplitude(steady, 0, 150), 0.25, 0.002);
  EXPECT_NEAR(amplitude(steady, 1, 150), 0.25, 0.002);
}

TEST(Sound, NotANumberIsSilent) {
  HeardForces forces;
  ForceSamples samples(forces);
  samples.begin(profile(), rate);
  for (int i = 0; i < 90; ++i) forces.put({NAN, INFINITY});
  for (const auto& each : sounded(samples, rate / 20)) ASSERT_EQ(each[0], 0);
}

TEST_F(DrivenWindow, WhatIsRubbedIsHeard) {
  ASSERT_TRUE(window->open(write("buzz.wale", R"(wale 1

material buzz {
  physical { force = vector(2 N * sin(2 * pi * 90 Hz * time), 0 N) }
}

workspace one {
  patch all = buzz { size 100 mm, 100 mm }
}
)")));
  wait_for_programs();
  trigger("feel");
  rub(0, 0, 5, 1);
  ForceSamples samples(window->feeling().heard());
  samples.begin(window->feeling().profile(), rate);
  std::vector<std::array<double, 2>> heard;
  QElapsedTimer timer;
  timer.start();
  while (heard.size() < rate) {
    QTest::qWait(10);
    const auto due = static_cast<std::size_t>(timer.nsecsElapsed() * 1e-9 * rate);
    for (const auto& each : sounded(samples, static_cast<int>(due - heard.size()))) heard.push_back(each);
  }
  trigger("feel");
  // The timers of a busy machine leave gaps; most of its size is at its own pitch all the same.
  const std::vector<std::array<double, 2>> late(heard.end() - rate / 2, heard.end());
  const double most = window->feeling().profile().force_newton;
  EXPECT_GT(amplitude(late, 0, 90), 0.5 * 2 / most);
  EXPECT_LT(amplitude(late, 0, 75), 0.3 * 2 / most);
}

TEST_F(DrivenWindow, WithoutALoudspeakerItIsSaid) {
  if (!QMediaDevices::defaultAudioOutput().isNull()) GTEST_SKIP() << "this computer has one";
  window->action("hear")->trigger();
  EXPECT_TRUE(announced().contains("loudspeaker")) << announced().toStdString();
  EXPECT_FALSE(window->action("hear")->isChecked());
}

}  // namespace
}  // namespace sandpaper
