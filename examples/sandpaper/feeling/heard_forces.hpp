#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <optional>
#include <wale/device.hpp>

namespace sandpaper {

/// The forces of the last ticks, from the loop's thread to the one that makes sound of them. Nobody waits: the loop
/// writes over what was not taken in time.
class HeardForces {
 public:
  static constexpr std::uint32_t kept = 1024;  ///< ticks

  /// In the loop's thread. Real-time: allocates nothing, locks nothing.
  void put(wale::Force force) noexcept {
    const std::uint32_t at = put_.load(std::memory_order_relaxed);
    forces_[at % kept].store(std::uint64_t{std::bit_cast<std::uint32_t>(force.x)} << 32 |
                                 std::bit_cast<std::uint32_t>(force.y),
                             std::memory_order_relaxed);
    put_.store(at + 1, std::memory_order_release);
  }

  /// In the sound's thread, as the rest. How many ticks wait; at most the newest `kept` / 2, so that none is written
  /// over while it is read.
  std::uint32_t waiting() noexcept {
    const std::uint32_t newest = put_.load(std::memory_order_acquire);
    if (newest - taken_ > kept / 2) taken_ = newest - kept / 2;
    return newest - taken_;
  }
  /// Leaves out all but the newest.
  void skip_to(std::uint32_t newest) noexcept { taken_ += waiting() > newest ? waiting() - newest : 0; }
  std::optional<wale::Force> take() noexcept {
    if (waiting() == 0) return std::nullopt;
    const std::uint64_t both = forces_[taken_++ % kept].load(std::memory_order_relaxed);
    return wale::Force(std::bit_cast<float>(static_cast<std::uint32_t>(both >> 32)),
                       std::bit_cast<float>(static_cast<std::uint32_t>(both)));
  }

 private:
  std::array<std::atomic<std::uint64_t>, kept> forces_{};  // both components as floats
  std::atomic<std::uint32_t> put_{0};
  std::uint32_t taken_ = 0;
};

/// A device whose forces are also heard. All else is the device's own, which must outlive it.
class HeardDevice final : public wale::Device {
 public:
  HeardDevice(wale::Device& device, HeardForces& forces) : device_(device), forces_(forces) {}

  const wale::DeviceProfile& profile() const noexcept override { return device_.profile(); }
  void elapse(long periods) noexcept override {
    // Of periods that the loop left out, the last force was held.
    for (long i = 1; i < periods && i < static_cast<long>(HeardForces::kept); ++i) forces_.put(last_);
    device_.elapse(periods);
  }
  wale::Reading sample() noexcept override { return device_.sample(); }
  wale::Force command(wale::Force force) noexcept override {
    forces_.put(last_ = force);
    return device_.command(force);
  }

 private:
  wale::Device& device_;
  HeardForces& forces_;
  wale::Force last_{0};
};

}  // namespace sandpaper
