#pragma once

#include <span>
#include <vector>

#include "compiler/grade/grade.hpp"
#include "compiler/grade/slopes.hpp"

namespace wale {

/// Hands at rest, or in motion, that a program is looked at with, spread all over its patch.
inline constexpr std::size_t lattice_hands = 4096;

/// The spectral norm of the force's slope by place, N/m; 0 where there is none, as at the middle of a cone.
double steepness(const Slopes& by_place);

/// The numbers of the greatest values, `most` at most, the greatest first; of equals the first of them first.
std::vector<std::size_t> greatest_of(std::span<const double> values, std::size_t most);

/// Hands where a program has been looked at.
struct LookedAt {
  std::span<const Hand> hands;
  std::span<const float> states;  ///< hand by hand
  std::span<const ProgramSlopes::ByPlace> at;
};

/// The steepest places that were found, not in order.
struct SteepPlaces {
  std::vector<Hand> hands;
  std::vector<float> states;  ///< hand by hand
  double stiffness = 0;       ///< N/m, of the steepest
  WorstPlace where;           ///< that is
};

/// From the steepest of the hands that were looked at to steeper places beside them: on a patch of half extents
/// `extent` (m), in ever smaller steps.
SteepPlaces find_steepest(ProgramSlopes& slopes, const LookedAt& looked_at, glm::vec2 extent);

}  // namespace wale
