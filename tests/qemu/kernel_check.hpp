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

/// Waits until `holds`, for at most a minute. Emulation is slow, and a real fault does not pass.
template <class Condition>
void await(Condition holds, const std::string& what) {
  for (int i = 0; i < 60'000; ++i) {
    if (holds()) return demand(true, what);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  demand(false, what);
}

/// Ticks at 900 Hz if the machine is fast enough. Late ticks are not caught up.
template <class Serve>
void tick(long ticks, Serve serve) {
  auto next = std::chrono::steady_clock::now();
  for (long i = 0; i < ticks; ++i) {
    serve(i);
    next = std::max(next + std::chrono::microseconds(1111), std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
}

/// The devices that are plugged in, by a new enumeration, because this system does not report changes.
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

// An emulated processor on a busy computer is slow.
constexpr unsigned patience = 5000;  // ms
HidPidDevice::Options patient(PidTransportKind transport);

std::unique_ptr<UsbipPort> plugged(const PidFamily& family);
glm::dvec2 force_of(UsbipPort& port);

/// The kernel's input device with a constant force, which exists if its driver accepts the descriptor. Empty if there
/// is none.
std::string pushing_input();

/// Another process of this program, with these arguments. The destructor kills it.
class OtherProcess {
 public:
  explicit OtherProcess(std::vector<std::string> words);
  ~OtherProcess() { kill(); }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;

  pid_t process() const { return process_; }
  void kill();
  /// Waits until the process ends by itself. Returns whether it ended without a failure.
  bool ends_well();

 private:
  pid_t process_ = 0;
};

/// The endless work of such processes: a game that plays half of full force along x through the kernel's driver, and a
/// `wale` that pushes with 3 of 10 N along x.
[[noreturn]] void play_as_game();
[[noreturn]] void push_as_wale(PidTransportKind transport, std::uint16_t vendor, std::uint16_t product);
/// A user who may open only the event node, and lets the driver choose the transport.
[[noreturn]] void push_as_nobody(std::uint16_t vendor, std::uint16_t product);

/// Tests a joystick on one transport from start to end, with other programs that use it meanwhile.
void check_life(const PidFamily& family, PidTransportKind transport);
/// Prints the number of reports per second that reach the device, the age of their forces, and their cost.
void measure_rates(const PidFamily& family);
void check_falcon();

/// Every way to die while 3 N are commanded, by "hidraw", "libusb", "evdev" or "falcon": prints how long the force
/// lasts, and demands 250 of the device's milliseconds but for what remains. The second is the process that dies.
void check_dying(const std::string& by);
[[noreturn]] void push_until_dead(const std::string& by, std::uint16_t vendor, std::uint16_t product);

}  // namespace wale::test
