#pragma once

#include <atomic>
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
#include "runtime/device/usb/usb_context.hpp"
#include "schema/result.hpp"

namespace wale {

/// Whether what is plugged in is a Novint Falcon.
bool is_falcon(const UsbDeviceInfo& info);

struct FalconOptions {
  FalconTransport::Options transport;  ///< but for the firmware, which is read from its file
  falcon::HoldInPlane hold;
  /// The user's own file, needed after the device was without power; read only then.
  std::filesystem::path firmware = falcon_firmware_path();
  /// s, for which somebody is waited for who homes it.
  double homing_patience = 60;
  /// Becomes true when nobody wants it any more, so that nobody is waited for; null: never. Outlives the opening.
  const std::atomic<bool>* stop = nullptr;
  /// Told what the person is to do; on the thread that opens.
  std::function<void(const std::string&)> ask = {};
  /// s after the newest answer from which on the position counts as an old one.
  double stale_after = 0.02;
};

/// A Novint Falcon as a joystick of two axes: an upright plane across its middle, x to the right, y up, which stands
/// for "away from the user"; the handle is held in it (`falcon::HoldInPlane`). Positions are in the profile's counts;
/// the profile's peak force is that of a motor's whole torque at the workspace's middle. Towards the rim it is less:
/// what `command` returns is what is exerted.
///
/// It pushes only while somebody commands, and never before its encoders are homed. One that is lost (`was_lost`) stays
/// where it was last seen.
class FalconDevice final : public PluggedDevice {
 public:
  /// Loads the firmware where the device runs none, and waits until it is homed. The profile's counts and force are
  /// positive. The error says what is in the way: permissions and the rule that gives them, another program, missing
  /// firmware and where it comes from, or a handle that nobody has moved.
  static Result<std::unique_ptr<FalconDevice>> open(std::shared_ptr<UsbContext> context, const UsbDeviceInfo& info,
                                                    DeviceProfile profile, const FalconOptions& options = {});

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
  FalconDevice(std::unique_ptr<FalconTransport> transport, DeviceProfile profile, const FalconOptions& options);

  std::unique_ptr<FalconTransport> transport_;
  DeviceProfile profile_;
  falcon::FalconPlane plane_;
  bool is_held_;
  MicrosecondClock now_;
  std::int64_t stale_after_;
  bool is_good_ = false;
};

}  // namespace wale
