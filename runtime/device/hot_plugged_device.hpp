#pragma once

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
#include "schema/device_wiring.hpp"

namespace wale {

/// What became of a device while it was used.
struct HotPlugReport {
  long losses = 0;      ///< times that it was lost: unplugged, or not answering as it should
  long returns = 0;     ///< times that it was set up anew
  std::string reason;   ///< why it was lost last; empty: never
  std::string refusal;  ///< why it could not be set up anew, when it was tried last; empty: it could, or never was
  std::string manner;   ///< how it is or was driven last
  std::vector<std::pair<std::string, long>> tally;  ///< of all that it has done, before and after
};

/// A device of hardware as the stage uses it: turned as it lies on the desk, and set up anew when it comes back after
/// it was lost. In between it reads `Contact::lost` at its last place, and no force is exerted. A new one is not used
/// until the velocity filter has seen nothing but its positions; then the guards let the force slew in.
///
/// Letting a lost device go and opening another is the business of a thread of its own: the real-time thread gives one
/// away and takes another by exchanging a pointer.
class HotPluggedDevice final : public Device {
 public:
  /// Opens the device once more where it is there again. Called on a thread of its own; may take its time.
  using Reopen = std::function<OpenedDevice()>;

  HotPluggedDevice(std::unique_ptr<PluggedDevice> device, DeviceWiring wiring, Reopen reopen,
                   std::chrono::milliseconds patience = std::chrono::milliseconds(250));
  /// Lets the device go, without force. Waits for an attempt to open it that is under way.
  ~HotPluggedDevice() override;
  HotPluggedDevice(const HotPluggedDevice&) = delete;
  HotPluggedDevice& operator=(const HotPluggedDevice&) = delete;

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override;
  Reading sample() noexcept override;
  Force command(Force force) noexcept override;

  /// While nobody else uses the device, as after a run.
  HotPlugReport report() const;

 private:
  void attend();
  /// Waits until something is to be done; false: nothing more.
  bool rest();
  static void add(std::vector<std::pair<std::string, long>>& sum,
                  const std::vector<std::pair<std::string, long>>& more);

  const DeviceProfile profile_;
  const DeviceWiring wiring_;
  const Reopen reopen_;
  const std::chrono::milliseconds patience_;

  // The real-time thread's.
  PluggedDevice* held_;
  Reading last_;
  long settling_ = 0;  // ticks until a new device is used

  std::atomic<PluggedDevice*> offered_{nullptr};  // to the real-time thread
  std::atomic<PluggedDevice*> retired_{nullptr};  // by it
  std::atomic<long> losses_{0}, returns_{0};

  mutable std::mutex mutex_;  // of what follows; never taken by the real-time thread
  std::condition_variable news_;
  bool ends_ = false;
  HotPlugReport report_;
  std::thread attendant_;
};

}  // namespace wale
