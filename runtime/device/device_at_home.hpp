#pragma once

#include <memory>
#include <utility>

#include "schema/home_process.hpp"
#include "wale/device.hpp"

namespace wale {

/// A device as `open_device` gives it. In a child of `fork` it is lost, and nothing of it reaches the hardware, which is
/// the parent's. That holds for a simulated one too, so that a program that forks behaves alike on both.
class DeviceAtHome final : public Device {
 public:
  /// `most`: the largest force that the device itself lets through, as its user allows; see `OpenOptions::max_force`.
  DeviceAtHome(std::unique_ptr<Device> device, double most) : device_(std::move(device)), most_(most) {}
  ~DeviceAtHome() override {
    if (!home_.is_here()) abandon(std::move(device_));
  }
  DeviceAtHome(const DeviceAtHome&) = delete;
  DeviceAtHome& operator=(const DeviceAtHome&) = delete;

  bool is_here() const noexcept { return home_.is_here(); }
  double most() const noexcept { return most_; }

  const DeviceProfile& profile() const noexcept override { return device_->profile(); }
  void elapse(long periods) noexcept override {
    if (home_.is_here()) device_->elapse(periods);
  }
  Reading sample() noexcept override {
    return home_.is_here() ? device_->sample() : Reading{.contact = Contact::lost};
  }
  Force command(Force force) noexcept override { return home_.is_here() ? device_->command(force) : Force(0); }

 private:
  const HomeProcess home_;
  std::shared_ptr<Device> device_;
  const double most_;
};

}  // namespace wale
