#include "runtime/device/usb/usb_context.hpp"

#include <libusb.h>
#include <pthread.h>
#include <sched.h>
#include <sys/time.h>

#include <cstdio>

#include "runtime/device/usb/kernel_nodes.hpp"

namespace wale {
namespace {

constexpr std::uint8_t hid_descriptor = 0x21, report_descriptor = 0x22;

/// The length of the report descriptor, from the HID descriptor (HID 1.11 section 6.2.1) in the `extra` bytes, which
/// libusb does not interpret. 0: there is none.
std::uint16_t report_descriptor_length(const unsigned char* extra, int length) {
  for (int i = 0; i + 1 < length && extra[i] >= 2; i += extra[i]) {
    const int bytes = extra[i];
    if (extra[i + 1] != hid_descriptor || i + bytes > length) continue;
    for (int at = i + 6; at + 2 < i + bytes; at += 3) {
      if (extra[at] == report_descriptor) return static_cast<std::uint16_t>(extra[at + 1] | extra[at + 2] << 8);
    }
  }
  return 0;
}

UsbHidInterface hid_interface(const libusb_interface_descriptor& descriptor) {
  UsbHidInterface hid;
  hid.number = descriptor.bInterfaceNumber;
  hid.report_descriptor_bytes = report_descriptor_length(descriptor.extra, descriptor.extra_length);
  for (int i = 0; i < descriptor.bNumEndpoints; ++i) {
    const libusb_endpoint_descriptor& endpoint = descriptor.endpoint[i];
    if ((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_INTERRUPT) continue;
    if ((endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) == 0) {
      hid.out_endpoint = endpoint.bEndpointAddress;
      hid.out_interval = endpoint.bInterval;
    } else if (hid.in_endpoint == 0) {
      hid.in_endpoint = endpoint.bEndpointAddress;
      hid.in_bytes = endpoint.wMaxPacketSize & 0x7ff;
      hid.interval = endpoint.bInterval;
    }
  }
  return hid;
}

UsbDeviceInfo usb_device_info(libusb_device* device) {
  UsbDeviceInfo info;
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  info.vendor = descriptor.idVendor;
  info.product = descriptor.idProduct;
  info.bus = libusb_get_bus_number(device);
  info.address = libusb_get_device_address(device);
  info.port = std::to_string(info.bus);
  std::uint8_t ports[8];
  const int depth = libusb_get_port_numbers(device, ports, sizeof ports);
  for (int i = 0; i < depth; ++i) info.port += (i == 0 ? "-" : ".") + std::to_string(ports[i]);

  libusb_config_descriptor* configuration = nullptr;
  if (libusb_get_active_config_descriptor(device, &configuration) != 0 &&
      libusb_get_config_descriptor(device, 0, &configuration) != 0) {
    return info;
  }
  for (int i = 0; i < configuration->bNumInterfaces; ++i) {
    const libusb_interface& interface = configuration->interface[i];
    if (interface.num_altsetting == 0) continue;
    if (interface.altsetting[0].bInterfaceClass != LIBUSB_CLASS_HID) continue;
    info.hid.push_back(hid_interface(interface.altsetting[0]));
  }
  libusb_free_config_descriptor(configuration);
  return info;
}

}  // namespace

std::string in_words(std::uint16_t vendor, std::uint16_t product) {
  char text[16];
  std::snprintf(text, sizeof text, "%04x:%04x", vendor, product);
  return text;
}

Error why_not_usable(int error, const UsbDeviceInfo& info) {
  const Place place{.name = "port " + info.port};
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      return {Code::no_permission, "no permission to open it", how_to_permit(info.vendor, info.product), place};
    case LIBUSB_ERROR_NO_DEVICE: return {Code::absent_device, "it was unplugged", {}, place};
    case LIBUSB_ERROR_BUSY: return {Code::unusable_device, "another program has claimed it", {}, place};
    default: return {Code::unusable_device, std::string("it cannot be opened: ") + libusb_strerror(error), {}, place};
  }
}

Result<std::shared_ptr<UsbContext>> UsbContext::open() {
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context); error != 0) {
    return Error{Code::unusable_device, "USB cannot be used: " + std::string(libusb_strerror(error)),
                 "see that /dev/bus/usb is there; a container or a virtual machine must be given it"};
  }
  return std::shared_ptr<UsbContext>(new UsbContext(context));
}

Result<UsbDeviceInfo> UsbContext::describe(int descriptor) const {
  libusb_device_handle* handle = nullptr;
  if (const int error = libusb_wrap_sys_device(context_, descriptor, &handle); error != 0) {
    return Error{Code::unusable_device,
                 std::string("the device cannot be used: ") + libusb_strerror(error),
                 {},
                 {.name = "descriptor " + std::to_string(descriptor)}};
  }
  UsbDeviceInfo info = usb_device_info(libusb_get_device(handle));
  libusb_close(handle);
  return info;
}

UsbContext::UsbContext(libusb_context* context) : context_(context) {
  events_ = std::thread([this] {
    while (!ends_.load(std::memory_order_acquire)) {
      timeval most{0, 100'000};
      libusb_handle_events_timeout_completed(context_, &most, nullptr);
    }
  });
}

UsbContext::~UsbContext() {
  watch({});
  ends_.store(true, std::memory_order_release);
  libusb_interrupt_event_handler(context_);
  events_.join();
  libusb_exit(context_);
}

std::vector<UsbDeviceInfo> UsbContext::devices() const {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(context_, &list);
  std::vector<UsbDeviceInfo> devices;
  for (std::ptrdiff_t i = 0; i < count; ++i) devices.push_back(usb_device_info(list[i]));
  if (count >= 0) libusb_free_device_list(list, 1);
  return devices;
}

libusb_device* UsbContext::find(const UsbDeviceInfo& info) const {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(context_, &list);
  libusb_device* found = nullptr;
  for (std::ptrdiff_t i = 0; i < count && found == nullptr; ++i) {
    libusb_device_descriptor descriptor{};
    libusb_get_device_descriptor(list[i], &descriptor);
    const bool is_it = libusb_get_bus_number(list[i]) == info.bus && libusb_get_device_address(list[i]) == info.address;
    if (is_it && descriptor.idVendor == info.vendor && descriptor.idProduct == info.product) {
      found = libusb_ref_device(list[i]);
    }
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  return found;
}

void UsbContext::tell(const UsbEvent& event) {
  const std::lock_guard lock(watch_mutex_);
  if (changed_) changed_(event);
}

bool UsbContext::watch(std::function<void(const UsbEvent&)> changed) {
  if (watch_ >= 0) {
    libusb_hotplug_deregister_callback(context_, watch_);
    watch_ = -1;
  }
  {
    const std::lock_guard lock(watch_mutex_);
    changed_ = std::move(changed);
    if (!changed_) return true;
  }
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) return false;
  const auto told = [](libusb_context*, libusb_device* device, libusb_hotplug_event event, void* user) {
    libusb_device_descriptor descriptor{};
    libusb_get_device_descriptor(device, &descriptor);
    static_cast<UsbContext*>(user)->tell({event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED, descriptor.idVendor,
                                          descriptor.idProduct, libusb_get_bus_number(device),
                                          libusb_get_device_address(device)});
    return 0;
  };
  const int error = libusb_hotplug_register_callback(
      context_, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT, 0, LIBUSB_HOTPLUG_MATCH_ANY,
      LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, told, this, &watch_);
  return error == 0;
}

bool UsbContext::set_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(events_.native_handle(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace wale
