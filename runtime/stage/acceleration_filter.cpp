#include "runtime/stage/acceleration_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace wale {
namespace {

constexpr long long most_ticks = 64;

/// A sample relative to the newest one: ticks before it, and counts above it.
struct Point {
  double age, rise;
};

/// rise = place + slope * age + curve * age^2
struct Parabola {
  double place, slope, curve;
};

/// The sums that a least-squares parabola needs, over the points added so far.
class LeastSquares {
 public:
  void add(const Point& point) {
    double power = 1;
    for (int i = 0; i < 5; ++i, power *= point.age) {
      ages_[i] += power;
      if (i < 3) rises_[i] += point.rise * power;
    }
  }

  /// Cramer's rule on the normal equations, which three points of different ages make regular.
  Parabola fit() const {
    const auto& s = ages_;
    const double a = s[2] * s[4] - s[3] * s[3], b = s[2] * s[3] - s[1] * s[4], c = s[1] * s[3] - s[2] * s[2];
    const double d = s[0] * s[4] - s[2] * s[2], e = s[1] * s[2] - s[0] * s[3], f = s[0] * s[2] - s[1] * s[1];
    const double determinant = s[0] * a + s[1] * b + s[2] * c;
    return {(a * rises_[0] + b * rises_[1] + c * rises_[2]) / determinant,
            (b * rises_[0] + d * rises_[1] + e * rises_[2]) / determinant,
            (c * rises_[0] + e * rises_[1] + f * rises_[2]) / determinant};
  }

 private:
  std::array<double, 5> ages_{};   // of powers of ages
  std::array<double, 3> rises_{};  // of rises times powers of ages
};

bool fits(const Parabola& parabola, std::span<const Point> points, double noise) {
  constexpr double rounding = 1e-9;  // counts; samples exactly on the band's edge count as within
  return std::ranges::all_of(points, [&](const Point& point) {
    const double off = point.rise - (parabola.place + point.age * (parabola.slope + point.age * parabola.curve));
    return std::abs(off) <= noise + rounding;
  });
}

}  // namespace

AccelerationFilter::AccelerationFilter(const DeviceProfile& profile)
    : shortest_(std::clamp(std::llround(profile.velocity_window / 2), 2LL, most_ticks)),
      longest_(std::clamp(std::llround(profile.velocity_window * 2), shortest_, most_ticks)),
      noise_(profile.velocity_noise_counts) {
  samples_.resize(static_cast<std::size_t>(longest_) + 1);
}

double AccelerationFilter::operator()(int counts, long periods) noexcept {
  const long long tick = held_ == 0 ? 0 : samples_[newest_].tick + std::max(1L, periods);
  newest_ = newest_ + 1 == samples_.size() ? 0 : newest_ + 1;
  samples_[newest_] = {tick, static_cast<double>(counts)};
  held_ = std::min(held_ + 1, samples_.size());

  std::array<Point, most_ticks + 1> points;
  std::array<Parabola, most_ticks + 1> parabolas;  // through the newest point and those up to this one
  LeastSquares sums;
  std::size_t first = 0, count = 0;  // of the points at which a window may begin
  for (; count < held_; ++count) {
    const Sample& sample = samples_[count <= newest_ ? newest_ - count : newest_ + samples_.size() - count];
    const long long age = tick - sample.tick;
    if (age > longest_) break;
    points[count] = {static_cast<double>(age), sample.counts - counts};
    sums.add(points[count]);
    if (count < 2 || age < shortest_) {
      first = count + 1;
    } else {
      parabolas[count] = sums.fit();
    }
  }
  if (first >= count) return 0;
  // Windows are tried from the longest down, because a short one may exceed the noise where a longer one does not. The
  // shortest is used whether its parabola fits or not.
  std::size_t oldest = count - 1;
  while (oldest > first && !fits(parabolas[oldest], std::span(points).first(oldest + 1), noise_)) --oldest;
  return 2 * parabolas[oldest].curve;
}

PlainDifferences::Result PlainDifferences::operator()(int counts, long periods) noexcept {
  periods = std::max(1L, periods);
  Result result;
  if (seen_ > 0) result.velocity = (static_cast<double>(counts) - counts_) / static_cast<double>(periods);
  if (seen_ > 1) result.acceleration = (result.velocity - velocity_) / (0.5 * static_cast<double>(periods + periods_));
  seen_ = std::min(seen_ + 1, 2L);
  counts_ = counts;
  velocity_ = result.velocity;
  periods_ = periods;
  return result;
}

}  // namespace wale
