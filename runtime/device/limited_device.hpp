#pragma once

#include <memory>
#include <utility>

#include "runtime/device/user_limit.hpp"
#include "wale/device.hpp"

namespace wale {

/// A simulated device whose user allows less force than it has. (The sessions of real devices limit each packet.)
class LimitedDevice final : public Device {
 public:
  /// `most`: N of the whole vector, of a pad m/s^2; positive.
  LimitedDevice(std::unique_ptr<Device> device, double most)
      : device_(std::move(device)), limit_(device_->profile(), most) {}

  const DeviceProfile& profile() const noexcept override { return device_->profile(); }
  void elapse(long periods) noexcept override { device_->elapse(periods); }
  Reading sample() noexcept override { return device_->sample(); }
  Force command(Force force) noexcept override { return device_->command(limit_.in_steps(limit_.clamped(force))); }

 private:
  std::unique_ptr<Device> device_;
  UserLimit limit_;
};

}  // namespace wale
