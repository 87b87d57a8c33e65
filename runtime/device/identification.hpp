#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "wale/device_profile.hpp"
#include "wale/device_wiring.hpp"
#include "wale/program.hpp"

namespace wale {

struct IdentifyOptions {
  /// N along one motor, the user's limit. The force also never exceeds a fifth of the profile's peak force.
  double most_newton = 1e9;
  /// Whether a person is there to move the handle when asked. Otherwise the device's axes are assumed to lie as in its
  /// standard.
  bool asks = false;
};

/// How the handle moved under one motor.
struct MotorAnswer {
  std::optional<SignedAxis> moves;  ///< the device's own axis that the motor moves, and its direction
  double newton = 0;                ///< N, the least force at which the handle began to move; 0: it did not
  std::string problem;              ///< why the axis is not known; empty if it is
};

struct Identified {
  std::array<MotorAnswer, 2> motors;
  std::array<std::optional<SignedAxis>, 2> shown;  ///< the axes that the person moved: to the right, and away
  /// Both axes and both motors; empty if they are not known.
  std::optional<std::array<SignedAxis, 2>> axes_settled, motors_settled;
  std::string problem;  ///< why not; empty otherwise
};

/// Finds out which motor of a device moves which of its axes, and which way. Each motor in turn pushes one way and then
/// the other. The force rises slowly until the handle has moved a little, or the largest force allowed is reached; in
/// between the handle comes to rest. Then a person, if one is there, moves the handle to the right and away by hand,
/// while the device does not push.
///
/// It does no input or output: once a tick it takes counts along the device's own axes, and gives the force to command
/// along its own motors.
class Identification {
 public:
  /// The profile's rate, workspace, counts and force must be positive.
  Identification(const DeviceProfile& profile, const IdentifyOptions& options);

  /// The force (N along the device's own motors) to command while the handle is at `counts`: along one motor at a time,
  /// never above `most_newton()`, and none when it is done.
  Force tick(glm::ivec2 counts);

  bool is_done() const { return phase_ == Phase::done; }
  /// The sentence that asks the person to do something now; changes from phase to phase.
  std::string_view request() const;
  /// Call it only when it is done.
  Identified result() const;
  /// The largest force that it pushes with, N.
  double most_newton() const { return most_; }

 private:
  enum class Phase { rest, push, hold, ease, ask_right, back, ask_away, done };

  void enter(Phase phase);
  bool is_still(glm::dvec2 position);
  void watch_person(glm::dvec2 position);
  double seconds() const { return static_cast<double>(ticks_) * tick_seconds_; }
  double sense() const { return push_ % 2 == 0 ? 1 : -1; }
  std::size_t motor() const { return static_cast<std::size_t>(push_ / 2); }

  bool asks_;
  double most_, tick_seconds_, position_step_, enough_, far_;
  Phase phase_ = Phase::rest;
  long ticks_ = 0;  // in this phase
  int push_ = 0;    // motor 0 one way, the other way, motor 1 one way, the other way
  double force_ = 0, eased_from_ = 0;
  glm::dvec2 start_{0};     // of a push or a movement, m
  glm::dvec2 still_at_{0};  // where the handle was when it was last seen to move
  long still_ticks_ = 0, shown_ticks_ = 0;
  struct Push {
    glm::dvec2 moved{0};  // m
    double newton = 0;    // when it had moved enough; 0: it did not
  };
  std::array<Push, 4> pushes_;
  std::array<std::optional<SignedAxis>, 2> shown_;
};

}  // namespace wale
