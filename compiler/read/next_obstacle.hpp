#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <span>
#include <utility>
#include <vector>

#include "compiler/read/bend.hpp"
#include "compiler/read/obstacles.hpp"

namespace wale {

inline constexpr int ways_tried = 12;          // in half a turn
inline constexpr double first_width = 1.5e-3;  // m: of a step, before it is fitted

/// What is looked for.
struct Kinds {
  bool straight = false, round = false, steps = false;
  bool jumps = false;  ///< straight walls that may begin with a jump
};

/// One more obstacle, and what it explains of a mean square, N^2.
struct Candidate {
  Obstacles one;
  double explained = 0;
};

/// Places in their order along each way that is tried: they are sorted once for all obstacles.
class SortedWays {
 public:
  explicit SortedWays(std::span<const glm::dvec2> places);

  struct Way {
    Way() = default;
    Way(std::span<const glm::dvec2> places, glm::dvec2 way);
    glm::dvec2 along{0};
    std::vector<std::pair<double, std::size_t>> order;  // m along it, and which place
  };
  std::span<const Way> all() const { return ways_; }

 private:
  std::array<Way, ways_tried> ways_;
};

/// The best obstacle for what a model leaves. Keeps references to what it is made from.
class NextObstacle {
 public:
  NextObstacle(const SortedWays& ways, std::span<const glm::dvec2> places, std::span<const glm::dvec2> rest);

  /// A wall often faces as another one does, between the ways that are tried.
  Candidate found(const Kinds& kinds, const std::vector<Wall>& beside = {});

 private:
  glm::dvec2 axis_of_rest() const;
  std::pair<Bend, double> bend_along(const SortedWays::Way& way, glm::dvec2 push, BendKind kind) const;
  void try_straight(const SortedWays::Way& way, bool jump);
  void try_step(const SortedWays::Way& way, glm::dvec2 push);
  double try_round(glm::dvec2 centre);
  void try_round();

  const SortedWays& ways_;
  std::span<const glm::dvec2> places_, rest_;
  glm::dvec2 half_{0};
  Candidate best_;
};

}  // namespace wale
