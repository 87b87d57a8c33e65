#include "runtime/stage/guards.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace wale {

Guards::Guards(const DeviceProfile& profile)
    : low_(-static_cast<float>(profile.most())),
      high_(static_cast<float>(profile.most())),
      max_step_(static_cast<float>(profile.slew / profile.rate)),
      vibrates_(profile.shaker.has_value()) {
  if (vibrates_) {
    low_ = Force(0, static_cast<float>(profile.shaker->frequency_low));
    high_.y = static_cast<float>(profile.shaker->frequency_high);
  }
  slew();
}

Force Guards::operator()(Force wanted) noexcept {
  if (std::isnan(wanted.x) || std::isnan(wanted.y)) {
    wanted = Force(0);
    ++counts_.not_a_number;
  }
  const Force within = glm::clamp(wanted, low_, high_);
  // A hand at rest wants no frequency, and nothing is held back when it gets the least one with no amplitude.
  if (vibrates_ ? within.x != wanted.x : within != wanted) ++counts_.device_limit;
  Force force = within;
  if (slewing_) {
    Force step = within - last_;
    if (vibrates_) step.y = 0;
    const float size = glm::length(step);
    slewing_ = size > max_step_;
    if (slewing_) {
      force = last_ + step * (max_step_ / size);
      if (vibrates_) force.y = within.y;
      ++counts_.slew;
    }
  }
  last_ = force;
  return force;
}

}  // namespace wale
