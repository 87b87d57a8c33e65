#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/device/hid_pid/open_pid_transport.hpp"
#include "runtime/device/plugged_device.hpp"
#include "runtime/device/trusted_device.hpp"
#include "runtime/device/usb/usb_context.hpp"

namespace wale {

/// A force-feedback joystick of USB's PID class, laid out by its report descriptor. Positions are scaled from the
/// descriptor's range to the profile's counts, forces from the trusted peak force to the descriptor's range. HID's y
/// points to the user and is reversed: here x points to the right and y away. The caller turns the axes further by the
/// device's `DeviceWiring`.
///
/// If each of two axes has an effect, each packet carries one axis: they alternate when both change, which halves the
/// rate of each. A lost device (`was_lost`) exerts no force and keeps its last position.
class HidPidDevice final : public PluggedDevice {
 public:
  struct Options : PidTransportOptions {
    std::optional<PidTransportKind> transport;  ///< none: the first one of `transports_by_preference` that can be used
  };

  /// Takes the first interface of the device that can push, and sets it up from zero force. The declaration's counts
  /// and force must be positive; with `options.most_newton` it sets the limits of the session. The error names the
  /// obstacle: a missing permission and the rule that gives it, another program, that it is no force device, or what
  /// its descriptor lacks.
  static Result<std::unique_ptr<HidPidDevice>> open(const std::shared_ptr<UsbContext>& context,
                                                    const UsbDeviceInfo& info, const TrustedDevice& trusted,
                                                    const Options& options = {});
  /// Uses a hidraw, evdev or usbfs node that another party, such as a portal or a broker, has opened for reading and
  /// writing. Detects the kind of the node. The other party still owns the descriptor. The context is for usbfs and may
  /// be null otherwise; `options.transport` is ignored.
  static Result<std::unique_ptr<HidPidDevice>> open(const std::shared_ptr<UsbContext>& context, int descriptor,
                                                    const TrustedDevice& trusted, const Options& options = {});

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override;
  Force command(Force force) noexcept override;

  /// Real-time: one atomic load.
  bool was_lost() const noexcept { return transport_->was_lost(); }
  std::string reason() const override { return transport_->reason(); }
  std::vector<std::pair<std::string, long>> tally() const override;
  std::string manner() const override;
  PidTransportKind transport() const noexcept { return transport_->kind(); }
  hid::Arrangement arrangement() const { return transport_->arrangement(); }
  hid::PidSessionCounts counts() const { return transport_->counts(); }
  /// What OpenFFBoard's firmware reports about its motors; nothing from other firmware. Not real-time.
  std::optional<hid::Telemetry> telemetry() const { return transport_->telemetry(); }

 private:
  HidPidDevice(OpenedPidTransport opened, DeviceProfile profile, const ForceLimits& limits);

  std::unique_ptr<PidTransport> transport_;
  std::string why_;  // not a transport that is tried before
  DeviceProfile profile_;
  ForceLimits limits_;
};

}  // namespace wale
