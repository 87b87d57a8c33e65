#include "runtime/stage/guards.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace wale {
namespace {

constexpr float furthest = 1e6f;  ///< N; beyond it is no force, and no energy

}  // namespace

Guards::Guards(const DeviceProfile& profile, double most)
    : peak_(static_cast<float>(profile.force_newton)),
      most_(static_cast<float>(most)),
      max_step_(static_cast<float>(profile.slew / profile.rate)),
      meter_(profile),
      observer_(profile) {
  slew();
}

Force Guards::operator()(Force wanted, glm::dvec2 position, long periods) noexcept {
  if (std::isnan(wanted.x) || std::isnan(wanted.y)) {
    wanted = Force(0);
    ++counts_.not_a_number;
  }
  const long held = meter_.held();
  const Force lawful = meter_(glm::clamp(wanted, -furthest, furthest), position, periods);
  counts_.energy += meter_.held() - held;
  const Force field = slewed(within_limits(meter_.held() > held ? lawful : wanted));
  const long acted = observer_.acted();
  const Force calmed = observer_(field, position, periods);
  counts_.passivity += observer_.acted() - acted;
  return glm::clamp(calmed, -peak_, peak_);
}

Force Guards::cut(Reason reason, glm::dvec2 position, long periods) noexcept {
  switch (reason) {
    case Reason::overrun: ++counts_.overrun; break;
    case Reason::stale: ++counts_.stale; break;
    case Reason::lost: ++counts_.lost; break;
  }
  last_ = Force(0);
  slew();
  meter_(Force(0), position, periods);
  observer_(Force(0), position, periods);
  return Force(0);
}

Force Guards::within_limits(Force wanted) noexcept {
  Force within = glm::clamp(wanted, -peak_, peak_);
  if (within != wanted) ++counts_.device_limit;
  if (const float size = glm::length(within); size > most_) {
    within *= most_ / size;
    ++counts_.user_limit;
  }
  return within;
}

Force Guards::slewed(Force wanted) noexcept {
  Force force = wanted;
  if (slewing_) {
    const Force step = wanted - last_;
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
