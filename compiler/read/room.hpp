#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// Part of a line in the patch.
struct Stretch {
  glm::dvec2 place{0};           ///< m from the patch's centre
  glm::dvec2 way{1, 0};          ///< of length 1
  double before = 0, after = 0;  ///< m: how far it reaches from the place, against the way and along it
};

/// Where the device's limit leaves room for what a program adds to the force on a hand that moves. In a wall or a
/// spring at the limit, friction and drag do not show.
class Room {
 public:
  explicit Room(const Bank& bank);

  /// Moves a stretch to the nearest place where a resting hand feels little of what the device gives, if it is not at
  /// one, and not to those of `taken` if there are others. Where there is little room everywhere, to where there is
  /// most.
  glm::dvec2 nearest(const Stretch& wanted, std::span<const glm::dvec2> taken = {}) const;
  /// Whether a hand that rests anywhere on a stretch feels less than nearly all that the device gives.
  bool is_along(const Stretch& stretch) const { return used_.empty() || used_along(stretch) <= hardly_room; }

 private:
  static constexpr double hardly_room = 0.8;  // of the limit, on a resting hand

  double used_at(glm::dvec2 place) const;
  double used_along(const Stretch& stretch) const;

  glm::dvec2 half_;           // m: of the patch without its rim
  std::vector<double> used_;  // of the limit, in the cells of a square lattice; empty if there is room everywhere
};

}  // namespace wale
