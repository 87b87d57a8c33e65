#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <span>

#include "compiler/read/features.hpp"

namespace wale {

/// A half plane that pushes back in proportion to the depth of the hand in it.
struct HalfPlane {
  glm::dvec2 inward{0};  ///< unit vector into it
  double offset = 0;     ///< m along `inward` from the patch's centre: where it begins
  double stiffness = 0;  ///< N/m
  double preload = 0;    ///< N: with which it pushes where it begins

  glm::dvec2 at(glm::dvec2 place) const {
    const double depth = glm::dot(place, inward) - offset;
    return depth > 0 ? -(preload + stiffness * depth) * inward : glm::dvec2(0);
  }
};

/// The face that explains these forces, beside a force that changes evenly over the patch (a spring, a constant push).
/// Nothing if the two do not explain nearly all that a line leaves. `even` are means over small cells, nearly free of
/// texture, of `forces`, which decide where exactly it stands.
std::optional<HalfPlane> find_half_plane(std::span<const glm::dvec2> even_places, std::span<const glm::dvec2> even,
                                         std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces);

}  // namespace wale
