#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/device/usb/kernel_nodes.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "schema/device_wiring.hpp"

namespace wale {

/// A device that is plugged in and may be able to push.
struct ListedUsbDevice {
  UsbDeviceInfo usb;
  std::string name;      ///< as it calls itself; empty where that cannot be read
  std::string can;       ///< what it can do, in a line: "two axes by direction, 32767 steps of force to each side"
  std::optional<Error> obstacle;  ///< why it cannot be used; nothing: nothing is known to be in the way
  NodeHolders holders;            ///< which other programs have it open
  std::string transport;          ///< by which it would be used: "hidraw"; empty where there is no choice
  std::string why;                ///< and why not by one that is tried before; may be empty
};

/// All devices of the HID class that are plugged in, in the order of their ports; with `only`, those with these
/// numbers. Asks no device for anything but its descriptors, and takes none from the kernel's driver or from another
/// program.
std::vector<ListedUsbDevice> list_usb_devices(const UsbContext& context,
                                              const std::optional<UsbNumbers>& only = std::nullopt);
/// All Novint Falcons that are plugged in, in the order of their ports. Whether one has its firmware only a
/// conversation with it would tell, so a missing file is in the way.
std::vector<ListedUsbDevice> list_falcons(const UsbContext& context);

}  // namespace wale
