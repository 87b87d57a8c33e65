#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "runtime/device/falcon/falcon_session.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "runtime/device/usb/usb_transfers.hpp"
#include "runtime/keeper/keeper.hpp"
#include "wale/result.hpp"

struct libusb_device_handle;
struct libusb_transfer;

namespace wale {

/// A session with a Novint Falcon over libusb. It runs on the context's event thread, as fast as the device answers.
/// Commanding and reading never wait for that thread.
class FalconTransport {
 public:
  struct Options {
    falcon::FalconSessionOptions session;
    unsigned timeout = 50;                    ///< ms, of each packet
    unsigned set_up_timeout = 1000;           ///< ms, of each control request
    MicrosecondClock now = microseconds_now;  ///< measures silences and the handle's speed
    /// The keeper that watches; none: nobody does, as for models of devices. A device that can hurt has one.
    std::optional<KeeperOptions> keeper = {};
  };

  /// Claims the device and sets it up as far as homing; takes some seconds if it has no firmware yet. The error says
  /// why the device cannot be used; the device is left without force.
  static Result<std::unique_ptr<FalconTransport>> open(std::shared_ptr<UsbContext> context, const UsbDeviceInfo& info,
                                                       Options options);
  /// Ends all torque, waits for transfers under way, and gives the interface back.
  ~FalconTransport();
  FalconTransport(const FalconTransport&) = delete;
  FalconTransport& operator=(const FalconTransport&) = delete;

  /// Waits at most so many seconds for the encoders to find their zeros, while a person moves the handle. Returns
  /// whether they have.
  bool wait_until_homed(double seconds);

  /// Sets the torques; newer ones replace them. Ignored before it is homed. Tells the keeper that the loop ticks.
  /// Real-time: reads the clock, two atomic stores.
  void command(const falcon::Torques& torques) noexcept;

  struct Seen {
    falcon::Encoders encoders{};
    std::uint8_t buttons = 0;
    bool is_running = false;  ///< homed, so that the encoders give a position
    std::int64_t heard = 0;   ///< microseconds of the options' clock
  };
  /// The newest answer. Real-time: two atomic loads.
  Seen seen() const noexcept;

  /// Whether the device is gone or has failed. Real-time: one atomic load.
  bool was_lost() const noexcept { return lost_.load(std::memory_order_acquire); }

  /// Why it was lost; empty while it is not.
  std::string reason() const;
  bool wants_firmware() const;
  falcon::FalconSessionCounts counts() const;

 private:
  /// A libusb transfer with its buffer, one for each kind.
  struct Slot {
    FalconTransport* owner = nullptr;
    libusb_transfer* usb = nullptr;
    std::array<std::uint8_t, 8 + falcon::most_usb_bytes> buffer{};
    falcon::Transfer wanted;
    bool is_busy = false;
  };

  FalconTransport(std::shared_ptr<UsbContext> context, libusb_device_handle* handle, Options options);
  void wait_until_set_up();
  Result<> get_keeper(const std::optional<KeeperOptions>& options);
  void heed_keeper();
  bool may_go(bool pushes) const noexcept;
  void pump();
  void submit(const falcon::Transfer& transfer);
  void ended(Slot& slot);
  void publish();
  bool is_idle() const;

  std::shared_ptr<UsbContext> context_;
  libusb_device_handle* handle_;
  unsigned timeout_, set_up_timeout_;
  MicrosecondClock now_;

  std::unique_ptr<Keeper> keeper_;  // set before anything is commanded; null: nobody watches

  mutable std::mutex mutex_;  // guards all below that is not atomic; the real-time thread never takes it
  std::condition_variable changed_;
  falcon::FalconSession session_;
  std::array<Slot, 3> slots_;
  bool closes_ = false;
  std::uint16_t taken_ = 0;  // the number of the command that the session has

  std::atomic<std::uint64_t> wanted_{0};  // three torques and the command's number, 16 bits each
  std::atomic<std::uint64_t> seen_{0};    // three encoders of 16 bits, four buttons, whether it runs
  std::atomic<std::int64_t> heard_{0};
  std::atomic<bool> lost_{false};
};

}  // namespace wale
