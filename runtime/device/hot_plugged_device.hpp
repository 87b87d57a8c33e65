#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/device/plugged_device.hpp"
#include "wale/device_wiring.hpp"

namespace wale {

/// The losses and returns of a device while it was used.
struct HotPlugReport {
  long losses = 0;      ///< how often it was unplugged or stopped answering
  long returns = 0;     ///< how often it was set up again
  std::string reason;   ///< why it was lost the last time; empty: never
  std::string refusal;  ///< why the last attempt to set it up again failed; empty: it did not
  std::string manner;   ///< how it is driven, or was driven last
  std::vector<std::pair<std::string, long>> tally;  ///< sums over the whole time, before and after losses
};

/// A hardware device as the stage uses it: its axes turned and its forces corrected by its wiring, and set up again when it comes back after a
/// loss. In between it reads `Contact::lost` at its last place, and exerts no force. A device that came back is not
/// used until the velocity filter holds only its new positions; then the guards let the force slew in.
///
/// A thread of its own closes a lost device and opens it again. The real-time thread hands over and takes devices by
/// exchanging a pointer.
class HotPluggedDevice final : public Device {
 public:
  /// Opens the device again, when it is plugged in again. Called on the device's own thread; may block.
  using Reopen = std::function<OpenedDevice()>;

  HotPluggedDevice(std::unique_ptr<PluggedDevice> device, DeviceWiring wiring, Reopen reopen,
                   std::chrono::milliseconds patience = std::chrono::milliseconds(250));
  /// Closes the device, without force. If an attempt to open it is under way, waits for its end.
  ~HotPluggedDevice() override;
  HotPluggedDevice(const HotPluggedDevice&) = delete;
  HotPluggedDevice& operator=(const HotPluggedDevice&) = delete;

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override;
  Reading sample() noexcept override;
  Force command(Force force) noexcept override;

  /// Call it only while no other thread uses the device, as after a run.
  HotPlugReport report() const;

 private:
  void attend() noexcept;
  OpenedDevice opened_again() const noexcept;
  /// Waits for the next look; false: the device is being destroyed.
  bool rest();
  static void add(std::vector<std::pair<std::string, long>>& sum,
                  const std::vector<std::pair<std::string, long>>& more);

  const DeviceProfile profile_;
  const DeviceWiring wiring_;
  const std::array<AxisResponse, 2> responses_;  // of the handle's axes
  const Reopen reopen_;
  const std::chrono::milliseconds patience_;

  // Used by the real-time thread only.
  PluggedDevice* held_;
  Reading last_;
  long settling_ = 0;  // ticks until a new device is used

  std::atomic<PluggedDevice*> offered_{nullptr};  // handed to the real-time thread
  std::atomic<PluggedDevice*> retired_{nullptr};  // handed back by it
  std::atomic<long> losses_{0}, returns_{0};

  mutable std::mutex mutex_;  // guards all below; the real-time thread never takes it
  std::condition_variable news_;
  bool ends_ = false;
  HotPlugReport report_;
  std::thread attendant_;
};

}  // namespace wale
