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

/// A model of a device plugged into the kernel's own USB, by its virtual host controller (vhci_hcd): the controller is
/// given one end of a socketpair, and at the other end this speaks USB/IP (Documentation/usb/usbip_protocol.rst, what
/// follows an import). The kernel enumerates it as it does any device, and the model's frames pass once a millisecond.
/// Needs root, and the modules usbip-core and vhci-hcd.
class UsbipPort {
 public:
  /// Plugs it into one of the controller's ports, 0 .. 7. Throws std::runtime_error where that cannot be.
  UsbipPort(std::unique_ptr<UsbModel> model, int port);
  /// Unplugs it.
  ~UsbipPort();
  UsbipPort(const UsbipPort&) = delete;
  UsbipPort& operator=(const UsbipPort&) = delete;

  /// Calls `look` with the model while nobody else uses it.
  template <class Model, class Look>
  auto with(Look look) {
    const std::lock_guard lock(mutex_);
    return look(static_cast<Model&>(*model_));
  }

  std::atomic<long> packets_out{0}, packets_in{0}, unlinked{0};

 private:
  /// A request of the controller's that waits for its answer.
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
