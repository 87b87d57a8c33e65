#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <span>

namespace wale {

/// The two sines along `way` (of length 1) that explain most of forces together with a line, as periods over a metre;
/// right to about an eighth of a period over `length`, m. Over few periods either of them alone lies beside where it is.
/// All pairs of 1.5 to 12 periods over `length` are tried; at 1 500 places that takes two milliseconds.
std::array<glm::dvec2, 2> best_pair_along(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                                          glm::dvec2 way, double length);

}  // namespace wale
