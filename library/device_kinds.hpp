#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/device/hid_pid/pid_transport.hpp"
#include "runtime/device/plugged_device.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "schema/device_profile.hpp"

namespace wale {

/// What devices are plugged into.
struct Connections {
  std::shared_ptr<UsbContext> usb;  ///< null where there is no USB to look at
  std::string without_usb;          ///< why there is none

  static Connections open();
};

/// Something plugged in that may be felt on, as the kind of device that found it sees it.
struct PluggedIn {
  std::string kind;      ///< "hid-pid"
  std::string numbers;   ///< "1209:ffb0"; empty where it is not on USB
  std::string port;      ///< "1-2.3": where; stays the same when it is plugged in there again
  std::string name;      ///< as it calls itself; may be empty
  std::string can;       ///< what it can do, in a line; empty where that is not known
  std::string obstacle;  ///< why it cannot be used, and what to do about it; empty: nothing known is in the way
  std::string holders;   ///< which other programs have it open: "steam (process 4211) has /dev/input/event5 open"
  std::string transport;      ///< by which it would be used, where there are several: "hidraw"
  std::string why_transport;  ///< why not by one that is tried before: "not by hidraw: …"; may be empty
  std::string profile;   ///< the declared device that it is, where its kind knows without numbers; else empty
  UsbDeviceInfo usb;     ///< of one on USB
};

/// "OpenFFBoard (1209:ffb0 at port 1-2)"
std::string in_words(const PluggedIn& plugged);

struct DeviceOptions {
  std::optional<PidTransportKind> transport;  ///< of a joystick of the PID class; none: the first that can be used
  int priority = 0;  ///< SCHED_FIFO, of the threads that serve the device, where permitted; 0: ordinary
  /// Told what the person is to do before it can be used, where there is something; empty: nobody is asked.
  std::function<void(const std::string&)> ask = {};
  const std::atomic<bool>* stop = nullptr;  ///< true: nobody is waited for any more; null: never
};

/// One driver: what it finds, and how it opens it. Everything that chooses, lists, identifies and opens devices goes
/// through the table of these; a new driver is one entry more.
struct DeviceKind {
  std::string_view name;   ///< also a spelling for `--device`: the best of that kind
  bool is_chosen_by_auto;  ///< whether it may be taken without having been named
  /// All that are plugged in, also those that cannot be used; with `like`, only those with its numbers. May take a few
  /// milliseconds each; touches no device more than reading descriptors does.
  std::vector<PluggedIn> (*find)(const Connections& connections, const PluggedIn* like);
  /// Opens what `find` found and sets it up: may take a second. A refusal says why, and leaves the device as it was.
  OpenedDevice (*open)(const Connections& connections, const PluggedIn& plugged, const DeviceProfile& profile,
                       const DeviceOptions& options);
};

/// In the order in which `auto` prefers them.
std::span<const DeviceKind> device_kinds();
/// The one of that name, or null.
const DeviceKind* device_kind(std::string_view name);

}  // namespace wale
