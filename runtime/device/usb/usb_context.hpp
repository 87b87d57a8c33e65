#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "wale/result.hpp"

struct libusb_context;
struct libusb_device;

namespace wale {

/// An interface of USB's HID class.
struct UsbHidInterface {
  std::uint8_t number = 0;
  std::uint16_t report_descriptor_bytes = 0;
  std::uint8_t in_endpoint = 0;  ///< address of its interrupt IN endpoint; 0: it has none
  std::uint8_t out_endpoint = 0;
  std::uint16_t in_bytes = 0;  ///< of a packet
  int interval = 0;            ///< bInterval of the IN endpoint: ms at full speed
  int out_interval = 0;        ///< of the OUT endpoint; 0: it has none

  friend bool operator==(const UsbHidInterface&, const UsbHidInterface&) = default;
};

/// A device that is plugged in, by its descriptors.
struct UsbDeviceInfo {
  std::uint16_t vendor = 0, product = 0;
  std::uint8_t bus = 0, address = 0;
  std::string port;  ///< as Linux names it: "1-2.3"; the same when the device is plugged in there again
  std::vector<UsbHidInterface> hid;

  friend bool operator==(const UsbDeviceInfo&, const UsbDeviceInfo&) = default;
};

/// "1209:ffb0"
std::string in_words(std::uint16_t vendor, std::uint16_t product);

/// The error for a device that cannot be used, by libusb's error number. If permission is missing, the mend has the
/// udev rule that gives it.
Error why_not_usable(int error, const UsbDeviceInfo& info);

struct UsbEvent {
  bool arrived = false;  ///< otherwise it left
  std::uint16_t vendor = 0, product = 0;
  std::uint8_t bus = 0, address = 0;
};

/// libusb, and the thread that handles its events. Devices share it and keep it alive. The last reference must not be
/// released on its event thread.
class UsbContext {
 public:
  static Result<std::shared_ptr<UsbContext>> open();
  ~UsbContext();
  UsbContext(const UsbContext&) = delete;
  UsbContext& operator=(const UsbContext&) = delete;

  /// The devices that are plugged in now.
  std::vector<UsbDeviceInfo> devices() const;

  /// Calls `changed` on the event thread whenever a device arrives or leaves; it must return soon, open no device and
  /// not call `watch`. One function at a time; an empty one ends the watch. False: this system does not report changes.
  bool watch(std::function<void(const UsbEvent&)> changed);

  /// Gives the event thread this SCHED_FIFO priority, which should be just below the loop's. False: not permitted.
  bool set_priority(int priority);

  /// The device of a usbfs node that another party has opened.
  Result<UsbDeviceInfo> describe(int descriptor) const;

  libusb_context* handle() const { return context_; }
  /// The device that `info` describes, with a reference that the caller releases (`libusb_unref_device`); null when it
  /// is gone.
  libusb_device* find(const UsbDeviceInfo& info) const;

 private:
  explicit UsbContext(libusb_context* context);
  void tell(const UsbEvent& event);

  libusb_context* context_;
  std::atomic<bool> ends_{false};
  std::mutex watch_mutex_;
  std::function<void(const UsbEvent&)> changed_;
  int watch_ = -1;  // libusb's number of the watch
  std::thread events_;
};

}  // namespace wale
