#include "runtime/stage/lag.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace wale {
namespace {

constexpr double most_under_way = 1000;  ///< commands; no device lags by more

double lateness(double delay, double bandwidth) {
  return delay + (bandwidth > 0 ? 1 / (2 * std::numbers::pi * bandwidth) : 0.0);
}

}  // namespace

Lag::Lag(const DeviceProfile& profile) {
  const double seconds[] = {lateness(profile.delay_x, profile.bandwidth_x),
                            lateness(profile.delay_y, profile.bandwidth_y)};
  for (int axis = 0; axis < 2; ++axis) {
    const double late = std::clamp(seconds[axis] * profile.rate, 0.0, most_under_way);
    whole_[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(late);
    part_[axis] = late - std::floor(late);
    periods_[axis] = late;
  }
  prompt_ = periods_ == glm::dvec2(0);
  answers_.resize(std::bit_ceil(std::max(whole_[0], whole_[1]) + 2));
}

void Lag::begin(const Answer& answer) noexcept { std::ranges::fill(answers_, answer); }

Lag::Answer Lag::arriving() const noexcept {
  const std::size_t mask = answers_.size() - 1;
  const Answer &x = answers_[(newest_ - whole_[0]) & mask], &x_before = answers_[(newest_ - whole_[0] - 1) & mask];
  const Answer &y = answers_[(newest_ - whole_[1]) & mask], &y_before = answers_[(newest_ - whole_[1] - 1) & mask];
  const glm::dvec2 force(x.force.x, y.force.y), place(x.place.x, y.place.y);
  return {force + part_ * (glm::dvec2(x_before.force.x, y_before.force.y) - force),
          place + part_ * (glm::dvec2(x_before.place.x, y_before.place.y) - place)};
}

Lag::Answer Lag::over(const Answer& held, long periods) noexcept {
  if (prompt_) return held;
  // Periods beyond the number of kept answers would only add `held` again.
  const long count = std::clamp(periods, 1L, static_cast<long>(answers_.size()));
  Answer sum;
  for (long period = 0; period < count; ++period) {
    newest_ = (newest_ + 1) & (answers_.size() - 1);
    answers_[newest_] = held;
    const Answer now = arriving();
    if (count == 1) return now;
    sum = {sum.force + now.force, sum.place + now.place};
  }
  return {sum.force / static_cast<double>(count), sum.place / static_cast<double>(count)};
}

}  // namespace wale
