#include "runtime/stage/guards.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace wale {
namespace {

constexpr float furthest = 1e6f;  ///< N, more than any device gives; the energy of a larger force is not metered

}  // namespace

Guards::Guards(const DeviceProfile& profile, double most)
    : low_(-static_cast<float>(profile.most())),
      high_(static_cast<float>(profile.most())),
      limit_(profile, most),
      most_active_(profile.active_watt > 0 ? profile.active_watt : HUGE_VAL),
      max_step_(static_cast<float>(profile.slew / profile.rate)),
      vibrates_(profile.shaker.has_value()),
      meter_(profile),
      heat_(profile),
      observer_(profile) {
  if (vibrates_) {
    low_ = Force(0, static_cast<float>(profile.shaker->frequency_low));
    high_.y = static_cast<float>(profile.shaker->frequency_high);
  }
  slew();
}

Force Guards::operator()(Force wanted, glm::dvec2 position, long periods) noexcept {
  if (std::isnan(wanted.x) || std::isnan(wanted.y)) {
    wanted = Force(0);
    ++counts_.not_a_number;
  }
  const long limited = counts_.user_limit;
  if (vibrates_) return in_steps(slewed(within_limits(wanted)), limited);
  heat_.elapse(periods);
  const long held = meter_.held();
  const Force lawful = meter_(glm::clamp(wanted, -furthest, furthest), position, periods);
  counts_.energy += meter_.held() - held;
  const Force field = in_steps(slewed(within_limits(meter_.held() > held ? lawful : wanted)), limited);
  const long acted = observer_.acted();
  const Force calmed = observer_(field, position, periods);
  counts_.passivity += observer_.acted() - acted;
  return calmed == field && !slewing_ ? field : in_steps(bounded(calmed), limited);
}

Force Guards::cut(Reason reason, glm::dvec2 position, long periods) noexcept {
  switch (reason) {
    case Reason::overrun: ++counts_.overrun; break;
    case Reason::stale: ++counts_.stale; break;
    case Reason::lost: ++counts_.lost; break;
  }
  last_ = Force(0);
  slew();
  if (vibrates_) return Force(0, low_.y);
  heat_.elapse(periods);
  meter_(Force(0), position, periods);
  observer_(Force(0), position, periods);
  return Force(0);
}

Force Guards::within_device(Force wanted) const noexcept { return glm::clamp(wanted, low_, high_); }

Force Guards::in_steps(Force wanted, long counted) noexcept {
  const Force stepped = limit_.in_steps(wanted);
  if (stepped != wanted && counts_.user_limit == counted) ++counts_.user_limit;
  return stepped;
}

Force Guards::bounded(Force wanted) const noexcept { return heat_.held_within(limit_.clamped(within_device(wanted))); }

Force Guards::within_limits(Force wanted) noexcept {
  const Force possible = within_device(wanted), allowed = limit_.clamped(possible);
  // A hand at rest wants frequency 0. The least frequency with amplitude 0 feels the same, so it is not counted.
  if (vibrates_ ? possible.x != wanted.x : possible != wanted) ++counts_.device_limit;
  if (allowed != possible) ++counts_.user_limit;
  if (vibrates_) return allowed;
  const Force borne = heat_.held_within(allowed);
  if (borne != allowed) ++counts_.heat;
  return borne;
}

Force Guards::slewed(Force wanted) noexcept {
  Force force = wanted;
  if (slewing_) {
    Force step = wanted - last_;
    if (vibrates_) step.y = 0;
    const float size = glm::length(step);
    // A fast hand on a fine texture may never be near the wanted force at a tick. If what is missing has turned round,
    // the wanted force came past between the last two ticks: the step to it is then no larger than its own, since the
    // sides of an obtuse angle are shorter than the one across.
    const bool is_passed = ends_when_passed_ && glm::dot(step, missing_) < 0;
    slewing_ = size > max_step_ && !is_passed;
    if (slewing_) {
      force = last_ + step * (max_step_ / size);
      missing_ = wanted - force;
      if (vibrates_) force.y = wanted.y, missing_.y = 0;
      ++counts_.slew;
    }
  }
  last_ = force;
  return force;
}

}  // namespace wale
