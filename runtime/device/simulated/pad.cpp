#include <algorithm>
#include <cmath>
#include <utility>

#include "wale/simulated_pad.hpp"

namespace wale {
namespace {

constexpr int steps_per_period = 40;

/// The command for an acceleration at a frequency, rounded to a step if the device has steps.
double stepped_command(const Shaker& vibration, double acceleration, double frequency) noexcept {
  const double command = std::clamp(vibration.command(acceleration, frequency), 0.0, 1.0);
  if (!(vibration.command_steps > 0)) return command;
  return std::round(command * vibration.command_steps) / vibration.command_steps;
}

int touched(double position, const DeviceProfile& profile) noexcept {
  const double half = profile.position_counts / 2;
  return static_cast<int>(std::clamp(std::round(position / profile.position_step()), -half, half - 1));
}

}  // namespace

SimulatedPad::SimulatedPad(DeviceProfile profile, Motion motion)
    : profile_(std::move(profile)), motion_(std::move(motion)) {}

/// The spin-up by implicit Euler: a step of any length does not pass the target.
void SimulatedPad::elapse(long periods) noexcept {
  periods_ += periods;
  const double seconds = 1 / (profile_.rate * steps_per_period);
  const double share = seconds / (seconds + profile_.shaker->spin_up);
  for (long i = 0; i < periods * steps_per_period; ++i) amplitude_ += share * (target_ - amplitude_);
}

Reading SimulatedPad::sample() noexcept {
  if (!profile_.has_position()) return {};
  const glm::dvec2 place = at(motion_, static_cast<double>(periods_) / profile_.rate).position;
  return {.counts = glm::ivec2(touched(place.x, profile_), touched(place.y, profile_))};
}

Force SimulatedPad::command(Force drive) noexcept {
  const Shaker& vibration = *profile_.shaker;
  const bool number = !std::isnan(drive.x) && !std::isnan(drive.y);
  frequency_ =
      number ? std::clamp<double>(drive.y, vibration.frequency_low, vibration.frequency_high) : vibration.frequency_low;
  const double acceleration = number ? std::max<double>(drive.x, 0) : 0;
  target_ = vibration.acceleration(stepped_command(vibration, acceleration, frequency_), frequency_);
  return {static_cast<float>(amplitude_), static_cast<float>(frequency_)};
}

}  // namespace wale
