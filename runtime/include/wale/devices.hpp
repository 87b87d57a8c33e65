#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wale/declared_device.hpp"
#include "wale/device.hpp"
#include "wale/result.hpp"
#include "wale/simulated.hpp"

namespace wale {

class TrustedDevice;

/// The declarations that may scale a real device: those of its owner, then the shipped ones. What a newton is on a
/// plugged device, and where its axes lie, comes from nothing else.
class TrustedDevices {
 public:
  /// The shipped ones alone.
  TrustedDevices() = default;
  /// For the library, which can read the owner's file (`Library::trusted_devices`).
  explicit TrustedDevices(std::shared_ptr<const std::vector<TrustedDevice>> all) : all_(std::move(all)) {}

  /// Null: the shipped ones alone.
  const std::vector<TrustedDevice>* all() const { return all_.get(); }

 private:
  std::shared_ptr<const std::vector<TrustedDevice>> all_;
};

enum class DeviceKind {
  real,       ///< it is plugged in
  pointer,    ///< the mouse in this process's terminal: forces are drawn, not felt
  simulated,  ///< a declared device in a simulated hand
};

/// A device that `open_device` can open, or why it cannot.
struct DeviceInfo {
  std::string spelling;  ///< for `open_device`: a port as "1-2", "pointer", "simulated:sandpaper"
  DeviceKind kind = DeviceKind::simulated;
  std::string name = {};                      ///< as it calls itself; of a simulated one its profile's
  std::string numbers = {};                   ///< vendor and product on USB, "1209:ffb0"; may be empty
  std::optional<DeviceProfile> profile = {};  ///< its figures; none: no declaration is about it
  bool is_generic = false;                    ///< the figures are assumed, since no declaration names it
  std::string can = {};                       ///< what a real one can do, in a line; may be empty
  std::optional<Error> obstacle = {};         ///< why it cannot be used now; empty if no reason is known
  std::vector<std::string> held_by = {};      ///< other programs that have it open
};

/// All that is plugged in, also what cannot be used, then the pointer, then one simulation for each declared device,
/// first of those in `declared`. Takes some milliseconds for each real device, which is asked for its descriptors only.
/// From any thread, not from a real-time one.
std::vector<DeviceInfo> devices(const TrustedDevices& trusted = {}, std::span<const DeclaredDevice> declared = {});

struct OpenOptions {
  /// The declarations that scale a real device. If none are handed over, only the shipped ones count, and a real device
  /// is refused where its owner declares devices (~/.config/wale/devices.wale), which the runtime alone cannot read:
  /// without the owner's wiring it might push the wrong way. `TrustedDevices{}` disregards that file.
  std::optional<TrustedDevices> trusted = {};
  /// More devices that can be simulated by name, before those of the owner and the shipped ones. They scale no real one.
  std::vector<DeclaredDevice> declared = {};
  /// The device that a program is built for, by the name of its profile; others are refused then. Empty: any.
  std::string built_for = {};
  /// N at the handle (of a pad m/s^2): what is sent to the device keeps within it, also to a simulated one; positive.
  double max_force = HUGE_VAL;
  std::string transport = {};   ///< one of the ways to drive a real device, as "hidraw"; empty: its driver chooses
  /// SCHED_FIFO with this priority, 1 .. 99, for the threads that serve a real device, if it is permitted. Otherwise
  /// they have an ordinary one.
  std::optional<int> priority = {};
  /// Asks the person to do something before a real device can be used, as to move it for homing. From any thread.
  std::function<void(const std::string&)> ask = {};
  /// The program `wale-keeper`, which lets a real device go when this process cannot. Empty: it is found where Wale is
  /// installed (libexec/wale), seen from this library or from the executable, or beside the executable.
  std::string keeper = {};
  /// That holds a simulated device; finite, not negative. All 0: nothing holds it, which is an error with a motion. Its
  /// spring and its damper pull to where the person aims, so a hand with neither is only a mass.
  HandModel hand = {};
  /// Of the person with that hand; finite; a trace as wale/trace.hpp says. None: at rest in the middle.
  std::optional<Motion> motion = {};
};

/// Opens a device as `--device` of the command line spells it: "auto" (the best real one, else a simulated one), "usb",
/// "simulated" (the device of `built_for`, or else `default_device`), "simulated:NAME", the name of a profile, a
/// driver's name ("pointer", "hid-pid"), vendor and product ("1209:ffb0") or a port ("1-2").
///
/// A real device exerts no force until it is commanded, and stops when it is destroyed. A keeper, a process of its own,
/// watches over it from the start, and lets it go when this process dies, hangs or is stopped; without a keeper no
/// device that can hurt is opened. Unplugged and plugged in again it goes on by itself. May take a second; from any
/// thread, not from a real-time one.
///
/// In a child of `fork` an opened device is lost and exerts nothing, also a simulated one: a stage does not run on it.
///
/// Errors: `unknown_device` for a spelling that means nothing; `absent_device` if it is not plugged in;
/// `unusable_device` and other obstacles; `other_device` if it is not that of `built_for`; `untrusted_device` if its
/// owner declares devices and `trusted` has no value; `no_keeper`; `malformed_value` for an option out of its range.
/// `place.name` is the argument's.
Result<std::unique_ptr<Device>> open_device(std::string_view spelling = "auto", const OpenOptions& options = {});

}  // namespace wale
