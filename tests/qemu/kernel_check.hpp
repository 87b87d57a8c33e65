#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "tests/qemu/usbip_port.hpp"
#include "tests/usb/pid_model.hpp"

namespace wale::test {

/// Prints "ok: what", or "FAILED: what" and ends the process.
void demand(bool holds, const std::string& what);

/// Waits until it holds, a minute at most: emulation is slow, and a real fault lasts for ever.
template <class Condition>
void await(Condition holds, const std::string& what) {
  for (int i = 0; i < 60'000; ++i) {
    if (holds()) return demand(true, what);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  demand(false, what);
}

/// Ticks at 900 Hz, as well as this machine can; late ones are not caught up.
template <class Serve>
void tick(long ticks, Serve serve) {
  auto next = std::chrono::steady_clock::now();
  for (long i = 0; i < ticks; ++i) {
    serve(i);
    next = std::max(next + std::chrono::microseconds(1111), std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
}

/// What is plugged in, as a new look at it tells: nobody passes the kernel's news on here.
struct Found {
  std::shared_ptr<UsbContext> context;
  UsbDeviceInfo info;
};
Found find(std::uint16_t vendor, std::uint16_t product);

template <class Value>
Value taken(Result<Value> opened) {
  if (!opened) demand(false, in_words(opened.error()));
  return *std::move(opened);
}

// An emulated processor that others keep busy may take its time.
constexpr unsigned patience = 5000;  // ms
HidPidDevice::Options patient(PidTransportKind transport);

std::unique_ptr<UsbipPort> plugged(const PidFamily& family);
glm::dvec2 force_of(UsbipPort& port);

/// The kernel's input device that can push with a constant force, because its driver has taken the descriptor; empty:
/// there is none.
std::string pushing_input();

/// This program once more, as a process of its own with these words. Killed in the end.
class OtherProcess {
 public:
  explicit OtherProcess(std::vector<std::string> words);
  ~OtherProcess() { kill(); }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;

  pid_t process() const { return process_; }
  void kill();
  /// Waits until it ends by itself; whether it did so without a failure.
  bool ends_well();

 private:
  pid_t process_ = 0;
};

/// What such processes do, for ever: a game that plays half of full force along x through the kernel's driver, and a
/// `wale` that pushes with 3 of 10 N along x.
[[noreturn]] void play_as_game();
[[noreturn]] void push_as_wale(PidTransportKind transport, std::uint16_t vendor, std::uint16_t product);
/// A user who may open the event node only, and leaves the choice of transport to the driver.
[[noreturn]] void push_as_nobody(std::uint16_t vendor, std::uint16_t product);

/// The whole life of a joystick on one transport, and what others do to it meanwhile.
void check_life(const PidFamily& family, PidTransportKind transport);
/// Prints how many reports a second reach the device, how old their forces are, and what it costs.
void measure_rates(const PidFamily& family);
void check_falcon();

/// Every way to die while 3 N are commanded, by "hidraw", "libusb", "evdev" or "falcon": prints how long the force
/// lasts, and demands 250 ms but for what remains. The second is the process that dies.
void check_dying(const std::string& by);
[[noreturn]] void push_until_dead(const std::string& by, std::uint16_t vendor, std::uint16_t product);

}  // namespace wale::test
