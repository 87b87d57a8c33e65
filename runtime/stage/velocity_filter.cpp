#include "runtime/stage/velocity_filter.hpp"

#include <algorithm>
#include <cmath>

namespace wale {

VelocityFilter::VelocityFilter(const DeviceProfile& profile)
    : window_(std::max(1LL, std::llround(profile.velocity_window))), noise_(profile.velocity_noise_counts) {
  samples_.resize(static_cast<std::size_t>(window_) + 1);
}

const VelocityFilter::Sample& VelocityFilter::earlier(std::size_t age) const noexcept {
  return samples_[(newest_ + samples_.size() - age) % samples_.size()];
}

/// Whether the line from the newest sample to the one `age` before it passes within the noise of all between. The
/// comparison does not divide, so that samples exactly on the band's edge always count as within.
bool VelocityFilter::line_fits(std::size_t age) const noexcept {
  const Sample &newest = earlier(0), &oldest = earlier(age);
  const auto ticks = static_cast<double>(newest.tick - oldest.tick);
  const double rise = newest.counts - oldest.counts;
  for (std::size_t between = 1; between < age; ++between) {
    const Sample& sample = earlier(between);
    const double off = (sample.counts - oldest.counts) * ticks - rise * static_cast<double>(sample.tick - oldest.tick);
    if (std::abs(off) > noise_ * ticks) return false;
  }
  return true;
}

double VelocityFilter::operator()(int counts, long periods) noexcept {
  const long long tick = held_ == 0 ? 0 : earlier(0).tick + std::max(1L, periods);
  newest_ = (newest_ + 1) % samples_.size();
  samples_[newest_] = {tick, static_cast<double>(counts)};
  held_ = std::min(held_ + 1, samples_.size());
  if (held_ < 2) return 0;

  std::size_t age = 1;  // the window always has at least two samples
  while (age + 1 < held_ && tick - earlier(age + 1).tick <= window_ && line_fits(age + 1)) ++age;
  const Sample& oldest = earlier(age);
  return (static_cast<double>(counts) - oldest.counts) / static_cast<double>(tick - oldest.tick);
}

}  // namespace wale
