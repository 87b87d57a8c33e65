#pragma once

#include <functional>
#include <vector>

#include "runtime/device/driver.hpp"
#include "runtime/device/usb/kernel_nodes.hpp"

struct libusb_device_handle;

namespace wale {

/// Sets `can`, `transport` and `obstacle` of a device. `handle` is null if this process must not open the device
/// through libusb; `obstacle` then has the reason.
using DescribeUsbDevice =
    std::function<void(PluggedIn& device, const KernelNodes& nodes, libusb_device_handle* handle)>;

/// The devices on USB that `is_meant` accepts, in the order of their ports, for `driver`. Asks no device for more than
/// its descriptors, and takes none from the kernel's driver or from another program.
std::vector<PluggedIn> list_usb_devices(const Connections& connections, const Driver& driver,
                                        const std::function<bool(const UsbDeviceInfo&)>& is_meant,
                                        const DescribeUsbDevice& describe);

}  // namespace wale
