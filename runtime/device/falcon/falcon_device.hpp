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
#include "schema/result.hpp"

namespace wale {

/// Whether a device is a Novint Falcon.
bool is_falcon(const UsbDeviceInfo& info);

struct FalconOptions {
  FalconTransport::Options transport;  ///< except for the firmware, which is read from its file, and the torque gate
  double most_newton = HUGE_VAL;       ///< N at the handle, what its user allows, the hold in the plane included
  falcon::HoldInPlane hold;
  /// The user's own file, needed and read only after the device was without power.
  std::filesystem::path firmware = falcon_firmware_path();
  /// s; how long opening waits for a person to home it.
  double homing_patience = 60;
  /// True: stop waiting for the person; null: never. Outlives the opening.
  const std::atomic<bool>* stop = nullptr;
  /// Told what the person has to do, on the thread that opens.
  std::function<void(const std::string&)> ask = {};
};

/// A Novint Falcon as a joystick of two axes: an upright plane across its middle, x to the right, y up, which stands
/// for "away from the user". The handle is held in it (`falcon::HoldInPlane`). Positions are in the profile's counts.
/// The profile's peak force is that of a motor's whole torque at the workspace's middle; towards the rim it is less,
/// and `command` returns the force that is exerted.
///
/// It pushes only while it is commanded, and never before its encoders are homed. A lost one (`was_lost`) reads its
/// last place.
class FalconDevice final : public PluggedDevice {
 public:
  /// Loads the firmware where the device runs none, and waits until it is homed. The declaration's counts and force are
  /// positive. The error says what is in the way: permissions and the rule that gives them, another program, missing
  /// firmware and where it comes from, or a handle that nobody has moved.
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
