#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compare/compare.hpp"
#include "library/site/figures.hpp"
#include "library/site/frame.hpp"
#include "library/site/site_material.hpp"

namespace wale {

/// Materials on a plane, such that their distances there follow how much they differ to the hand.
struct FeltPlane {
  std::vector<const SiteMaterial*> materials;  ///< those whose cues are known
  std::vector<glm::dvec2> places;              ///< of each
  /// -1 .. 1: how well the order of the distances on the plane is that of the differences, over a sample of pairs
  /// (Spearman's rank correlation); nothing for fewer than three.
  std::optional<double> agreement;
  /// For a percept, the direction on the plane in which its level grows, and the share of its variance which that
  /// explains.
  struct Axis {
    std::string percept;
    glm::dvec2 way{0};
    double share = 0;
  };
  std::vector<Axis> axes;
};

/// Places them by classical scaling of a few that lie far apart (Torgerson 1952) and the others by their differences
/// from these (de Silva and Tenenbaum 2004). The difference of two is the logarithm of 1 and their distance in just
/// noticeable differences. Deterministic.
FeltPlane felt_plane(const std::vector<const SiteMaterial*>& materials, const Comparer& comparer);

/// The page of the plane, its picture, and what its script reads; `listed` are the materials as `search_files` has
/// them. Error: `Code::missing_library`.
Result<std::vector<SiteFile>> space_files(const FeltPlane& plane, const std::vector<const SiteMaterial*>& listed);

}  // namespace wale
