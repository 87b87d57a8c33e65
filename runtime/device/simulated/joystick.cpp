#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "wale/simulated.hpp"

namespace wale {
namespace {

constexpr int steps_per_tick = 40;
constexpr double most_under_way = 1000;  ///< commands; no device lags by more
constexpr double pi = 3.14159265358979323846;

/// sin(2 pi turns). It does not call libm, because the bits of libm's result depend on the processor.
double sine_of_turns(double turns) noexcept {
  turns -= std::floor(turns + 0.5);  // -0.5 .. 0.5
  if (turns > 0.25) turns = 0.5 - turns;
  if (turns < -0.25) turns = -0.5 - turns;
  const double a = 2 * pi * turns, square = a * a;
  double sum = 0;  // Taylor series; the first omitted term is below 5e-19
  for (int n = 23; n > 1; n -= 2) sum = (sum + 1) * -square / (n * (n - 1));
  return a * (sum + 1);
}

double cosine_of_turns(double turns) noexcept { return sine_of_turns(turns + 0.25); }

struct Where {
  double time;

  TracePoint operator()(const Rest& rest) const noexcept { return {time, rest.position, glm::dvec2(0)}; }

  TracePoint operator()(const Lateral& lateral) const noexcept {
    const double turns = lateral.frequency * time, speed = 2 * pi * lateral.frequency * lateral.amplitude;
    return {time, lateral.centre + lateral.amplitude * sine_of_turns(turns) * lateral.direction,
            speed * cosine_of_turns(turns) * lateral.direction};
  }

  TracePoint operator()(const Press& press) const noexcept {
    const double turns = press.frequency * time, speed = pi * press.frequency * press.depth;
    return {time, press.centre + press.depth * 0.5 * (1 - cosine_of_turns(turns)) * press.direction,
            speed * sine_of_turns(turns) * press.direction};
  }

  TracePoint operator()(const Circular& circle) const noexcept {
    const double turns = circle.frequency * time, speed = 2 * pi * circle.frequency * circle.radius;
    const double cosine = cosine_of_turns(turns), sine = sine_of_turns(turns);
    return {time, circle.centre + circle.radius * glm::dvec2(cosine, sine), speed * glm::dvec2(-sine, cosine)};
  }

  TracePoint operator()(const Trace& trace) const noexcept { return at(trace, time); }
};

/// `force` rounded to the command steps and limited to the actuator's range. Not-a-number gives no force.
double actuated(double force, const DeviceProfile& profile) noexcept {
  if (std::isnan(force)) return 0;
  const double step = profile.force_step();
  return std::round(std::clamp(force, -profile.force_newton, profile.force_newton) / step) * step;
}

int encoded(double position, const DeviceProfile& profile) noexcept {
  const double half = profile.position_counts / 2;
  return static_cast<int>(std::clamp(std::round(position / profile.position_step()), -half, half - 1));
}

/// The velocity after friction, which can take away at most `speed`. It takes all of a smaller velocity, so that a
/// handle at rest stays at rest under any force below friction.
double after_friction(double velocity, double speed) noexcept {
  if (std::abs(velocity) <= speed) return 0;
  return velocity > 0 ? velocity - speed : velocity + speed;
}

}  // namespace

glm::dvec2 heading(double turns) noexcept { return {cosine_of_turns(turns), sine_of_turns(turns)}; }

TracePoint at(const Motion& motion, double time) noexcept { return std::visit(Where{time}, motion); }

SimulatedJoystick::Actuator::Actuator(double delay_seconds, double bandwidth, double step_seconds)
    : delay(std::clamp(delay_seconds / step_seconds, 0.0, most_under_way * steps_per_tick)) {
  under_way.resize(static_cast<std::size_t>(delay / steps_per_tick) + 2);
  const double turn = 2 * pi * bandwidth * step_seconds;
  if (bandwidth > 0) follow = turn / (1 + turn);
}

void SimulatedJoystick::Actuator::command(double wanted) noexcept {
  newest = (newest + 1) % under_way.size();
  under_way[newest] = wanted;
  since = 0;
}

double SimulatedJoystick::Actuator::step() noexcept {
  // The age, in ticks, of the newest command that has arrived; commands come once a tick.
  const double before = std::max(0.0, std::ceil((delay - since) / steps_per_tick));
  const std::size_t back = std::min(static_cast<std::size_t>(before), under_way.size() - 1);
  since += 1;
  force += follow * (under_way[(newest + under_way.size() - back) % under_way.size()] - force);
  return force;
}

SimulatedJoystick::SimulatedJoystick(DeviceProfile profile, HandModel hand, Motion motion)
    : profile_(std::move(profile)),
      hand_(hand),
      motion_(std::move(motion)),
      position_(at(motion_, 0).position),
      actuators_{Actuator(profile_.delay_x, profile_.bandwidth_x, 1 / (profile_.rate * steps_per_tick)),
                 Actuator(profile_.delay_y, profile_.bandwidth_y, 1 / (profile_.rate * steps_per_tick))} {}

void SimulatedJoystick::elapse(long periods) noexcept {
  for (long period = 0; period < periods; ++period) {
    impulse_ = glm::dvec2(0);
    const double seconds = 1 / (profile_.rate * steps_per_tick);
    for (int i = 0; i < steps_per_tick; ++i) {
      const double ticks = static_cast<double>(periods_) + static_cast<double>(i) / steps_per_tick;
      step(at(motion_, ticks / profile_.rate), seconds);
    }
    interaction_ = impulse_ * profile_.rate;
    ++periods_;
  }
}

/// One step of semi-implicit Euler. The hand's spring and damper act on its motion relative to the target.
void SimulatedJoystick::step(const TracePoint& target, double seconds) noexcept {
  const double mass = profile_.mass + hand_.mass;
  const glm::dvec2 before = velocity_;
  const glm::dvec2 hand =
      hand_.stiffness * (target.position - position_) + hand_.damping * (target.velocity - velocity_);
  const glm::dvec2 actuator(actuators_[0].step(), actuators_[1].step());
  velocity_ += (actuator + hand - profile_.damping * velocity_) * (seconds / mass);
  for (int axis = 0; axis < 2; ++axis) {
    velocity_[axis] = after_friction(velocity_[axis], profile_.friction * seconds / mass);
  }
  position_ += velocity_ * seconds;

  const double edge = profile_.workspace_diameter / 2, distance = glm::length(position_);
  if (distance > edge) {
    const glm::dvec2 outward = position_ / distance;
    position_ = outward * edge;
    velocity_ -= outward * std::max(0.0, glm::dot(velocity_, outward));
  }
  impulse_ += hand * seconds - hand_.mass * (velocity_ - before);
}

Reading SimulatedJoystick::sample() noexcept {
  return {glm::ivec2(encoded(position_.x, profile_), encoded(position_.y, profile_)), Force(interaction_)};
}

Force SimulatedJoystick::command(Force force) noexcept {
  const glm::dvec2 commanded(actuated(force.x, profile_), actuated(force.y, profile_));
  actuators_[0].command(commanded.x);
  actuators_[1].command(commanded.y);
  return Force(commanded);
}

}  // namespace wale
