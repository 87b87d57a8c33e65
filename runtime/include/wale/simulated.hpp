#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <variant>
#include <vector>

#include "wale/device.hpp"
#include "wale/trace.hpp"

namespace wale {

/// A person's hand and arm: a mass on a spring and a damper whose far end is the position that the person aims for.
struct HandModel {
  double mass = 0;       ///< kg
  double damping = 0;    ///< N s/m
  double stiffness = 0;  ///< N/m
};

/// The position that the simulated person aims for, in m from the workspace's centre.
struct Rest {
  glm::dvec2 position{0};
};

/// A sine along `direction` that begins at the centre, towards it.
struct Lateral {
  double amplitude = 0;  ///< m to each side
  double frequency = 0;  ///< Hz
  glm::dvec2 centre{0};
  glm::dvec2 direction{1, 0};  ///< of length 1
};

/// Counter-clockwise, beginning at the circle's rightmost point.
struct Circular {
  double radius = 0;     ///< m
  double frequency = 0;  ///< turns per second
  glm::dvec2 centre{0};
};

/// A push that begins at rest at the centre, goes `depth` along `direction` and comes back, again and again.
struct Press {
  double depth = 0;      ///< m
  double frequency = 0;  ///< pushes per second
  glm::dvec2 centre{0};
  glm::dvec2 direction{1, 0};  ///< of length 1
};

using Motion = std::variant<Rest, Lateral, Circular, Trace, Press>;

/// The direction so many turns to the left of x, a vector of length 1. The same bits on every machine.
glm::dvec2 heading(double turns) noexcept;

/// The position and velocity of a motion at `time` (s). The same bits on every machine.
TracePoint at(const Motion& motion, double time) noexcept;

/// A joystick with the profile's mass, damping, friction, encoders and actuators, in the hand of a simulated person who
/// holds its handle rigidly. A command reaches the actuator after the profile's delay, and the actuator is a
/// first-order low-pass of the profile's bandwidth; each axis has its own figures. Time is counted in elapsed periods,
/// so every run gives the same bits.
///
/// The person starts at rest where the motion starts. The axes are independent except at the edge of the round
/// workspace, where the handle stops dead.
class SimulatedJoystick final : public Device {
 public:
  /// The profile's rate, workspace, counts and force must be positive, and so must `profile.mass + hand.mass`.
  /// Allocates room for the commands under way.
  SimulatedJoystick(DeviceProfile profile, HandModel hand, Motion motion);

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override;
  Reading sample() noexcept override;
  Force command(Force force) noexcept override;

  /// The handle's true position and velocity, m and m/s, which a real device does not know.
  glm::dvec2 position() const { return position_; }
  glm::dvec2 velocity() const { return velocity_; }

 private:
  /// The actuator of one axis, and the commands under way to it.
  struct Actuator {
    std::vector<double> under_way;  ///< N, the last commands; the newest at `newest`
    std::size_t newest = 0;
    double delay = 0;   ///< steps of the integration
    double follow = 1;  ///< share of the difference to the command that the actuator makes up in one step
    double since = 0;   ///< steps since the newest command
    double force = 0;   ///< N

    Actuator(double delay_seconds, double bandwidth, double step_seconds);
    void command(double wanted) noexcept;
    /// The force in the next step.
    double step() noexcept;
  };

  void step(const TracePoint& target, double seconds) noexcept;

  DeviceProfile profile_;
  HandModel hand_;
  Motion motion_;
  long long periods_ = 0;
  glm::dvec2 position_{0}, velocity_{0};
  std::array<Actuator, 2> actuators_;
  glm::dvec2 interaction_{0};  // N, mean over the last period
  glm::dvec2 impulse_{0};      // N s, from hand to handle since the period began
};

}  // namespace wale
