#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "compiler/compile_workspace.hpp"

namespace wale {

/// The workspace in small squares, each with the patch that the hand feels there.
class Ground {
 public:
  /// `radius`: how far the device reaches, m. Squares have sides of half a millimetre, or more where the workspace is
  /// so wide that there would be more than a thousand in a row.
  Ground(const std::vector<LaidPatch>& laid, double radius);

  /// Whether a patch within the device's reach is too narrow for a square, and so in none of these answers.
  bool is_slit(std::size_t patch) const;
  /// Whether a patch that the device reaches lies wholly behind others.
  bool is_hidden(std::size_t patch) const { return covered_[patch] > 0 && seen_[patch] == 0; }

  /// Where a hand goes from one patch to another: the last place of `a` and the first of `b`, m.
  struct Crossing {
    glm::dvec2 of_a, of_b;
  };
  /// Patches, a < b, with places from which the way to the other is no longer than the rims of both, and those that
  /// overlap; with these places.
  std::map<std::pair<int, int>, std::vector<Crossing>> neighbours() const;

  /// The shortest way over nothing between two patches, a < b, m: along x or y, where no third patch lies between.
  /// Without those that touch.
  std::map<std::pair<int, int>, double> gaps() const;

  /// Of each patch, the width in the widest place of what is felt of it, m, to a square; 0 where nothing is.
  std::vector<double> widths() const;

  double square() const { return step_; }  ///< m; the side of a square

 private:
  static constexpr int nobody = -1;

  /// m; the place that stands for a square. It is not in its middle, so that edges at round places pass between two.
  double x_of(int column) const { return (column - half_ + 0.37) * step_; }
  double y_of(int row) const { return (row - half_ + 0.41) * step_; }

  int at(int column, int row) const { return felt_[static_cast<std::size_t>(row * side_ + column)]; }
  void lay(int number, double radius);
  double rim(int patch) const { return laid_[static_cast<std::size_t>(patch)].size.rim; }
  bool is_on(int patch, glm::dvec2 place) const;
  /// The last place of a patch on the way from one of its own to one beyond, to a micrometre.
  glm::dvec2 edge_of(int patch, glm::dvec2 within, glm::dvec2 beyond) const;
  /// The narrowest way found between two patches, along x or y: from a place of `one` to a later one of `other`.
  struct Gap {
    int one = 0, other = 0;
    glm::dvec2 of_one{0}, of_other{0};
    double width = HUGE_VAL;  // m
  };
  /// The way over nothing between two places, along x or y, m; infinite where a place is not of its patch.
  double gap_between(int one, int other, glm::dvec2 of_one, glm::dvec2 of_other) const;
  /// The narrowest such way within a square to either side, where the tip of a shape may be.
  double gap_beside(const Gap& gap) const;
  /// Calls visit(here, there, squares between, last place of the one, first place of the other) for each two patches
  /// that follow each other in a row to the right, or in a column upwards.
  template <class Visit>
  void each_way(const Visit& visit) const;

  const std::vector<LaidPatch>& laid_;
  double radius_;    // m
  double step_;      // m
  int half_, side_;  // squares
  std::vector<int> felt_;
  std::vector<long> covered_, seen_;  // squares of each patch
};

}  // namespace wale
