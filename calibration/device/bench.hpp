#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/analysis/random.hpp"
#include "calibration/device/fit_handle.hpp"
#include "calibration/device/fit_response.hpp"
#include "wale/device.hpp"
#include "wale/device_wiring.hpp"
#include "wale/result.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// What a position does while nothing pushes, in counts, by axis.
struct RestNoise {
  std::array<double, 2> deviation{};  ///< the standard deviation
};

/// A device that is measured. It is driven on the calling thread, which must not be used for anything else meanwhile,
/// and is without force whenever no call is under way. Errors of all calls: `stopped` once `stop` is true, and
/// `lost_device`.
class Bench {
 public:
  /// `gain`: N that `device` must be told for each N of its motors' commands, by axis, as in
  /// `TrustedDevice::uncorrected`. `is_virtual`: time passes as fast as it can; otherwise ticks come at the device's
  /// rate. Both references must outlive the bench.
  Bench(Device& device, std::array<double, 2> gain, bool is_virtual, const std::atomic<bool>& stop)
      : device_(device), gain_(gain), is_virtual_(is_virtual), stop_(stop) {}

  const DeviceProfile& profile() const noexcept { return device_.profile(); }
  /// Pushes one way with a motor's command of so many N, rising and falling slowly, and holding it for so many
  /// seconds. Returns the command that the motor took, in its own steps.
  Result<double> push(Way way, double command, double seconds);
  /// Waits without force for so many seconds, and watches the positions.
  Result<RestNoise> rest(double seconds);
  /// Shakes the handle to and fro along an axis, 0 or 1, by at most so many N at the handle, for about ten seconds, and
  /// keeps it near the middle. `response`: the axis's force by its command.
  Result<std::vector<HandleTick>> shake(int axis, double most_newton, const AxisResponse& response);
  /// The smallest change of a position between two ticks so far, in counts, by axis; 0: it never changed.
  const std::array<int, 2>& smallest_steps() const noexcept { return smallest_steps_; }

 private:
  /// One tick with this command along one axis: where the handle was, and the command that the motor took.
  struct Tick {
    glm::ivec2 counts;
    double command;
  };
  Result<Tick> tick(int axis, double command);
  void let_go() noexcept { device_.command(Force(0)); }

  Device& device_;
  std::array<double, 2> gain_;
  bool is_virtual_;
  const std::atomic<bool>& stop_;
  std::array<int, 2> smallest_steps_{};
  std::optional<glm::ivec2> last_;
  std::chrono::steady_clock::time_point next_{};
};

/// A simulated device whose motors push as a declaration says they do, with a simulated gauge. Its handle is free.
class PlantedDevice final : public Device {
 public:
  /// `truth`: the gains, responses and offsets of its motors. The profile must be that of a joystick.
  PlantedDevice(const DeviceProfile& profile, const DeviceWiring& truth, std::uint64_t seed);

  const DeviceProfile& profile() const noexcept override { return joystick_.profile(); }
  void elapse(long periods) noexcept override { joystick_.elapse(periods); }
  Reading sample() noexcept override { return joystick_.sample(); }
  /// `force` is the motors' command, N; returns it in their steps.
  Force command(Force force) noexcept override;

  /// What the gauge shows while a motor pushes one way by this command, N: the true force, its zero and noise.
  double gauge(Way way, double command);

 private:
  std::array<AxisResponse, 2> truth_;
  SimulatedJoystick joystick_;
  analysis::Random random_;
};

}  // namespace wale
