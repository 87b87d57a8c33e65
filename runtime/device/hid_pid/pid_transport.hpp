#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/device/hid_pid/pid_session.hpp"
#include "runtime/device/usb/usb_transfers.hpp"
#include "runtime/keeper/keeper.hpp"

namespace wale {

/// The way by which forces reach a force-feedback joystick and positions are read from it.
enum class PidTransportKind : std::uint8_t {
  hidraw,  ///< /dev/hidrawN: the kernel's driver stays, and games see the stick
  libusb,  ///< usbfs: exclusive; the kernel's driver is detached meanwhile
  evdev    ///< /dev/input/eventN: effects of the kernel's own force-feedback driver
};

/// "hidraw", as `--transport` spells it, and the reverse, which gives nothing for other texts.
std::string_view in_words(PidTransportKind kind) noexcept;
std::optional<PidTransportKind> read_transport_kind(std::string_view text) noexcept;
/// All of them, in the order of the kinds.
inline constexpr std::array<std::string_view, 3> pid_transport_names{"hidraw", "libusb", "evdev"};

/// ioctl(2) on a device's node: below 0 is a failure, with `errno`. Tests replace this call, because the socket that
/// they use in place of a node does not answer it.
using IoctlCall = int (*)(int descriptor, unsigned long request, void* argument);
int system_ioctl(int descriptor, unsigned long request, void* argument);

struct PidTransportOptions {
  hid::PidSessionOptions session;
  double most_newton = HUGE_VAL;   ///< N at the handle, the user's limit; `HidPidDevice` sets the session's limits
  unsigned timeout = 100;          ///< ms, of each libusb transfer while running and leaving
  unsigned set_up_timeout = 1000;  ///< ms, of each libusb transfer while setting up: a reset may take long
  /// SCHED_FIFO priority of the thread that sends forces, if permitted: best just below the loop's. 0: ordinary.
  int priority = 0;
  MicrosecondClock now = microseconds_now;  ///< the clock that times refreshes and silence
  IoctlCall ioctl = system_ioctl;           ///< of hidraw and evdev
  /// The keeper that watches; none: nobody does, as for models of devices. A device that can hurt has one.
  std::optional<KeeperOptions> keeper = {};
};

/// The loop's view of a device that is set up and running: one thread of the transport sends the newest command,
/// another receives the newest position, and nothing queues. Derived classes own those threads; this class holds the
/// values that they exchange with the loop.
class PidTransport {
 public:
  virtual ~PidTransport();
  PidTransport(const PidTransport&) = delete;
  PidTransport& operator=(const PidTransport&) = delete;

  /// The force to exert from now on, of the device's full force along its own axes, each in -1 .. 1 (y to the user). A
  /// newer command replaces it. Tells the keeper that the loop ticks. Real-time: allocates nothing, takes no lock, does
  /// not throw; reads the clock and posts a semaphore.
  void command(glm::vec2 force) noexcept;

  struct Seen {
    std::int32_t x = 0, y = 0;  ///< in the device's own counts, clamped to 28 bits
    bool button = false;
  };
  /// The newest position. Real-time: one atomic load.
  Seen seen() const noexcept;

  /// Whether the device is gone or has failed, or another program has reset it; then it exerts no force. Real-time: one
  /// atomic load.
  bool was_lost() const noexcept { return lost_.load(std::memory_order_acquire); }

  virtual PidTransportKind kind() const noexcept = 0;
  /// Why it was lost; empty otherwise. This and all functions below are not real-time, and for any thread.
  virtual std::string reason() const = 0;
  virtual hid::PidSessionCounts counts() const = 0;
  /// Empty if the device or the transport has no such report.
  virtual std::optional<hid::Telemetry> telemetry() const { return std::nullopt; }
  virtual hid::Arrangement arrangement() const = 0;

  /// The ranges of positions and forces, in counts. They do not change.
  struct Ranges {
    std::int64_t x_minimum = 0, x_maximum = 0, y_minimum = 0, y_maximum = 0;
    std::int64_t full_force = 0;  ///< counts to each side, at least 1

    friend bool operator==(const Ranges&, const Ranges&) = default;
  };
  virtual const Ranges& ranges() const noexcept = 0;

 protected:
  PidTransport();

  /// For the thread that sends: waits for a command, until `most_microseconds` have passed or `stop_waiting` is called.
  /// Returns the newest command since the last call, if any.
  std::optional<glm::vec2> wait_for_command(std::int64_t most_microseconds) noexcept;
  /// Ends waiting now and from now on.
  void stop_waiting() noexcept;
  bool is_ending() const noexcept { return ends_.load(std::memory_order_acquire); }

  /// For the thread that receives. Values beyond 28 bits are clamped. Both real-time.
  void show(std::int64_t x, std::int64_t y, bool button) noexcept;
  void show_lost() noexcept { lost_.store(true, std::memory_order_release); }

  /// Set once, before the loop commands anything; null: nobody watches. Any thread.
  Keeper* keeper() const noexcept { return keeper_.load(std::memory_order_acquire); }
  void set_keeper(std::unique_ptr<Keeper> keeper) noexcept;
  /// For the end of a derived class, when nothing is sent any more.
  void end_keeper() noexcept { delete keeper_.exchange(nullptr); }

 private:
  std::atomic<std::uint64_t> wanted_{0};  // two floats
  std::atomic<std::uint64_t> seen_{0};    // two numbers of 28 bits and the button
  std::atomic<bool> lost_{false}, ends_{false};
  std::atomic<Keeper*> keeper_{nullptr};
  sem_t commanded_;
};

}  // namespace wale
