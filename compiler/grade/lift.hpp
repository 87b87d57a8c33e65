#pragma once

#include <array>
#include <vector>

#include "compiler/graph/graph.hpp"
#include "wale/program.hpp"

namespace wale {

/// A program's tick as a graph of values, so that it can be derived. Everything that the setup computes is constant.
struct LiftedTick {
  Graph graph;
  std::array<NodeId, 2> force{};  ///< along x and y, after its limit
  std::vector<NodeId> next;       ///< new value of each state, before it is limited to its range
};

/// Reads the tick of a verified program with the bank's parameters and patch.
LiftedTick lift(const Bank& bank);

}  // namespace wale
