#pragma once

#include "wale/device.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// A pad or gamepad that only vibrates, as its profile describes it, under a simulated finger. A pad does not push, so
/// the finger follows its motion exactly. Every run gives the same bits.
///
/// A command is rounded to the nearest step that gives the acceleration at the frequency, by the profile's response,
/// and is limited to what the actuator reaches there. The amplitude approaches a new command with the profile's
/// spin-up; the frequency changes at once.
class SimulatedPad final : public Device {
 public:
  /// The profile must vibrate. Its rate must be positive, and so must its workspace and counts if it has a position.
  SimulatedPad(DeviceProfile profile, Motion motion);

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override;
  Reading sample() noexcept override;
  /// `drive`: amplitude in m/s^2 and frequency in Hz. Returns the present amplitude and frequency.
  Force command(Force drive) noexcept override;

 private:
  DeviceProfile profile_;
  Motion motion_;
  long long periods_ = 0;
  double target_ = 0;     // m/s^2, commanded
  double amplitude_ = 0;  // m/s^2, at present
  double frequency_ = 0;  // Hz
};

}  // namespace wale
