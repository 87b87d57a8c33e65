#include "runtime/device/usb/list_usb_devices.hpp"

#include <libusb.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

namespace wale {
namespace {

Error why_not_opened(int error, const UsbDeviceInfo& info) {
  return {Code::unusable_device, why_not_usable(error, info).reason};
}

/// As the device calls itself; empty where the system does not tell.
std::string product_name(const UsbDeviceInfo& info) {
  std::ifstream file("/sys/bus/usb/devices/" + info.port + "/product", std::ios::binary);
  std::string name(std::istreambuf_iterator<char>(file), {});
  while (!name.empty() && name.back() == '\n') name.pop_back();
  return name;
}

PluggedIn listed_device(const UsbContext& context, const Driver& driver, const UsbDeviceInfo& info,
                        const DescribeUsbDevice& describe) {
  PluggedIn listed{.driver = &driver,
                   .numbers = in_words(info.vendor, info.product),
                   .port = info.port,
                   .name = product_name(info),
                   .usb = info};
  libusb_device* device = context.find(info);
  if (device == nullptr) {
    listed.obstacle = why_not_opened(LIBUSB_ERROR_NO_DEVICE, info);
    return listed;
  }
  libusb_device_handle* handle = nullptr;
  const int error = libusb_open(device, &handle);
  libusb_unref_device(device);
  describe(listed, error == 0 ? handle : nullptr);
  const bool is_no_force_device = listed.obstacle && listed.can.empty();
  if (error != 0 && !is_no_force_device) listed.obstacle = why_not_opened(error, info);
  if (handle != nullptr) libusb_close(handle);
  return listed;
}

}  // namespace

std::vector<PluggedIn> list_usb_devices(const Connections& connections, const Driver& driver,
                                        const std::function<bool(const UsbDeviceInfo&)>& is_meant,
                                        const DescribeUsbDevice& describe) {
  std::vector<PluggedIn> listed;
  if (!connections.usb) return listed;
  const UsbContext& context = **connections.usb;
  std::vector<UsbDeviceInfo> devices = context.devices();
  std::erase_if(devices, [&](const UsbDeviceInfo& info) { return !is_meant(info); });
  std::ranges::sort(devices, {}, &UsbDeviceInfo::port);
  for (const UsbDeviceInfo& info : devices) listed.push_back(listed_device(context, driver, info, describe));
  return listed;
}

}  // namespace wale
