#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "compiler/read/fold.hpp"
#include "compiler/read/still_forces.hpp"

namespace wale {

/// A line and some waves of a few harmonics each that fit forces together.
struct HarmonicFit {
  std::vector<FoldedWave> waves;  ///< in the order in which they were given; each profile is its harmonics' sum
  LinearForce line;
  double left = 0;        ///< N^2: mean square of what they leave
  double left_there = 0;  ///< N^2: the same with the waves where they were given
};

/// Moves waves, given as periods over a metre, to where they fit forces best together with a line, and fits those. A
/// wave of few periods is a little like a line and like another such wave, so that fitting them in turn ends between
/// them. By Gauss and Newton's method with the linear part projected out (Kaufman 1975, A variable projection method
/// for solving separable nonlinear least squares problems). `size` (m) is the window's; profiles get `bins` parts.
HarmonicFit fit_harmonics(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                          std::span<const glm::dvec2> waves, glm::dvec2 size, std::size_t bins);

/// The line that fits forces best together with waves, where these are, of a few harmonics each. Unlike a line that is
/// fitted to what the waves leave, it holds nothing of their incomplete periods.
LinearForce line_beside_waves(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                              std::span<const glm::dvec2> waves, glm::dvec2 size);

}  // namespace wale
