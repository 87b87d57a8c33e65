#include "runtime/stage/energy_meter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace wale {
namespace {

/// W, negligible: a hundredth of the power that a hand absorbs while it circles slowly. It makes rounding errors of
/// either sign fade from the sum over ticks.
constexpr double negligible_watt = 0.002;

}  // namespace

void EnergyMeter::allow(double range, double active) noexcept {
  range_ = range;
  active_ = active + negligible_watt;
}

Force EnergyMeter::operator()(Force force, glm::dvec2 position, long periods) noexcept {
  const double elapsed = period_ * static_cast<double>(std::max(1L, periods));
  const glm::dvec2 step = begun_ ? position - position_ : glm::dvec2(0);
  glm::dvec2 field(force);
  const double before = given_ + 0.5 * glm::dot(field_, step) - active_ * elapsed, along = 0.5 * glm::dot(field, step);
  if (before + along > range_ && along > 0) {
    // Over half a step, this tick's force may do the work that brings the sum to its limit.
    const double allowed = std::max(0.0, range_ - before);
    field -= step * (2 * (along - std::min(along, allowed)) / glm::dot(step, step));
    ++held_;
  }
  given_ = std::max(0.0, before + 0.5 * glm::dot(field, step));
  begun_ = true;
  position_ = position;
  field_ = field;
  return Force(field);
}

}  // namespace wale
