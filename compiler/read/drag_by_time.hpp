#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "compiler/read/strokes.hpp"

namespace wale {

/// How the resistance to a hand at 0.2 m/s changes while it goes on for some seconds.
struct DragByTime {
  bool changes = false;
  bool has_mean = false;       ///< the first half of that time has the mean of the second
  double least = 0, most = 0;  ///< N, if it changes
};

/// Of strokes along an axis, then as many across it. Nothing of a program in which nothing goes by time, or with
/// memories over the patch.
DragByTime drag_by_time(const Bank& bank, const std::vector<Stroke>& strokes);

/// As `opposed_on`, but means over the same seconds for all strokes.
std::vector<glm::dvec2> opposed_over_time(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside);

}  // namespace wale
