#pragma once

#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "runtime/device/falcon/falcon_packets.hpp"
#include "runtime/device/force_limits.hpp"

namespace wale::falcon {

/// Steps of torque per N m, so that a motor's whole torque gives `full_newton` at the workspace's middle, in the
/// weakest direction of the plane. The motors' own figures are not published, so this comes from the device's
/// declaration.
double steps_per_newton_metre(double full_newton) noexcept;

/// Stricter limits, which still hold when the handle has moved on before the next packet. In the workspace the force of
/// fixed torques grows by at most 1.2 % per millimetre, and a hand of 1 m/s moves 2 mm from one answer of the encoders
/// to the packet after the next.
ForceLimits for_moving_handle(ForceLimits limits) noexcept;

/// The last stage before a packet: limits its torques. It bounds the force vector at the handle, including the part
/// across the plane, for the place of the handle that the encoders report. Without limits it lets no torque through.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
class TorqueGate {
 public:
  TorqueGate() = default;
  /// Each axis of the plane keeps within its peak, the part across it within `most_across` N, and the whole vector
  /// within what the user allows.
  TorqueGate(const ForceLimits& limits, double most_across);
  bool has_limits() const noexcept { return steps_per_newton_metre_ > 0; }

  /// The torques, made smaller together until their force is within the limits, and rounded toward zero. None where no
  /// place of the handle fits the encoders.
  Torques within(const Torques& torques, const Encoders& encoders) const noexcept;

 private:
  double excess(const glm::dmat3& turning, const Torques& torques) const noexcept;

  double steps_per_newton_metre_ = 0;  // 0: there are no limits yet
  glm::dvec3 gain_{1}, most_{0};       // N at the handle for each N of the kinematics; N, along each axis
  double most_newton_ = 0;             // N, of the whole
};

}  // namespace wale::falcon
