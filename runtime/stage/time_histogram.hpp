#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "wale/run.hpp"

namespace wale {

/// A histogram of durations, of fixed size: exact below 64 ns, then 32 buckets for each doubling.
class TimeHistogram {
 public:
  /// Counts one duration; a negative one counts as 0.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void add(std::int64_t nanoseconds) noexcept;

  Times summary() const;

 private:
  static constexpr int exact_bits = 6, split_bits = exact_bits - 1;
  static constexpr std::size_t buckets = std::size_t{64 - split_bits} << split_bits;

  static std::size_t bucket(std::uint64_t nanoseconds) noexcept;
  static double middle(std::size_t bucket);
  double percentile(double fraction) const;

  std::array<std::uint64_t, buckets> counts_{};
  std::uint64_t total_ = 0, maximum_ = 0;
};

}  // namespace wale
