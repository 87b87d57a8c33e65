#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "schema/device_profile.hpp"
#include "schema/device_wiring.hpp"
#include "wale/program.hpp"

namespace wale {

struct IdentifyOptions {
  /// N along one motor, what the user allows; a fifth of the profile's peak force is not exceeded either.
  double most_newton = 1e9;
  /// Whether a person is there to move the handle when asked. Otherwise the device's own axes are taken for those that
  /// its kind's standard says.
  bool asks = false;
};

/// How the handle answered to one motor.
struct MotorAnswer {
  std::optional<SignedAxis> moves;  ///< the device's own axis that a push of it moves, and which way
  double newton = 0;                ///< the least force at which the handle began to move; 0: it did not
  std::string problem;              ///< why nothing can be told; empty otherwise
};

struct Identified {
  std::array<MotorAnswer, 2> motors;
  std::array<std::optional<SignedAxis>, 2> shown;  ///< what the person moved it along: to the right, and away
  /// Both motors and both axes; none: it could not be told.
  std::optional<std::array<SignedAxis, 2>> axes_settled, motors_settled;
  std::string problem;  ///< why not; empty otherwise
};

/// Finds out which of a device's motors moves which of its axes, and which way. Each motor in turn pushes one way and
/// the other, with a force that rises slowly until the handle has moved a little, or the most allowed is reached; in
/// between the handle comes to rest. Then, if somebody is there, the handle is moved to the right and away by hand, and
/// the device does not push.
///
/// It knows no device: it is given counts along the device's own axes once a tick and tells the force to command along
/// its own motors.
class Identification {
 public:
  /// The profile's rate, workspace, counts and force are positive.
  Identification(const DeviceProfile& profile, const IdentifyOptions& options);

  /// The force (N along the device's own motors) from now on, with the handle at `counts`. Never beyond the most
  /// allowed, along one motor at a time, and none when it is done.
  Force tick(glm::ivec2 counts);

  bool is_done() const { return phase_ == Phase::done; }
  /// What the person should do now; changes from phase to phase.
  std::string_view request() const;
  /// When it is done.
  Identified result() const;
  /// The most that it pushes with, N.
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
