#include "runtime/device/hid_pid/force_gate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace wale::hid {
namespace {

constexpr double degrees_per_radian = 180 / 3.14159265358979323846;

double finite_or_none(double value) noexcept { return std::isnan(value) ? 0 : std::clamp(value, -1.0, 1.0); }

/// The share of its full magnitude that an effect may get within the limit `most`, N, beside another effect that holds
/// `other`. `newton` is its force at full magnitude. The signs are taken as those that add up to the larger force.
double share_beside(glm::dvec2 newton, glm::dvec2 other, double most) noexcept {
  const double square = glm::dot(newton, newton), cross = std::abs(glm::dot(newton, other));
  const double left = most * most - glm::dot(other, other);
  return left > 0 ? (std::sqrt(cross * cross + square * left) - cross) / square : 0;
}

/// Toward zero.
std::int64_t whole(double counts) noexcept { return static_cast<std::int64_t>(counts); }

}  // namespace

std::int64_t commanded_counts(double share, std::int64_t full) noexcept {
  constexpr double of_a_float = 1e-6;  // relative, more than its rounding twice
  return whole(share * static_cast<double>(full) * (1 + of_a_float));
}

glm::dvec2 unit(double degrees) noexcept {
  const double radians = degrees / degrees_per_radian;
  return {std::sin(radians), -std::cos(radians)};
}

glm::dvec2 within(const ForceLimits& limits, glm::dvec2 share) noexcept {
  const glm::dvec2 full = limits.full();
  for (int axis = 0; axis < 2; ++axis) {
    const double most = std::min(1.0, limits.peak[axis] / full[axis]);
    share[axis] = std::clamp(finite_or_none(share[axis]), -most, most);
  }
  const double size = glm::length(share * full);
  return size > limits.most_newton ? share * (limits.most_newton / size) : share;
}

std::int64_t MayHold::most() const noexcept {
  std::int64_t most = 0;
  for (int i = 0; i < count_; ++i) most = std::max(most, std::abs(counts_[static_cast<std::size_t>(i)]));
  return most;
}

void MayHold::submitted(std::int64_t counts) noexcept {
  if (!is_full()) counts_[static_cast<std::size_t>(count_++)] = counts;
}

void MayHold::arrived() noexcept {
  if (count_ == 1) return;
  std::copy(counts_.begin() + 1, counts_.begin() + count_, counts_.begin());
  --count_;
}

ForceGate ForceGate::of_two(const ForceLimits& limits, std::int64_t full_counts,
                            const std::array<glm::dvec2, 2>& directions) noexcept {
  ForceGate gate;
  gate.limits_ = limits;
  gate.full_ = std::max<std::int64_t>(1, full_counts);
  constexpr double rounding = 1e-12;  // of a sine that should be 0
  for (std::size_t i = 0; i < 2; ++i)
    for (int axis = 0; axis < 2; ++axis)
      gate.newton_[i][axis] = std::abs(directions[i][axis]) < rounding ? 0 : directions[i][axis] * limits.full()[axis];
  return gate;
}

ForceGate ForceGate::of_one(const ForceLimits& limits, std::int64_t full_counts, double direction_step,
                            std::int64_t most_direction) noexcept {
  ForceGate gate;
  gate.limits_ = limits;
  gate.full_ = std::max<std::int64_t>(1, full_counts);
  gate.is_one_ = true;
  gate.direction_step_ = direction_step;
  gate.directions_ = std::max<std::int64_t>(1, std::llround(360 / direction_step));
  gate.most_direction_ = most_direction;
  gate.direction_ = std::min<std::int64_t>(most_direction, std::llround(toward_x / direction_step));
  return gate;
}

std::optional<ForceGate::Change> ForceGate::next(glm::dvec2 wanted) noexcept {
  return is_one_ ? next_of_one(wanted) : next_of_two(wanted);
}

void ForceGate::arrived(std::size_t effect) noexcept {
  on_its_way_ = false;
  held_[effect].arrived();
}

/// The most counts within a share of the full force.
std::int64_t ForceGate::counts_of(double share) const noexcept { return whole(share * static_cast<double>(full_)); }

std::int64_t ForceGate::room(std::size_t effect, std::int64_t other) const noexcept {
  const glm::dvec2 newton = newton_[effect];
  const glm::dvec2 beside = newton_[1 - effect] * (static_cast<double>(other) / static_cast<double>(full_));
  // The peak is that of a motor, and each effect is a motor's: it counts by itself.
  double share = std::min(1.0, limits_.peak[static_cast<int>(effect)] / limits_.full()[static_cast<int>(effect)]);
  if (limits_.most_newton < HUGE_VAL) share = std::min(share, share_beside(newton, beside, limits_.most_newton));
  return counts_of(share);
}

std::optional<ForceGate::Change> ForceGate::next_of_two(glm::dvec2 wanted) noexcept {
  const glm::dvec2 target = within(limits_, wanted);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t effect = (turn_ + i) % 2;
    MayHold& held = held_[effect];
    const std::int64_t most = room(effect, held_[1 - effect].most());
    const std::int64_t counts = std::clamp(commanded_counts(target[static_cast<int>(effect)], full_), -most, most);
    if (counts == held.newest() || held.is_full()) continue;
    held.submitted(counts);
    turn_ = 1 - effect;
    return Change{.effect = effect, .magnitude = Magnitude(counts)};
  }
  return std::nullopt;
}

std::int64_t ForceGate::most_along(std::int64_t direction) const noexcept {
  const glm::dvec2 newton = glm::abs(unit(degrees(direction)) * limits_.full());
  double share = std::min(1.0, limits_.most_newton / glm::length(newton));
  for (int axis = 0; axis < 2; ++axis)
    if (newton[axis] > 0) share = std::min(share, limits_.peak[axis] / newton[axis]);
  return counts_of(share);
}

std::int64_t ForceGate::most_along_any() const noexcept {
  const glm::dvec2 full = limits_.full();
  return counts_of(std::min(
      {1.0, limits_.peak.x / full.x, limits_.peak.y / full.y, limits_.most_newton / std::max(full.x, full.y)}));
}

ForceGate::Aim ForceGate::aim(glm::dvec2 wanted) const noexcept {
  double aimed = std::atan2(wanted.x, -wanted.y) * degrees_per_radian, sign = 1;
  const double change = aimed - degrees(direction_) - 360 * std::round((aimed - degrees(direction_)) / 360);
  if (std::abs(change) > 90) {
    aimed += 180;
    sign = -1;
  }
  const std::int64_t steps = std::llround((aimed - 360 * std::floor(aimed / 360)) / direction_step_) % directions_;
  return {std::min(steps, most_direction_), sign};
}

/// A force along one line turns nothing; while the effect is turned, its last magnitude holds for one packet.
std::optional<ForceGate::Change> ForceGate::next_of_one(glm::dvec2 wanted) noexcept {
  if (on_its_way_) return std::nullopt;
  const glm::dvec2 target = within(limits_, wanted);
  const std::int64_t held = held_[0].newest();
  const auto send = [&](std::int64_t counts) -> std::optional<Change> {
    turned_ = false;
    if (counts == held) return std::nullopt;
    held_[0].submitted(counts);
    on_its_way_ = true;
    return Change{.effect = 0, .magnitude = Magnitude(counts)};
  };
  if (commanded_counts(std::min(1.0, glm::length(target)), full_) == 0) return send(0);
  const Aim aimed = aim(target);
  if (!turned_ && aimed.direction != direction_) {
    if (const std::int64_t most = most_along(aimed.direction); std::abs(held) > most)
      return send(std::clamp(held, -most, most));
    direction_ = aimed.direction;
    turned_ = on_its_way_ = true;
    return Change{.effect = 0, .magnitude = Magnitude(held), .turns = true, .direction = degrees(direction_)};
  }
  // Along the direction that was sent, also if the command has moved on.
  const std::int64_t most = most_along(direction_);
  const double along = std::clamp(glm::dot(target, unit(degrees(direction_))), -1.0, 1.0);
  return send(std::clamp(commanded_counts(along, full_), -most, most));
}

std::optional<ForceGate::Change> ForceGate::next_at_once(glm::dvec2 wanted) noexcept {
  const glm::dvec2 target = within(limits_, wanted);
  const std::int64_t most = most_along_any(), held = held_[0].newest();
  const std::int64_t size = std::min(most, commanded_counts(std::min(1.0, glm::length(target)), full_));
  const Aim aimed = size == 0 ? Aim{direction_, 1} : aim(target);
  const std::int64_t counts = aimed.sign < 0 ? -size : size;
  if (counts == held && aimed.direction == direction_) return std::nullopt;
  const bool turns = aimed.direction != std::exchange(direction_, aimed.direction);
  held_[0].submitted(counts);
  held_[0].arrived();
  return Change{.effect = 0, .magnitude = Magnitude(counts), .turns = turns, .direction = degrees(direction_)};
}

}  // namespace wale::hid
