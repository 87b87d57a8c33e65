#pragma once

#include <array>
#include <span>
#include <vector>

#include "compiler/read/obstacles.hpp"

namespace wale {

/// A model of a static force: an even force, walls, steps, and waves of a few harmonics.
class ObstacleFit {
 public:
  struct Wave {
    glm::dvec2 waves{0};                           ///< periods over a metre
    std::vector<std::array<glm::dvec2, 2>> parts;  ///< N: cosine and sine of each harmonic, from the first on
  };

  LinearForce even;
  Obstacles found;
  std::vector<Wave> waves;

  glm::dvec2 at(glm::dvec2 place) const;
  /// What the model leaves of some forces.
  std::vector<glm::dvec2> rest(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) const;
  /// Moves everything to where it fits best nearby, by so many steps of Levenberg and Marquardt at most. What jumps is
  /// moved to where the jump fits best. Returns the mean square of what is left, N^2.
  double improve(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, int steps);
  /// Moves each step that jumps to where all places about it say that it does. Fitted at some of them, it lies off by
  /// as much as these are apart, and the places between would have the whole jump left.
  void seat_jumps(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces);
  /// Whether each wall that fills its circle pushes most about its middle. On top of a hill nothing pushes.
  bool fills_its_circles(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces) const;

 private:
  double improve_once(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces, int steps);
  std::size_t columns() const;
  void fill(glm::dvec2 place, std::span<glm::dvec2> by) const;
  void move(std::span<const double> by);
  void move_jumps(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces);
};

}  // namespace wale
