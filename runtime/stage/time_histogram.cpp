#include "runtime/stage/time_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace wale {

/// Values of e + 1 bits share the buckets (e - split_bits) * 32 + 32 .. + 63, numbered by their highest six bits.
std::size_t TimeHistogram::bucket(std::uint64_t nanoseconds) noexcept {
  const int shift = std::max(0, static_cast<int>(std::bit_width(nanoseconds)) - exact_bits);
  return (static_cast<std::size_t>(shift) << split_bits) + static_cast<std::size_t>(nanoseconds >> shift);
}

double TimeHistogram::middle(std::size_t bucket) {
  if (bucket < std::size_t{1} << exact_bits) return static_cast<double>(bucket);
  const int shift = static_cast<int>(bucket >> split_bits) - 1;
  const auto high_bits = static_cast<double>(bucket - (static_cast<std::size_t>(shift) << split_bits));
  return std::ldexp(high_bits + 0.5, shift);
}

void TimeHistogram::add(std::int64_t nanoseconds) noexcept {
  const auto time = static_cast<std::uint64_t>(std::max(std::int64_t{0}, nanoseconds));
  ++counts_[bucket(time)];
  ++total_;
  maximum_ = std::max(maximum_, time);
}

double TimeHistogram::percentile(double fraction) const {
  const auto rank = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(total_)));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < buckets; ++i) {
    below += counts_[i];
    if (below >= rank && below > 0) return std::min(middle(i), static_cast<double>(maximum_)) * 1e-9;
  }
  return 0;
}

Times TimeHistogram::summary() const {
  return {percentile(0.5), percentile(0.99), static_cast<double>(maximum_) * 1e-9};
}

}  // namespace wale
