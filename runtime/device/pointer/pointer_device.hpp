#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/device/plugged_device.hpp"
#include "runtime/device/pointer/terminal.hpp"
#include "runtime/device/pointer/terminal_reports.hpp"

namespace wale {

struct PointerOptions {
  std::string terminal = "/dev/tty";
  double pictures_per_second = 30;
};

/// The terminal's mouse as a joystick: it moves the hand, and forces are drawn as an arrow, not felt. (Minsky's testbed
/// had such a stand-in, the Dummy.) It needs no permission and no window system, and works over ssh. `command` returns
/// the drawn force, at most the profile's peak force.
///
/// The workspace fills the terminal from the first `command` on, so that earlier messages can be read. Positions have
/// the resolution of the terminal's reports: pixels if it supports mode 1016, otherwise letters of some millimetres.
/// Two threads read the reports and draw the pictures. If the terminal is closed, the device is lost.
class PointerDevice final : public PluggedDevice {
 public:
  /// The profile's workspace and counts must be positive. Error: `unusable_device` without a terminal.
  static Result<std::unique_ptr<PointerDevice>> open(DeviceProfile profile, const PointerOptions& options = {});
  /// Restores the terminal.
  ~PointerDevice() override;
  PointerDevice(const PointerDevice&) = delete;
  PointerDevice& operator=(const PointerDevice&) = delete;

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override;
  Force command(Force force) noexcept override;

  std::string reason() const override;
  std::vector<std::pair<std::string, long>> tally() const override;
  std::string manner() const override;

 private:
  PointerDevice(pointer::Terminal terminal, DeviceProfile profile, const PointerOptions& options);
  void listen();
  bool ends_within(int milliseconds) const;
  void take(const pointer::TerminalReport& report);
  void draw();
  void lose() noexcept { lost_.store(true, std::memory_order_release); }

  pointer::Terminal terminal_;
  const DeviceProfile profile_;
  const double pictures_per_second_;
  int wake_[2] = {-1, -1};  // a pipe whose closing ends both threads

  std::atomic<std::uint64_t> hand_{0};   // counts, two numbers of 32 bits
  std::atomic<std::uint64_t> force_{0};  // two floats
  std::atomic<bool> button_{false}, lost_{false}, in_pixels_{false}, is_wanted_{false}, is_taken_{false};
  std::atomic<int> pixel_width_{0}, pixel_height_{0};
  std::atomic<long> movements_{0}, pictures_{0};
  std::thread listener_, painter_;
};

}  // namespace wale
