#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/device/plugged_device.hpp"
#include "runtime/device/trusted_device.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "runtime/keeper/keeper.hpp"
#include "wale/result.hpp"

namespace wale {

/// The systems that devices are plugged into, opened once and shared by all drivers.
struct Connections {
  Result<std::shared_ptr<UsbContext>> usb;  ///< the error says why USB cannot be used

  static Connections open();
};

struct Driver;

/// A device that is plugged in, as the driver that found it describes it.
struct PluggedIn {
  const Driver* driver = nullptr;      ///< the driver that found it, never null then
  std::string numbers = {};            ///< "1209:ffb0"; empty if it is not on USB
  std::string port = {};               ///< "1-2.3"; the same when it is plugged in there again
  std::string name = {};               ///< as it calls itself; may be empty
  std::string can = {};                ///< what it can do, in a line; empty if that is not known
  std::optional<Error> obstacle = {};  ///< why it cannot be used; empty if no reason is known
  std::string profile = {};            ///< the name of its declaration, if its driver knows it; else empty
  std::string transport = {};          ///< how it would be driven, and why; empty if there is only one way
  /// Other programs that have it open: "steam (4711) by /dev/input/event5".
  std::vector<std::string> held_by = {};
  long processes_hidden = 0;  ///< processes whose open files this user may not see
  UsbDeviceInfo usb = {};     ///< of a device on USB
};

/// "OpenFFBoard (1209:ffb0 at port 1-2)"
std::string in_words(const PluggedIn& plugged);

struct DeviceOptions {
  int priority = 0;  ///< SCHED_FIFO priority of the threads that serve the device, if permitted; 0: ordinary
  /// Called with the sentence that asks the person to do something before the device can be used. From any thread;
  /// empty: there is no person to ask.
  std::function<void(const std::string&)> ask = {};
  /// Becomes true to stop waiting for the person. Must outlive the device; null: never.
  const std::atomic<bool>* stop = nullptr;
  /// One of its driver's ways to drive it: "hidraw"; empty: the driver chooses.
  std::string transport = {};
  /// An open file of the device that a portal or a broker handed over; -1: none. The caller owns it until opening
  /// succeeds, then the device does. It is used once: a device that was lost and comes back is opened by its driver.
  int descriptor = -1;
  /// N at the handle, the largest force that the user allows: every packet keeps within it, whatever is commanded.
  double most_newton = HUGE_VAL;
  /// The program that lets the device go when this process cannot; every driver of a device that can hurt starts one.
  KeeperOptions keeper = {};
};

/// One driver: how it finds its devices, and how it opens one. Choosing, listing, identifying and opening go through
/// the table of drivers (drivers.def): a new driver is a folder with a driver.cpp, and one row of that table. It is
/// `constinit`, so that the table is whole before any other object is made.
struct Driver {
  std::string_view name;   ///< with `--device` it means the best device of this driver
  bool is_chosen_by_auto;  ///< whether `auto` may take its devices; others must be named
  bool is_felt;            ///< false if its devices only show forces
  /// All of its devices that are plugged in, also those that cannot be used; with `like`, only those with its numbers.
  /// Takes a few milliseconds for each, and only reads descriptors from a device.
  std::vector<PluggedIn> (*find)(const Connections& connections, const PluggedIn* like);
  /// Opens a device that `find` found, and sets it up without force: may take a second. An error leaves the device as
  /// it was. Only the trusted declaration and the options scale and bound its force.
  OpenedDevice (*open)(const Connections& connections, const PluggedIn& plugged, const TrustedDevice& trusted,
                       const DeviceOptions& options);
  /// The ways to drive its devices, as `DeviceOptions::transport` spells them; empty if there is only one.
  std::span<const std::string_view> transports = {};
  /// Whether it drives all devices with these USB numbers, plugged in or not; null where only a plugged device shows
  /// it.
  bool (*drives)(const UsbNumbers& numbers) = nullptr;
  /// What its devices do when this process and their keepers die together, for a person; empty where nothing pushes.
  std::string_view left_alone = {};
};

using Drivers = std::span<const Driver* const>;

/// All drivers, in the order in which `auto` prefers their devices.
Drivers drivers();
/// The names of all ways to drive a device: "hidraw", "libusb".
std::vector<std::string> transport_names(Drivers drivers = wale::drivers());
/// Whether a driver knows this way to drive a device; all know the empty one, by which the driver chooses.
bool has_transport(const Driver& driver, std::string_view transport);
/// The one of that name, or null.
const Driver* find_driver(Drivers drivers, std::string_view name);

/// The plugged devices of all drivers, in the order in which `auto` prefers them. A driver that `auto` does not choose
/// (the pointer, which is always there) is included only if it is `asked` for by its name.
std::vector<PluggedIn> plugged_in(const Connections& connections, std::string_view asked = {},
                                  Drivers drivers = wale::drivers());

}  // namespace wale
