#pragma once

#include "wale/device.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// A pad or gamepad that only vibrates, as its profile describes it, under a simulated finger: it holds nothing back,
/// so the finger is where its motion says. The same bit for bit each time.
///
/// A command is taken to the nearest step that gives the acceleration at the frequency, by the profile's response; what
/// the actuator does not reach there it does not give. From one command to the next the amplitude comes as the
/// profile's spin-up has it, and the frequency follows at once.
class SimulatedPad final : public Device {
 public:
  /// The profile vibrates and its rate is positive, as are workspace and counts where it has a position.
  SimulatedPad(DeviceProfile profile, Motion motion);

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override;
  Reading sample() noexcept override;
  /// `drive`: amplitude in m/s^2 and frequency in Hz. Returns the amplitude and frequency of now.
  Force command(Force drive) noexcept override;

 private:
  DeviceProfile profile_;
  Motion motion_;
  long long periods_ = 0;
  double target_ = 0;     // m/s^2, of the command
  double amplitude_ = 0;  // m/s^2, by now
  double frequency_ = 0;  // Hz
};

}  // namespace wale
