#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "runtime/device/usb/usb_context.hpp"
#include "tests/usb_mock/usb_mock.hpp"

namespace wale::test {

/// Waits until `holds`.
template <class Condition>
void await(Condition holds) {
  while (!holds()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// Ticks as fast as the mock's frames come, as a loop of their rate would.
template <class Serve>
void run_ticks(UsbMock& mock, long ticks, Serve serve) {
  for (long tick = 0; tick < ticks; ++tick) {
    const long frame = mock.frames();
    serve(tick);
    while (mock.frames() == frame) std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

/// A mock of USB, and unmodified libusb that sees it.
class MockedUsb : public testing::Test {
 protected:
  MockedUsb() {
    auto opened = UsbContext::open();
    context_ = std::get<std::shared_ptr<UsbContext>>(opened);
  }

  std::shared_ptr<UsbContext> context() const { return context_; }

  /// The device at a port, once libusb sees it.
  UsbDeviceInfo found(int port) const {
    while (true) {
      for (const UsbDeviceInfo& info : context_->devices()) {
        if (info.port == "1-" + std::to_string(port)) return info;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  UsbMock mock_;

 private:
  std::shared_ptr<UsbContext> context_;
};

}  // namespace wale::test
