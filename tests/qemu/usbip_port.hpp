#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/usb/usb_model.hpp"

namespace wale::test {

/// A model of a device that is plugged into the kernel's USB, through its virtual host controller (vhci_hcd). The
/// controller gets one end of a socketpair. At the other end, this class speaks USB/IP as after an import
/// (Documentation/usb/usbip_protocol.rst). The kernel enumerates it like any device. The model's frames pass once per
/// millisecond. The class needs root, and the modules usbip-core and vhci-hcd.
class UsbipPort {
 public:
  /// Plugs the device into one of the controller's ports, 0 .. 7. Throws std::runtime_error if that fails.
  UsbipPort(std::unique_ptr<UsbModel> model, int port);
  /// Unplugs it.
  ~UsbipPort();
  UsbipPort(const UsbipPort&) = delete;
  UsbipPort& operator=(const UsbipPort&) = delete;

  /// Calls `look` with the model, under the lock.
  template <class Model, class Look>
  auto with(Look look) {
    const std::lock_guard lock(mutex_);
    return look(static_cast<Model&>(*model_));
  }

  std::atomic<long> packets_out{0}, packets_in{0}, unlinked{0};
  std::atomic<long> frames{0};  ///< that have passed: the device's own milliseconds

 private:
  /// A request of the controller that waits for its answer.
  struct Request {
    std::uint32_t number = 0, endpoint = 0, length = 0;
    bool is_in = false;
    UsbModel::SetUp setup{};
    UsbModel::Bytes out;
  };

  void read_requests();
  void pass_frames();
  void frame();
  void control(const Request& request);
  std::optional<UsbModel::Bytes> standard(const UsbModel::SetUp& setup) const;
  void answer(const Request& request, int status, const UsbModel::Bytes& in, std::size_t length);

  std::unique_ptr<UsbModel> model_;
  int port_, socket_ = -1;
  std::mutex mutex_;
  std::deque<Request> waiting_;
  std::atomic<bool> ends_{false};
  std::thread reader_, clock_;
};

}  // namespace wale::test
