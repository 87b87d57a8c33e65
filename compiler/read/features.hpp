#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

namespace wale {

/// A part of a force that does not repeat and depends on one coordinate: the distance along a direction, or from a
/// point. Walls, edges, springs that saturate and single hills are such features.
struct Feature {
  bool radial = false;
  glm::dvec2 origin{0};      ///< m: the point, or (0, 0)
  glm::dvec2 direction{0};   ///< of length 1; (0, 0) for a radial one
  double low = 0, step = 0;  ///< m: the coordinate of the profile's first value, and between values
  /// N: the force; for a radial feature, x is outward and y is around the point, counterclockwise.
  std::vector<glm::dvec2> profile;
  double range = 0;            ///< N: between the least and the greatest of the profile
  std::optional<double> jump;  ///< m: the coordinate at which it is known to jump, however little
  /// It pushes ever more one way and never comes back: a wall, an edge or a spring. Otherwise it is a hill.
  bool monotone = false;
  bool smooth = false;  ///< it is known to jump nowhere

  glm::dvec2 at(glm::dvec2 place) const;
  double coordinate(glm::dvec2 place) const {
    return radial ? glm::length(place - origin) : glm::dot(place, direction);
  }
  /// Whether the profile jumps about there, so that what it leaves says nothing.
  bool jumps_at(glm::dvec2 place) const;
};

/// Adds a feature to the forces at some places, so many times.
void add_feature(const Feature& feature, double times, std::span<const glm::dvec2> places,
                 std::span<glm::dvec2> forces);

/// A force at a place without the features; nothing is left where one of them jumps.
glm::dvec2 beside(const std::vector<Feature>& features, glm::dvec2 place, glm::dvec2 force);

/// The features of some forces: at most two, if together they explain nearly all of them; none otherwise. Unless they
/// `may_turn`, none is looked for beside one that turns as often as a texture does.
std::vector<Feature> find_features(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces,
                                   bool may_turn = true);

/// Fits the profiles of features anew to more forces, and finely, and tells which are monotone. Nothing is left if one
/// turns as often as a texture does.
void refine_features(std::vector<Feature>& features, std::span<const glm::dvec2> places,
                     std::span<const glm::dvec2> forces);

}  // namespace wale
