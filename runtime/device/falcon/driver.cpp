#include "runtime/device/driver.hpp"

#include <string>
#include <utility>

#include "runtime/device/falcon/falcon_device.hpp"
#include "runtime/device/falcon/falcon_firmware.hpp"
#include "runtime/device/list_usb_devices.hpp"

namespace wale {

extern const Driver falcon_driver;

namespace {

/// Whether the device has its firmware is not known without opening it, so a missing file counts as an obstacle.
void describe_falcon(PluggedIn& listed, const KernelNodes&, libusb_device_handle*) {
  listed.can = "three motors, used as two axes in a plane, " + std::to_string(falcon::most_torque) +
               " steps of torque to each side";
  const auto firmware = read_falcon_firmware(falcon_firmware_path());
  if (!firmware && !listed.obstacle) listed.obstacle = firmware.error();
}

bool drives_falcon(const UsbNumbers& numbers) {
  UsbDeviceInfo info;
  info.vendor = numbers.vendor, info.product = numbers.product;
  return is_falcon(info);
}

std::vector<PluggedIn> find_falcon(const Connections& connections, const PluggedIn*) {
  return list_usb_devices(connections, falcon_driver, is_falcon, describe_falcon);
}

OpenedDevice open_falcon(const Connections& connections, const PluggedIn& plugged, const TrustedDevice& trusted,
                         const DeviceOptions& options) {
  if (!connections.usb) return connections.usb.error();
  FalconOptions wanted;
  wanted.transport.keeper = options.keeper;
  wanted.ask = options.ask;
  wanted.most_newton = options.most_newton;
  wanted.stop = options.stop;
  auto opened = FalconDevice::open(*connections.usb, plugged.usb, trusted, wanted);
  if (!opened) return std::move(opened.error());
  return *std::move(opened);
}

}  // namespace

constinit const Driver falcon_driver{.name = "novint-falcon",
                                     .is_chosen_by_auto = true,
                                     .is_felt = true,
                                     .find = find_falcon,
                                     .open = open_falcon,
                                     .drives = drives_falcon,
                                     .left_alone = "keeps pushing until it is opened again or loses its power"};

}  // namespace wale
