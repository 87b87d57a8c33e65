#pragma once

#include <span>
#include <vector>

#include "compiler/grade/grade.hpp"
#include "compiler/grade/slopes.hpp"

namespace wale {

/// The number of hands, at rest or in motion, that are spread over the patch to grade a program.
inline constexpr std::size_t lattice_hands = 4096;

/// The spectral norm of the force's slope by place, N/m; 0 if there is no slope, as at the tip of a cone.
double steepness(const Slopes& by_place);

/// The indices of at most `most` greatest values, the greatest first; equal values are in their own order.
std::vector<std::size_t> greatest_of(std::span<const double> values, std::size_t most);

/// Hands at which a program's slopes have been computed.
struct LookedAt {
  std::span<const Hand> hands;
  std::span<const float> states;  ///< hand by hand
  std::span<const ProgramSlopes::ByPlace> at;
};

/// The steepest places that were found, not in order.
struct SteepPlaces {
  std::vector<Hand> hands;
  std::vector<float> states;  ///< hand by hand
  double stiffness = 0;       ///< N/m, at the steepest
  WorstPlace where;           ///< the steepest place
};

/// Searches for steeper places near the steepest of the given hands, on a patch with half extents `extent` (m), by a
/// hill climb with ever smaller steps.
SteepPlaces find_steepest(ProgramSlopes& slopes, const LookedAt& looked_at, glm::vec2 extent);

}  // namespace wale
