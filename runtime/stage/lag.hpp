#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "wale/device_profile.hpp"

namespace wale {

/// Models the lag of a device's actuators: while a command is under way they still exert an older one. Each axis lags
/// by the profile's delay and by the time constant of its bandwidth.
class Lag {
 public:
  /// A command, and the handle's position from which it was computed.
  struct Answer {
    glm::dvec2 force{0}, place{0};  ///< N, m
  };

  /// Allocates room for the commands under way, a thousand at most.
  explicit Lag(const DeviceProfile& profile);

  /// Begins as if this had been the answer for ever.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void begin(const Answer& answer) noexcept;

  /// The mean force of the actuators, and the mean position that it answers, over the `periods` control periods that
  /// just ended. `held` was the last command throughout. A command that arrives within a period acts for the rest of
  /// it. Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Answer over(const Answer& held, long periods) noexcept;

  /// Periods between a command and its force, of each axis.
  glm::dvec2 periods() const noexcept { return periods_; }

 private:
  /// The answer that arrives in the period that ends with the newest command.
  Answer arriving() const noexcept;

  bool prompt_ = true;  // no lag on either axis
  glm::dvec2 periods_{0};
  std::array<std::size_t, 2> whole_{};  // periods
  glm::dvec2 part_{0};                  // of one more period
  std::vector<Answer> answers_;         // a ring, one a period; a power of two
  std::size_t newest_ = 0;
};

}  // namespace wale
