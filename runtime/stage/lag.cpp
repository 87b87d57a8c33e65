#include "runtime/stage/lag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wale {
namespace {

constexpr double most_under_way = 1000;  ///< commands: no device is that late

double lateness(double delay, double bandwidth) {
  return delay + (bandwidth > 0 ? 1 / (2 * std::numbers::pi * bandwidth) : 0.0);
}

}  // namespace

Lag::Lag(const DeviceProfile& profile) {
  const double seconds[] = {lateness(profile.delay_x, profile.bandwidth_x),
                            lateness(profile.delay_y, profile.bandwidth_y)};
  for (int axis = 0; axis < 2; ++axis) {
    const double late = std::clamp(seconds[axis] * profile.rate, 0.0, most_under_way);
    late_[static_cast<std::size_t>(axis)] = {static_cast<std::size_t>(late), late - std::floor(late)};
    periods_[axis] = late;
  }
  prompt_ = periods_ == glm::dvec2(0);
  commands_.resize(static_cast<std::size_t>(std::max(periods_.x, periods_.y)) + 2, glm::dvec2(0));
}

void Lag::begin(glm::dvec2 command) noexcept { std::ranges::fill(commands_, command); }

glm::dvec2 Lag::over(glm::dvec2 held, long periods) noexcept {
  if (prompt_) return held;
  // Beyond as many as are remembered nothing new comes.
  const long count = std::clamp(periods, 1L, static_cast<long>(commands_.size()));
  glm::dvec2 sum(0);
  for (long period = 0; period < count; ++period) {
    newest_ = newest_ + 1 == commands_.size() ? 0 : newest_ + 1;
    commands_[newest_] = held;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto [whole, part] = late_[axis];
      const auto command = [&](std::size_t back) {
        return commands_[newest_ >= back ? newest_ - back : newest_ + commands_.size() - back][static_cast<int>(axis)];
      };
      sum[static_cast<int>(axis)] += (1 - part) * command(whole) + part * command(whole + 1);
    }
  }
  return sum / static_cast<double>(count);
}

}  // namespace wale
