#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "runtime/device/hid_pid/pid_session.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "runtime/device/usb/usb_transfers.hpp"

struct libusb_device_handle;
struct libusb_transfer;

namespace wale {

/// A session with a force-feedback joystick over libusb. The transfers end on the context's event thread; a thread of
/// its own submits forces as soon as they are commanded; commanding and reading touch neither.
class PidTransport {
 public:
  struct Options {
    hid::PidSessionOptions session;
    unsigned timeout = 100;          ///< ms, of each transfer while running and leaving
    unsigned set_up_timeout = 1000;  ///< ms, of each of setting up: a reset may take its time
    /// SCHED_FIFO, of the thread that submits forces: best just below that of the loop, where permitted; 0: ordinary.
    int priority = 0;
    MicrosecondClock now = microseconds_now;  ///< by which refreshes and silences are due
  };

  /// Claims the interface, detaching the kernel's driver, which gets it back in the end, and sets the device up: a few
  /// tens of milliseconds. A refusal says why the device cannot be used, and has left it as it was.
  static std::variant<std::unique_ptr<PidTransport>, Refusal> open(std::shared_ptr<UsbContext> context,
                                                                   const UsbDeviceInfo& info,
                                                                   const UsbHidInterface& interface,
                                                                   const Options& options);
  /// Stops the device, waits for what is on its way, gives the interface back.
  ~PidTransport();
  PidTransport(const PidTransport&) = delete;
  PidTransport& operator=(const PidTransport&) = delete;

  /// The force to exert from now on, as `hid::PidSession::command` takes it; a newer one replaces it.
  /// Real-time: allocates nothing, takes no lock, does not throw; wakes the thread that submits.
  void command(glm::vec2 force) noexcept;

  struct Seen {
    std::int32_t x = 0, y = 0;  ///< as the device says them, held within 28 bits
    bool button = false;
  };
  /// The newest input report. Real-time: one atomic load.
  Seen seen() const noexcept;

  /// The device is gone or has failed; nothing is felt any more. Real-time: one atomic load.
  bool was_lost() const noexcept { return lost_.load(std::memory_order_acquire); }

  /// Why it was lost; empty otherwise.
  std::string reason() const;
  const hid::PidLayout& layout() const { return *session_.layout(); }  ///< does not change
  hid::Arrangement arrangement() const { return session_.arrangement(); }
  hid::PidSessionCounts counts() const;
  std::optional<hid::Telemetry> telemetry() const;

 private:
  /// A libusb transfer of our own with its buffer; there is a fixed number of them.
  struct Slot {
    PidTransport* owner = nullptr;
    libusb_transfer* usb = nullptr;
    std::vector<std::uint8_t> buffer;
    hid::Transfer wanted;
    bool is_input = false, is_busy = false;
  };

  PidTransport(std::shared_ptr<UsbContext> context, libusb_device_handle* handle, const UsbHidInterface& interface,
               const Options& options);
  bool wait_until_running();
  void write_forces();
  void pump();
  void submit(const hid::Transfer& transfer);
  void submit_input(Slot& slot);
  void listen();
  void ended(Slot& slot);
  void publish();
  bool is_idle() const;

  std::shared_ptr<UsbContext> context_;
  libusb_device_handle* handle_;
  UsbHidInterface interface_;
  unsigned timeout_, set_up_timeout_;
  MicrosecondClock now_;

  mutable std::mutex mutex_;  // of all below that is not atomic; never taken by the real-time thread
  std::condition_variable changed_;
  hid::PidSession session_;
  std::vector<std::unique_ptr<Slot>> slots_;
  bool listens_ = false, closes_ = false;

  std::atomic<std::uint64_t> wanted_{0};  // two floats
  std::atomic<std::uint64_t> seen_{0};    // two numbers of 28 bits and the button
  std::atomic<bool> lost_{false}, ends_{false};
  sem_t commanded_;
  std::thread writer_;
};

}  // namespace wale
