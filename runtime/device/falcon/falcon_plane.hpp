#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "runtime/device/falcon/torque_gate.hpp"

namespace wale::falcon {

/// How the handle is kept in the plane: a spring and a damper along the third axis, never stronger than `most`. They
/// take only the torque that the force in the plane leaves, and come in gradually. The hold is passive: in a sampled
/// loop a spring of k N/m gives the energy that a damper of k times half a period plus the delay takes. For 400 N/m at
/// 900 Hz with a delay of 1 ms that is 0.6 N s/m, less than such an arm loses by itself.
struct HoldInPlane {
  double stiffness = 400;  ///< N/m; 0: the handle is free to leave the plane
  double damping = 1;      ///< N s/m
  double most = 3;         ///< N
  double coming_in = 0.5;  ///< s, in which the hold grows from nothing to its full strength when pushing begins
};

/// A Falcon as a joystick of two axes: the upright plane across its middle, x to the right, y up ("away from the user",
/// as on a screen), where all directions are alike. The handle is held in the plane. Real-time throughout: allocates
/// nothing, takes no lock, makes no system call, does not throw.
class FalconPlane {
 public:
  /// The peak along x is the force that a motor's whole torque gives at the workspace's middle, in the weakest
  /// direction (`steps_per_newton_metre`).
  explicit FalconPlane(const ForceLimits& limits, const HoldInPlane& hold = {});

  /// Takes the encoders' counts at time `now` (microseconds). False: no place of the handle fits them, and the previous
  /// place stays.
  bool see(const Encoders& encoders, std::int64_t now) noexcept;

  /// m from the workspace's middle.
  glm::dvec2 position() const noexcept { return {place_.x - workspace_centre.x, place_.y - workspace_centre.y}; }
  double out_of_plane() const noexcept { return place_.z - workspace_centre.z; }  ///< m, towards the user

  struct Push {
    Torques torques{};
    glm::dvec2 force{0};  ///< N, exerted by these torques in the plane
    double hold = 0;      ///< N, exerted by these torques across the plane
  };
  /// The torques for a force (N) in the plane at the newest place of the handle, rounded toward zero. A force beyond
  /// the motors or the user's limit keeps its direction and becomes smaller; the hold gets the rest of the limit.
  /// Not-a-number counts as no force.
  Push push(glm::dvec2 force, std::int64_t now) noexcept;

  /// Pushes nothing until the next `push`.
  void let_go() noexcept { pushed_ = -1; }

 private:
  double room_across(glm::dvec2& force) const noexcept;

  double steps_per_newton_metre_;
  ForceLimits limits_;
  HoldInPlane hold_;
  glm::dvec3 place_ = workspace_centre;
  glm::dmat3 turning_{0};
  bool is_known_ = false;
  double speed_out_ = 0;                  // m/s, filtered
  std::int64_t seen_ = -1, pushed_ = -1;  // when; -1: not yet
  double held_ = 0;                       // 0 .. 1, how far the hold has come in
};

}  // namespace wale::falcon
