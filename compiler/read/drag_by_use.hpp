#pragma once

#include <vector>

#include "compiler/read/strokes.hpp"

namespace wale {

/// How the resistance to a hand at 0.2 m/s changes as it goes to and fro over one place.
struct DragByUse {
  bool changes = false;
  double first = 0, last = 0;  ///< N: over the first way to and fro, and over the last
  double way = 0;              ///< m: so far the hand has gone
};

/// On one of the strokes along an axis. Nothing of a program that only remembers time or nothing, or in which something
/// goes by time.
DragByUse drag_by_use(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside);

}  // namespace wale
