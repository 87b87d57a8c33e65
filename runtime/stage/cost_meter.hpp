#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/stage/loop.hpp"
#include "runtime/stage/time_histogram.hpp"
#include "wale/run.hpp"

namespace wale {

/// Measures how long each step of each tick takes, by the monotonic clock. In virtual time it reads no clock.
class CostMeter {
 public:
  explicit CostMeter(bool reads_clock) : reads_clock_(reads_clock) {}

  /// Begins a tick and its first step.
  /// Real-time: allocates nothing, takes no lock, does not throw; reading the clock is no system call where the kernel
  /// maps it into the process, as Linux does.
  void begin() noexcept {
    if (reads_clock_) began_ = last_ = clock_.now();
  }
  /// Ends the current step and begins the next one. Real-time: allocates nothing, takes no lock, makes no system
  /// call, does not throw.
  void end(TickCosts::Step step) noexcept {
    if (!reads_clock_) return;
    const std::int64_t now = clock_.now();
    steps_[step].add(now - last_);
    last_ = now;
  }
  /// Ends the tick with the step ended last. Real-time: allocates nothing, takes no lock, makes no system
  /// call, does not throw.
  void end_tick() noexcept {
    if (reads_clock_) whole_.add(last_ - began_);
  }

  /// Empty in virtual time.
  std::optional<TickCosts> summary() const;

 private:
  bool reads_clock_;
  MonotonicClock clock_;
  std::int64_t began_ = 0, last_ = 0;  // ns
  std::array<TimeHistogram, TickCosts::steps> steps_;
  TimeHistogram whole_;
};

}  // namespace wale
