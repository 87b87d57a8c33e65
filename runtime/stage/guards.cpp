#include "runtime/stage/guards.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace wale {

Guards::Guards(const DeviceProfile& profile)
    : peak_(static_cast<float>(profile.force_newton)), max_step_(static_cast<float>(profile.slew / profile.rate)) {
  slew();
}

Force Guards::operator()(Force wanted) noexcept {
  if (std::isnan(wanted.x) || std::isnan(wanted.y)) {
    wanted = Force(0);
    ++counts_.not_a_number;
  }
  const Force within = glm::clamp(wanted, -peak_, peak_);
  if (within != wanted) ++counts_.device_limit;
  Force force = within;
  if (slewing_) {
    const Force step = within - last_;
    const float size = glm::length(step);
    slewing_ = size > max_step_;
    if (slewing_) {
      force = last_ + step * (max_step_ / size);
      ++counts_.slew;
    }
  }
  last_ = force;
  return force;
}

}  // namespace wale
