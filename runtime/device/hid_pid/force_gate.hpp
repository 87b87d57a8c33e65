#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "runtime/device/force_limits.hpp"

// The last stage before a packet decides how much force the packet may carry. All of it is real-time: allocates
// nothing, takes no lock, makes no system call, does not throw. Shares are of the device's full force, in -1 .. 1.
// Directions are unit vectors along the device's own axes.

namespace wale::hid {

/// Where a force of an effect points (HID PID 1.0, section 3.1.2.2.1): y points to the user, and degrees count from the
/// direction away from the user, clockwise.
glm::dvec2 unit(double degrees) noexcept;
constexpr double toward_x = 90, toward_y = 180;  // degrees

/// The magnitude of an effect, in counts of the packet's field. Only a `ForceGate` makes one other than zero.
class Magnitude {
 public:
  Magnitude() = default;
  std::int64_t counts() const noexcept { return counts_; }

 private:
  friend class ForceGate;
  explicit Magnitude(std::int64_t counts) noexcept : counts_(counts) {}

  std::int64_t counts_ = 0;
};

/// A command along the device's own axes, reduced to the limits: first each axis, then the whole vector in its
/// direction. Not-a-number becomes 0.
glm::dvec2 within(const ForceLimits& limits, glm::dvec2 share) noexcept;

/// A commanded share in counts of `full`, rounded toward zero, but for the rounding of a float: a command of a whole
/// count is that count. What a packet may carry is bounded apart.
std::int64_t commanded_counts(double share, std::int64_t full) noexcept;

/// The magnitudes of one effect that the device may hold now: the newest one known to have arrived, and all on their
/// way.
class MayHold {
 public:
  static constexpr int most_on_their_way = 8;

  bool is_full() const noexcept { return count_ > most_on_their_way; }
  std::int64_t newest() const noexcept { return counts_[static_cast<std::size_t>(count_) - 1]; }
  std::int64_t most() const noexcept;  ///< without its sign
  void submitted(std::int64_t counts) noexcept;
  void arrived() noexcept;  ///< the oldest on its way

 private:
  std::array<std::int64_t, most_on_their_way + 1> counts_{};
  int count_ = 1;
};

/// Chooses the next packet so that the force at the handle is within the limits after each packet, for every state that
/// the device may be in. A packet carries one effect, and the other effect may still hold an old force. So an effect
/// that shrinks goes first, and an effect that grows gets the rest of the limit. Counts are rounded toward zero.
class ForceGate {
 public:
  ForceGate() = default;
  /// Two effects that push along fixed directions. `full_counts` is the magnitude of full force, at least 1.
  static ForceGate of_two(const ForceLimits& limits, std::int64_t full_counts,
                          const std::array<glm::dvec2, 2>& directions) noexcept;
  /// One effect that is turned, in steps of `direction_step` degrees up to `most_direction` of them.
  static ForceGate of_one(const ForceLimits& limits, std::int64_t full_counts, double direction_step,
                          std::int64_t most_direction) noexcept;

  /// What a packet changes.
  struct Change {
    std::size_t effect = 0;
    Magnitude magnitude;
    bool turns = false;    ///< it carries a direction; the magnitude is the one that is held, or goes with it
    double direction = 0;  ///< degrees, as in `ConstantEffect`, of an effect that is turned
  };

  /// The next part of a command to send; empty if all is sent, or if the rest has to wait for packets on their way.
  /// The part counts as on its way until `arrived`.
  std::optional<Change> next(glm::dvec2 wanted) noexcept;
  /// The oldest change of an effect has reached the device.
  void arrived(std::size_t effect) noexcept;
  /// Whether the newest changes, on their way or arrived, let the device push.
  bool holds_force() const noexcept { return held_[0].newest() != 0 || held_[1].newest() != 0; }

  /// The same of one effect, for a queue whose state is unknown: a direction, and a magnitude that is within the limits
  /// along every direction. So each may arrive first, late or never.
  std::optional<Change> next_at_once(glm::dvec2 wanted) noexcept;

 private:
  std::optional<Change> next_of_two(glm::dvec2 wanted) noexcept;
  std::optional<Change> next_of_one(glm::dvec2 wanted) noexcept;
  /// The most counts of an effect, while the other one may hold `other` counts.
  std::int64_t room(std::size_t effect, std::int64_t other) const noexcept;
  std::int64_t most_along(std::int64_t direction) const noexcept;
  std::int64_t most_along_any() const noexcept;
  std::int64_t counts_of(double share) const noexcept;
  struct Aim {
    std::int64_t direction = 0;
    double sign = 1;
  };
  /// The direction of a command and the sign of its magnitude, so that the effect turns by 90 degrees at most.
  Aim aim(glm::dvec2 wanted) const noexcept;
  double degrees(std::int64_t direction) const noexcept { return static_cast<double>(direction) * direction_step_; }

  ForceLimits limits_;
  std::int64_t full_ = 1;  // counts
  bool is_one_ = false;
  std::array<glm::dvec2, 2> newton_{};  // N at the handle of each effect at its full magnitude
  std::array<MayHold, 2> held_;
  std::size_t turn_ = 0;  // whose force comes first
  double direction_step_ = 1;
  std::int64_t directions_ = 360, most_direction_ = 359, direction_ = 90;  // steps
  bool turned_ = false;      // the direction has been sent, its magnitude not yet
  bool on_its_way_ = false;  // of one effect: something is
};

}  // namespace wale::hid
