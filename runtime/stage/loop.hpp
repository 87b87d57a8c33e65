#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wale {

/// One served period.
struct Beat {
  long period = 0;            ///< its number since the run began, from 0
  long elapsed = 0;           ///< periods since the last beat; 0 for the first
  long skipped = 0;           ///< periods that passed unserved just before this one
  std::int64_t lateness = 0;  ///< ns after the deadline that the loop waited for
};

/// The system's clock (CLOCK_MONOTONIC).
struct MonotonicClock {
  std::int64_t now() noexcept;                   ///< ns
  void sleep_until(std::int64_t when) noexcept;  ///< ns; signals do not end the sleep
};

/// A clock that advances only by sleeping, so that no tick is late.
struct VirtualClock {
  std::int64_t now() noexcept { return now_; }
  void sleep_until(std::int64_t when) noexcept { now_ = when; }

 private:
  std::int64_t now_ = 0;
};

/// Serves `periods` periods of 1 / `rate` seconds (`rate` in Hz) at absolute deadlines that do not drift, or until
/// `stopped()`. A period that has wholly passed when the loop wakes is skipped, so there are no bursts of late periods.
/// Returns how many were skipped.
/// Real-time: does nothing besides the clock's calls, `stopped()` and `serve(Beat)`.
template <class Clock, class Stopped, class Serve>
long run_loop(Clock& clock, double rate, long periods, Stopped&& stopped,
              Serve&& serve) noexcept(noexcept(stopped()) && noexcept(serve(Beat{}))) {
  const double period = 1e9 / rate;
  const std::int64_t start = clock.now() + std::llround(period);
  const auto deadline = [&](long n) -> std::int64_t { return start + std::llround(period * static_cast<double>(n)); };

  long missed = 0, last = 0;
  for (long n = 0; n < periods; ++n) {
    clock.sleep_until(deadline(n));
    if (stopped()) break;
    const std::int64_t now = clock.now();
    const std::int64_t lateness = std::max<std::int64_t>(0, now - deadline(n));
    long skipped = static_cast<long>(static_cast<double>(lateness) / period);
    if (deadline(n + skipped + 1) <= now) ++skipped;  // deadlines are whole nanoseconds, periods are not
    skipped = std::min(skipped, periods - n);
    missed += skipped;
    n += skipped;
    if (n == periods) break;  // the last periods were skipped
    serve(Beat{n, n - last, skipped, lateness});
    last = n;
  }
  return missed;
}

}  // namespace wale
