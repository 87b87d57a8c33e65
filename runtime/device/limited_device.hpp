#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <utility>

#include "wale/device.hpp"

namespace wale {

/// A simulated device whose user allows less force than it has. (The sessions of real devices limit each packet.)
class LimitedDevice final : public Device {
 public:
  /// `most`: N of the whole vector, of a pad m/s^2; not negative.
  LimitedDevice(std::unique_ptr<Device> device, double most) : device_(std::move(device)) {
    const DeviceProfile& figures = device_->profile();
    vibrates_ = figures.shaker.has_value();
    // The device rounds each axis to its steps, and what it exerts must still be within the limit.
    const double rounding = vibrates_ ? 0 : figures.force_step() / std::numbers::sqrt2;
    most_ = static_cast<float>(std::max(0.0, most - rounding));
  }

  const DeviceProfile& profile() const noexcept override { return device_->profile(); }
  void elapse(long periods) noexcept override { device_->elapse(periods); }
  Reading sample() noexcept override { return device_->sample(); }
  Force command(Force force) noexcept override {
    if (vibrates_) return device_->command({std::min(force.x, most_), force.y});
    const float size = glm::length(force);
    return device_->command(size > most_ ? force * (most_ / size) : force);
  }

 private:
  std::unique_ptr<Device> device_;
  bool vibrates_ = false;
  float most_ = 0;
};

}  // namespace wale
