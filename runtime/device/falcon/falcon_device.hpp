#pragma once

#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/device/falcon/falcon_firmware.hpp"
#include "runtime/device/falcon/falcon_plane.hpp"
#include "runtime/device/falcon/falcon_transport.hpp"
#include "runtime/device/plugged_device.hpp"
#include "runtime/device/trusted_device.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "wale/result.hpp"

namespace wale {

/// Whether a device is a Novint Falcon.
bool is_falcon(const UsbDeviceInfo& info);

struct FalconOptions {
  FalconTransport::Options transport;  ///< its firmware and its torque gate are ignored
  double most_newton = HUGE_VAL;       ///< N at the handle, the user's limit; the hold in the plane counts
  falcon::HoldInPlane hold;
  /// The user's own firmware file, read only if the device runs no firmware, as after a loss of power.
  std::filesystem::path firmware = falcon_firmware_path();
  /// s, for which opening waits for a person to home it.
  double homing_patience = 60;
  /// Becomes true to stop waiting for the person; null: never. Must outlive the opening.
  const std::atomic<bool>* stop = nullptr;
  /// Called with the request to the person, on the thread that opens.
  std::function<void(const std::string&)> ask = {};
};

/// A Novint Falcon as a joystick of two axes: an upright plane across its middle, x to the right, y up, which stands
/// for "away from the user". The handle is held in it (`falcon::HoldInPlane`). Positions are in the profile's counts.
/// The profile's peak force is that of a motor's whole torque at the workspace's middle. Towards the rim the greatest
/// force is less; `command` returns the exerted force.
///
/// It pushes only while it is commanded, and never before its encoders are homed. A lost device (`was_lost`) reads its
/// last position.
class FalconDevice final : public PluggedDevice {
 public:
  /// Loads the firmware if the device runs none, and waits until it is homed. The declaration's counts and force must
  /// be positive. The error names the obstacle: a missing permission and the rule that gives it, another program,
  /// missing firmware and its source, or a handle that nobody has moved.
  static Result<std::unique_ptr<FalconDevice>> open(std::shared_ptr<UsbContext> context, const UsbDeviceInfo& info,
                                                    const TrustedDevice& trusted, const FalconOptions& options = {});

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override;
  Force command(Force force) noexcept override;

  /// Real-time: one atomic load.
  bool was_lost() const noexcept { return transport_->was_lost(); }
  std::string reason() const override { return transport_->reason(); }
  std::vector<std::pair<std::string, long>> tally() const override;
  std::string manner() const override;
  falcon::FalconSessionCounts counts() const { return transport_->counts(); }
  double out_of_plane() const noexcept { return plane_.out_of_plane(); }  ///< m, towards the user

 private:
  FalconDevice(std::unique_ptr<FalconTransport> transport, const TrustedDevice& trusted, const FalconOptions& options);

  std::unique_ptr<FalconTransport> transport_;
  DeviceProfile profile_;
  falcon::FalconPlane plane_;
  bool is_held_;
  MicrosecondClock now_;
  std::int64_t stale_after_;
  bool is_good_ = false;
};

}  // namespace wale
