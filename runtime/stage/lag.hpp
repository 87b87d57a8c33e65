#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "schema/device_profile.hpp"

namespace wale {

/// How late the actuators of a device are: while a command is on its way they still exert an older one. Each axis is
/// late by the profile's delay and by the time constant of its bandwidth.
class Lag {
 public:
  /// Allocates as much as there are commands under way, a thousand at most.
  explicit Lag(const DeviceProfile& profile);

  /// As if this had been the command for ever.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void begin(glm::dvec2 command) noexcept;

  /// What the actuators exert on average over the `periods` control periods that just ended, all through which `held`
  /// was the last command. A command that arrives within a period acts for the rest of it.
  /// Real-time likewise.
  glm::dvec2 over(glm::dvec2 held, long periods) noexcept;

  /// Periods between a command and what comes of it, of each axis.
  glm::dvec2 periods() const noexcept { return periods_; }

 private:
  struct Lateness {
    std::size_t whole = 0;  ///< periods
    double part = 0;        ///< of one more
  };

  bool prompt_ = true;  // not late at all
  glm::dvec2 periods_{0};
  std::array<Lateness, 2> late_;
  std::vector<glm::dvec2> commands_;  // a ring, one a period
  std::size_t newest_ = 0;
};

}  // namespace wale
