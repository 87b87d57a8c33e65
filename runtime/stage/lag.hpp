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
  /// A command, and the place of the handle that it answers.
  struct Answer {
    glm::dvec2 force{0}, place{0};  ///< N, m
  };

  /// Allocates as much as there are commands under way, a thousand at most.
  explicit Lag(const DeviceProfile& profile);

  /// As if this had been the answer for ever.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void begin(const Answer& answer) noexcept;

  /// The mean over the `periods` control periods that just ended, all through which `held` was the last command, of
  /// what the actuators exert and of the places that this answers. A command that arrives within a period acts for the
  /// rest of it. Real-time likewise.
  Answer over(const Answer& held, long periods) noexcept;

  /// Periods between a command and its force, of each axis.
  glm::dvec2 periods() const noexcept { return periods_; }

 private:
  /// What arrives in the period that ends with the newest command.
  Answer arriving() const noexcept;

  bool prompt_ = true;  // not late at all
  glm::dvec2 periods_{0};
  std::array<std::size_t, 2> whole_{};  // periods
  glm::dvec2 part_{0};                  // of one more
  std::vector<Answer> answers_;         // a ring, one a period; a power of two
  std::size_t newest_ = 0;
};

}  // namespace wale
