#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <wale/device.hpp>

namespace sandpaper {

/// A device whose workspace has another centre: the place where the handle was, as after the thesis's Reset Encoders.
/// All else is the device's own. The loop's thread has it while it runs; `move_centre` is for the window's thread.
class Recentred final : public wale::Device {
 public:
  explicit Recentred(std::unique_ptr<wale::Device> device) : device_(std::move(device)) {}

  wale::Device& device() const { return *device_; }
  /// Where the centre is, in counts from the device's own one.
  glm::ivec2 centre() const noexcept;
  void move_centre(glm::ivec2 counts) noexcept;

  const wale::DeviceProfile& profile() const noexcept override { return device_->profile(); }
  void elapse(long periods) noexcept override { device_->elapse(periods); }
  wale::Reading sample() noexcept override;
  wale::Force command(wale::Force force) noexcept override { return device_->command(force); }

 private:
  std::unique_ptr<wale::Device> device_;
  std::atomic<std::uint64_t> centre_{0};  // both counts
};

}  // namespace sandpaper
