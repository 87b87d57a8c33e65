#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/device/usb/usb_context.hpp"

namespace wale {

/// The nodes by which programs reach one HID interface to which the kernel's driver is bound.
struct HidNodes {
  std::uint8_t interface = 0;                   ///< its number
  std::string hidraw;                           ///< "/dev/hidraw3"; empty: there is none
  std::vector<std::string> events;              ///< "/dev/input/event5", …
  std::vector<std::string> pushing;             ///< those of `events` whose driver makes constant forces
  std::vector<std::string> others;              ///< "/dev/input/js0", …
  std::vector<std::uint8_t> report_descriptor;  ///< as the kernel's driver has read it; empty if sysfs does not have it
};

/// The nodes of a plugged device that sysfs lists.
struct KernelNodes {
  std::string product;  ///< as the device calls itself; may be empty
  std::string usbfs;    ///< "/dev/bus/usb/001/004"
  std::vector<HidNodes> hid;

  const HidNodes* of(std::uint8_t interface) const;
  std::vector<std::string> all() const;
};
KernelNodes kernel_nodes(const UsbDeviceInfo& info);
/// "/dev/bus/usb/001/004"
std::string usbfs_node(int bus, int address);

/// A program that has a node open.
struct NodeHolder {
  int process = 0;
  std::string program;  ///< as the kernel calls it, at most 15 letters
  std::string node;

  friend bool operator==(const NodeHolder&, const NodeHolder&) = default;
};

struct NodeHolders {
  std::vector<NodeHolder> seen;  ///< in the order of their processes; this process is not among them
  long hidden = 0;               ///< processes whose open files this user may not see
};
/// The processes that have one of these nodes open. Searches the open files of all processes: takes some milliseconds.
NodeHolders who_holds(const std::vector<std::string>& nodes, const std::string& proc = "/proc");

/// "steam (process 4211) has /dev/hidraw3 open"; empty if no holder is seen.
std::string in_words(const NodeHolders& holders);

/// The two lines of udev that give the person at the desk permission to a device, by usbfs and by hidraw.
/// runtime/device/hid_pid/70-wale.rules has them for all devices that are declared.
std::string udev_rule(std::uint16_t vendor, std::uint16_t product);
/// How to install the rule, for a mend.
std::string how_to_permit(std::uint16_t vendor, std::uint16_t product);

}  // namespace wale
