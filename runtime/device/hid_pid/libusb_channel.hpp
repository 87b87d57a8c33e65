#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "runtime/device/hid_pid/pid_transport.hpp"
#include "runtime/device/hid_pid/report_channel.hpp"
#include "runtime/device/usb/owned_descriptor.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "wale/result.hpp"

struct libusb_device_handle;
struct libusb_transfer;

namespace wale {

/// An interface of a device that is claimed for this process alone, through libusb. Claiming it detaches the kernel's
/// driver, and destroying this object attaches it again. Only a killed process leaves the stick without a driver, until
/// it is plugged in again or used through libusb again. Transfers end on the context's event thread.
class LibusbInterface {
 public:
  static Result<LibusbInterface> claim(std::shared_ptr<UsbContext> context, const UsbDeviceInfo& info,
                                       const UsbHidInterface& interface);
  /// From a usbfs node that another party opened, and still owns.
  static Result<LibusbInterface> claim(std::shared_ptr<UsbContext> context, int descriptor, const UsbDeviceInfo& info,
                                       const UsbHidInterface& interface);
  LibusbInterface(LibusbInterface&&) noexcept;
  LibusbInterface& operator=(LibusbInterface&&) = delete;
  ~LibusbInterface();

  libusb_device_handle* handle() const noexcept { return handle_; }
  const UsbHidInterface& description() const noexcept { return interface_; }
  /// Of its usbfs node; -1 where libusb opened that and keeps it to itself.
  int descriptor() const noexcept { return descriptor_.get(); }

 private:
  LibusbInterface(std::shared_ptr<UsbContext> context, OwnedDescriptor descriptor, libusb_device_handle* handle,
                  const UsbHidInterface& interface);
  static Result<LibusbInterface> claim(std::shared_ptr<UsbContext> context, OwnedDescriptor descriptor,
                                       libusb_device_handle* handle, const UsbDeviceInfo& info,
                                       const UsbHidInterface& interface);

  std::shared_ptr<UsbContext> context_;
  OwnedDescriptor descriptor_;  // of the handle, if libusb did not open it
  libusb_device_handle* handle_;
  UsbHidInterface interface_;
};

class LibusbChannel final : public ReportChannel {
 public:
  LibusbChannel(LibusbInterface interface, const PidTransportOptions& options, Listener& listener);
  ~LibusbChannel() override;

  Outcome submit(const hid::Transfer& transfer, bool is_setting_up) noexcept override;
  Outcome listen() noexcept override;
  void close() override;
  int most_under_way() const noexcept override { return most_outputs_; }
  hid::HidInterface interface() const noexcept override;
  LetGoPlan let_go_plan(const hid::PidSession::Leaving& leaving) const override;
  int descriptor() const noexcept override { return interface_.descriptor(); }

 private:
  /// A libusb transfer of our own with its buffer; there is a fixed number of them.
  struct Slot {
    LibusbChannel* owner = nullptr;
    libusb_transfer* usb = nullptr;
    std::vector<std::uint8_t> buffer;
    hid::Transfer wanted;
    bool is_input = false, is_busy = false;
  };

  void add_slot(bool is_input, std::size_t bytes);
  Outcome submit_input(Slot& slot);
  void input_ended(Slot& slot);
  void transfer_ended(Slot& slot);
  void release(Slot& slot);
  bool is_idle() const;

  LibusbInterface interface_;
  Listener& listener_;
  const unsigned timeout_, set_up_timeout_;
  const int most_outputs_;

  std::mutex mutex_;  // of which slots are busy
  std::condition_variable released_;
  std::vector<std::unique_ptr<Slot>> slots_;
  bool closes_ = false;
};

}  // namespace wale
