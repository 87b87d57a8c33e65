#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "compiler/read/still_forces.hpp"

namespace wale {

/// A force that depends on one coordinate and repeats along it, with any waveform.
struct FoldedWave {
  glm::dvec2 waves{0};              ///< periods over a metre along x and y
  std::vector<glm::dvec2> profile;  ///< N: the force over one period, at the middles of equal parts, without its mean
  glm::dvec2 mean{0};               ///< N: over one period, of the forces that it was found in
  /// 0 .. 1: the share of the mean square of the forces it was found in, beyond what as many free numbers explain by
  /// chance
  double explained = 0;

  double period() const;  ///< m
  /// Adds its force, so many times, to those at some places.
  void add_to(std::span<const glm::dvec2> places, std::span<glm::dvec2> forces, double times) const;
};

/// The share of the forces' mean square (about their mean) that a wave of any waveform explains, with `bins` parts of a
/// period: epoch folding. What as many parts explain of noise is taken off.
double explained_by(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                    std::size_t bins);

/// The wave itself: the mean force at each part of its period.
FoldedWave folded(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                  std::size_t bins);

/// Moves `waves` to where the phase of a wave agrees in all quarters of a window of `size` about `centre`. It must be
/// right to about a period over half the window, and have at least two periods there.
glm::dvec2 in_phase(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 centre,
                    glm::dvec2 size, glm::dvec2 waves);

/// Moves `waves` to where one waveform fits all places best, by one step of Gauss and Newton. They must be right to a
/// third of a period over the places, or less for a waveform with steps.
glm::dvec2 better_fitting(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 waves,
                          std::size_t bins);

/// So many harmonics of each wave are fitted beside a linear part.
inline constexpr std::size_t harmonics_beside = 4;

/// The linear part of some forces beside waves of these periods, by least squares of it and their first harmonics
/// together. No two of the harmonics may be the same.
LinearForce linear_beside(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                          std::span<const glm::dvec2> waves);

/// The share of the mean square that two waves explain together with all that repeats with both: a lattice.
double explained_by_lattice(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, glm::dvec2 one,
                            glm::dvec2 other, std::size_t bins);

}  // namespace wale
