#pragma once

#include <vector>

#include "wale/device_profile.hpp"

namespace wale {

/// Acceleration from encoder counts, for one axis: twice the curvature of the least-squares parabola over the longest
/// window in which the parabola passes within the noise of all samples. This is `VelocityFilter` with one order more:
/// the window is short where the motion turns sharply and long where it is smooth.
///
/// A second difference of counts is useless (at 900 Hz one count is 45 m/s^2 on a 0.23 m workspace of 4096 counts), and
/// the noise of a parabola's curvature falls with the power 5/2 of its length. So windows are longer than for velocity:
/// at least half of the profile's `velocity_window`, at most twice it, and at most 64 ticks. The estimate holds for
/// the window's middle, so it lags by half the window: 17 ms for 15 ticks of velocity window at 900 Hz.
class AccelerationFilter {
 public:
  /// The profile's `velocity_window` in ticks and `velocity_noise_counts`. Allocates.
  explicit AccelerationFilter(const DeviceProfile& profile);

  /// Takes the sample `counts`, `periods` ticks after the last one (at least 1; more when some were skipped), and
  /// returns counts per tick^2: zero until samples span the shortest window, and again after a gap longer than the
  /// longest window. Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  double operator()(int counts, long periods) noexcept;

 private:
  struct Sample {
    long long tick = 0;
    double counts = 0;
  };

  std::vector<Sample> samples_;  // a ring
  std::size_t newest_ = 0, held_ = 0;
  long long shortest_, longest_;  // ticks
  double noise_;                  // counts
};

/// Velocity and acceleration as plain differences, for one axis: in counts per tick and per tick squared.
class PlainDifferences {
 public:
  struct Result {
    double velocity = 0, acceleration = 0;
  };

  /// Takes the sample `counts`, `periods` ticks after the last one (at least 1). Velocity is zero at the first sample,
  /// acceleration at the first two. Acceleration is the difference of the last two velocities over the time between
  /// the middles of their intervals, which skipped periods lengthen.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Result operator()(int counts, long periods) noexcept;

 private:
  long seen_ = 0;
  int counts_ = 0;
  double velocity_ = 0;
  long periods_ = 1;
};

}  // namespace wale
