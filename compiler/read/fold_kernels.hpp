#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace wale {

/// The inner loops of folding: over many places, for one wave of `waves` periods over a metre.

/// The forces in each part of a period.
struct FoldedSums {
  std::vector<glm::dvec2> sums;  ///< N
  std::vector<std::uint32_t> counts;
  glm::dvec2 sum{0};   ///< N: of all forces
  double squares = 0;  ///< N^2: of all forces
};
FoldedSums fold_up(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                   std::size_t parts);

/// Adds a waveform, so many times, to forces. `profile` (N) has its values at the middles of equal parts of a period.
void add_waveform(std::span<const glm::dvec2> profile, glm::dvec2 waves, double times,
                  std::span<const glm::dvec2> places, std::span<glm::dvec2> forces);

/// The cosines and the sines of a wave's phase; 2e-7 of 1 are lost.
void cosines_and_sines(std::span<const glm::dvec2> places, glm::dvec2 waves, std::span<double> cosines,
                       std::span<double> sines);

/// The sums over places by which a wave is moved to where it fits better.
struct SlopeSums {
  double weights = 0, off = 0, xx = 0, xy = 0, yy = 0;
  glm::dvec2 places{0}, offs{0};
};
/// `slope` (N per period) is that of the waveform in each part; a place weighs as much as the square of its slope.
SlopeSums sum_slopes(std::span<const glm::dvec2> profile, std::span<const glm::dvec2> slope, glm::dvec2 mean,
                     glm::dvec2 waves, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces);

/// The forces of each quarter of a window of `size` (m) about `centre`, through a window nearly as Hann's that keeps
/// the ends of incomplete periods out, times the cosines and minus the sines of a wave. Half along y counts one, and
/// half along x two.
struct QuarterSums {
  glm::dvec2 real[4] = {}, imaginary[4] = {};
};
QuarterSums sum_quarters(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 centre,
                         glm::dvec2 size, glm::dvec2 waves);

}  // namespace wale
