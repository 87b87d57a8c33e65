#include "runtime/device/list_usb_devices.hpp"

#include <libusb.h>

#include <algorithm>
#include <string>
#include <utility>

#include "runtime/device/usb/kernel_nodes.hpp"

namespace wale {
namespace {

/// "steam (4711) by /dev/input/event5", for each holder.
std::vector<std::string> in_words_each(const NodeHolders& holders) {
  std::vector<std::string> words;
  for (const NodeHolder& holder : holders.seen) {
    words.push_back(holder.program + " (" + std::to_string(holder.process) + ") by " + holder.node);
  }
  return words;
}

PluggedIn listed_device(const UsbContext& context, const Driver& driver, const UsbDeviceInfo& info,
                        const DescribeUsbDevice& describe) {
  const KernelNodes nodes = kernel_nodes(info);
  const NodeHolders holders = who_holds(nodes.all());
  PluggedIn listed{.driver = &driver,
                   .numbers = in_words(info.vendor, info.product),
                   .port = info.port,
                   .name = nodes.product,
                   .held_by = in_words_each(holders),
                   .processes_hidden = holders.hidden,
                   .usb = info};
  libusb_device* device = context.find(info);
  libusb_device_handle* handle = nullptr;
  const int error = device != nullptr ? libusb_open(device, &handle) : LIBUSB_ERROR_NO_DEVICE;
  if (device != nullptr) libusb_unref_device(device);
  if (error != 0) listed.obstacle = why_not_usable(error, info);
  describe(listed, nodes, handle);
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
