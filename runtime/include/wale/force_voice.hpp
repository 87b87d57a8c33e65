#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "wale/device.hpp"

namespace wale {

/// Turns the forces of ticks into sound: x on the left and y on the right, where 1 is the device's peak force. For a pad
/// both channels are the vibration itself: a sine of its amplitude and frequency, where 1 is its greatest acceleration.
/// For one thread at a time; allocates nothing.
class ForceVoice {
 public:
  /// `samples_per_second` is above 0.
  ForceVoice(const DeviceProfile& device, double samples_per_second)
      : most_(device.most()), vibrates_(device.shaker.has_value()), rate_(samples_per_second) {}

  /// The next sample of both channels, while this is a tick's force.
  std::array<float, 2> operator()(Force force) noexcept {
    if (!vibrates_) return {static_cast<float>(force.x / most_), static_cast<float>(force.y / most_)};
    const auto sound = static_cast<float>(force.x / most_ * std::sin(2 * std::numbers::pi * phase_));
    phase_ += static_cast<double>(force.y) / rate_;
    phase_ -= std::floor(phase_);
    return {sound, sound};
  }

 private:
  double most_;
  bool vibrates_;
  double rate_;
  double phase_ = 0;  // turns
};

}  // namespace wale
