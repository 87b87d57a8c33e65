#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "compiler/read/features.hpp"
#include "compiler/read/half_plane.hpp"
#include "compiler/read/still_forces.hpp"

namespace wale {

/// A wall that pushes back in proportion to the depth of the hand in it: behind a straight line, or all round.
struct Wall {
  glm::dvec2 inward{0};  ///< straight: unit vector into it; (0, 0) of a round one
  glm::dvec2 centre{0};  ///< round: m, of its circle
  double offset = 0;     ///< straight: m along `inward` from the patch's centre, where it begins; round: the radius
  bool fills = false;    ///< round: it fills its circle; otherwise it lies around it
  double stiffness = 0;  ///< N/m
  double preload = 0;    ///< N: with which it pushes where it begins
  double power = 1;      ///< of the depth, with which the push grows; 0 if with none

  bool round() const { return inward == glm::dvec2(0); }
  double depth(glm::dvec2 place) const;     ///< m; negative outside
  glm::dvec2 into(glm::dvec2 place) const;  ///< unit vector into it there
  glm::dvec2 at(glm::dvec2 place) const;    ///< N
  void begin_deeper(double by) { offset += fills ? -by : by; }  ///< moves the face by so much, m
};
Wall wall_of(const HalfPlane& face);

/// A straight line beyond which the force is another one.
struct StaticStep {
  glm::dvec2 way{1, 0};  ///< unit vector across the line
  double offset = 0;     ///< m along `way` from the patch's centre
  double width = 0;      ///< m: of the hyperbolic tangent in which it rises; 0 if it jumps
  glm::dvec2 change{0};  ///< N: by so much the force beyond is larger

  glm::dvec2 at(glm::dvec2 place) const;
};

/// A round hill or hole: it pushes away from its top, or towards it, and not at all from some distance on. So an even
/// force or a wall beside it can be told from it.
struct Hill {
  glm::dvec2 top{0};         ///< m
  double reach = 0;          ///< m: from there on it pushes no more
  std::vector<double> push;  ///< N: away from its top, at even distances from 0 on, before the reach

  double spacing() const { return reach / static_cast<double>(push.size()); }  ///< m
  glm::dvec2 at(glm::dvec2 place) const;                                       ///< N
};

/// What stands in a patch beside an even force and textures.
struct Obstacles {
  std::vector<Wall> walls;
  std::vector<StaticStep> steps;
  std::optional<Hill> hill;  ///< is a relief

  bool empty() const { return walls.empty() && steps.empty() && !hill; }
};

/// The walls and steps that explain forces at the places of `whole`, beside a force that changes evenly over the patch;
/// nothing if they do not explain nearly all that a line leaves and that is no texture.
std::optional<Obstacles> find_obstacles(const StillForces& whole, std::span<const glm::dvec2> forces);

/// The wall or step that stands so near to an edge or in a corner that means over small cells show nothing of where it
/// begins, beside a line that explains the rest of the patch exactly.
std::optional<Obstacles> obstacle_at_edge(const StillForces& whole, std::span<const glm::dvec2> forces);

/// A slow wave beside them: its harmonics are fitted with them.
struct SlowWave {
  glm::dvec2 waves{0};  ///< periods over a metre
  std::size_t harmonics = 1;
};

/// Fits obstacles anew, together with waves and an even force.
Obstacles fitted_beside(const Obstacles& found, std::span<const SlowWave> waves, std::span<const glm::dvec2> places,
                        std::span<const glm::dvec2> forces);

/// As features of forces at these places.
std::vector<Feature> features_of(const Obstacles& found, std::span<const glm::dvec2> places);

}  // namespace wale
