#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "runtime/device/falcon/falcon_device.hpp"
#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "tests/usb_mock/usb_mock.hpp"
#include "wale/device.hpp"

namespace wale::test {

/// Waits until `holds`, while frames pass by themselves. It looks once per millisecond or slower, and throws
/// std::runtime_error after a fixed number of looks.
template <class Condition>
void await(Condition holds, int line = __builtin_LINE()) {
  constexpr int most_looks = 60'000;
  for (int look = 0; look < most_looks; ++look) {
    if (holds()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  throw std::runtime_error("awaited in vain in line " + std::to_string(line));
}

/// Runs ticks in step with the mock's frames, like a loop of the same rate that is never late.
template <class Serve>
void run_ticks(UsbMock& mock, long ticks, Serve serve) {
  const UsbMock::InStep in_step(mock);
  for (long tick = 0; tick < ticks; ++tick) {
    serve(tick);
    mock.pass_frame();
  }
}

/// As `run_ticks`, until `holds`. Throws std::runtime_error after a minute of the mock's time.
template <class Condition>
void run_until(UsbMock& mock, Condition holds, int line = __builtin_LINE()) {
  const UsbMock::InStep in_step(mock);
  constexpr int most_ticks = 60'000;
  for (int tick = 0; tick < most_ticks; ++tick) {
    if (holds()) return;
    mock.pass_frame();
  }
  throw std::runtime_error("ticked in vain in line " + std::to_string(line));
}

/// A device whose ticks are the mock's frames, for a loop that the test does not run itself.
class InStepDevice final : public Device {
 public:
  /// Both arguments must outlive the object.
  InStepDevice(UsbMock& mock, Device& device) : mock_(mock), device_(device), in_step_(mock) {}

  const DeviceProfile& profile() const noexcept override { return device_.profile(); }
  void elapse(long periods) noexcept override { device_.elapse(periods); }
  Reading sample() noexcept override { return device_.sample(); }
  Force command(Force force) noexcept override {
    const Force exerted = device_.command(force);
    mock_.pass_frame();
    return exerted;
  }

 private:
  UsbMock& mock_;
  Device& device_;
  UsbMock::InStep in_step_;
};

/// The time limit of transfers of drivers in this process. These drivers use the mock's time.
constexpr unsigned unhurried = 30'000;  // ms
inline HidPidDevice::Options in_mock_time() {
  HidPidDevice::Options options;
  options.timeout = options.set_up_timeout = unhurried;
  options.now = mock_microseconds;
  return options;
}
inline FalconOptions falcon_in_mock_time() {
  FalconOptions options;
  options.transport.timeout = options.transport.set_up_timeout = unhurried;
  options.transport.now = mock_microseconds;
  return options;
}

/// A mock of USB, and unmodified libusb on top of it.
class MockedUsb : public testing::Test {
 protected:
  MockedUsb() {
    auto opened = UsbContext::open();
    context_ = *opened;
  }

  std::shared_ptr<UsbContext> context() const { return context_; }

  /// The device at a port. Waits until libusb sees it.
  UsbDeviceInfo found(int port) const {
    UsbDeviceInfo found;
    await([&] {
      for (const UsbDeviceInfo& info : context_->devices()) {
        if (info.port != "1-" + std::to_string(port)) continue;
        found = info;
        return true;
      }
      return false;
    });
    return found;
  }

  UsbMock mock_;

 private:
  std::shared_ptr<UsbContext> context_;
};

}  // namespace wale::test
