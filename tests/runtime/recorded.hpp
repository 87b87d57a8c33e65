#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>

#include "runtime/record/format.hpp"
#include "schema/without_place.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/recording.hpp"
#include "wale/stage.hpp"

/// Makes and checks recordings in tests.
namespace wale::recorded {

namespace fs = std::filesystem;

inline std::vector<std::byte> bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

inline Recording opened(const std::string& path) {
  auto recording = Recording::open(path);
  if (!recording) throw std::runtime_error(in_words(recording.error()));
  return *std::move(recording);
}

inline std::string refused(const Result<Recording>& recording) {
  return recording ? "not refused" : in_words_without_place(recording.error());
}

inline RunResult run(Stage& stage, const RunOptions& options) {
  auto result = stage.run(options);
  if (!result) throw std::runtime_error(in_words(result.error()));
  return *std::move(result);
}

inline void expect_same(const Recording& recording) {
  const auto result = replay(recording);
  ASSERT_TRUE(result) << in_words(result.error());
  const auto& replayed = *result;
  EXPECT_EQ(replayed.ticks, recording.ticks());
  EXPECT_EQ(replayed.differing, 0u);
  if (replayed.first)
    ADD_FAILURE() << "tick " << replayed.first->tick << ": " << replayed.first->what << " was "
                  << replayed.first->recorded << " and is " << replayed.first->replayed;
}

/// A device whose readings the test supplies.
class Puppet : public Device {
 public:
  explicit Puppet(std::function<Reading(long sample)> reading) : reading_(std::move(reading)) {}
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override { return reading_(samples_++); }
  Force command(Force force) noexcept override { return force * 0.75f; }  // a weak actuator, so that the two differ

  DeviceProfile profile_ = sandpaper();

 private:
  std::function<Reading(long)> reading_;
  long samples_ = 0;
};

/// A path over the workspace and beyond its patches, at up to 1 m/s.
inline Reading roaming(long sample) {
  const double t = static_cast<double>(sample) / 900;
  const auto place = [](double amplitude, double phase) {
    return static_cast<int>(std::lround(amplitude * std::sin(phase)));
  };
  return {.counts = {place(1800, 2.1 * t), place(900, 7.7 * t)}, .button = sample % 700 > 600};
}

}  // namespace wale::recorded
