#pragma once

#include <vector>

#include "wale/device_profile.hpp"

namespace wale {

/// Velocity from encoder counts, for one axis: the slope over the longest window in which the straight line from the
/// oldest to the newest sample passes within the noise of all samples between (Janabi-Sharifi, Hayward, Chen 2000,
/// "first-order adaptive windowing", end-fit). The window is long while the hand moves steadily and short when it
/// turns.
class VelocityFilter {
 public:
  /// The profile's `velocity_window` in ticks (at least one is used) and `velocity_noise_counts`. Allocates.
  explicit VelocityFilter(const DeviceProfile& profile);

  /// Takes the sample `counts`, `periods` ticks after the last one (at least 1; more when some were skipped), and
  /// returns counts per tick. The first sample gives zero.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  double operator()(int counts, long periods) noexcept;

 private:
  struct Sample {
    long long tick = 0;
    double counts = 0;
  };

  /// The sample `age` samples before the newest.
  const Sample& earlier(std::size_t age) const noexcept;
  bool line_fits(std::size_t age) const noexcept;

  std::vector<Sample> samples_;  // a ring
  std::size_t newest_ = 0, held_ = 0;
  long long window_;  // ticks
  double noise_;      // counts
};

}  // namespace wale
