#pragma once

#include <array>
#include <vector>

#include "compiler/graph/graph.hpp"
#include "wale/program.hpp"

namespace wale {

/// A program's tick as values again, so that it can be derived: all that the control thread sets up is constant.
struct LiftedTick {
  Graph graph;
  std::array<NodeId, 2> force{};  ///< along x and y, behind its limit
  std::vector<NodeId> next;       ///< what each state becomes, before it is held in its range
};

/// Reads the tick of a verified program with the bank's parameters and patch.
LiftedTick lift(const Bank& bank);

}  // namespace wale
