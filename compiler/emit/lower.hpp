#pragma once

#include <array>
#include <optional>
#include <vector>

#include "compiler/graph/graph.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

/// A solved material as values of its program: what `emit` makes sections of.
struct LoweredMaterial {
  struct Percept {
    NodeId amplitude, magnitude, level;
  };
  struct State {
    NodeId initial, next;
  };
  struct Write {
    NodeId u, v, value;
  };
  Graph graph;
  std::array<NodeId, 2> force{};    ///< each a final limit at its ceiling; on a pad amplitude and frequency
  std::array<NodeId, 2> ceiling{};  ///< the device's force, or its acceleration and its greatest frequency
  std::optional<NodeId> relief;
  std::optional<std::array<NodeId, 3>> colour;
  std::vector<State> states;               ///< beside `SolvedMaterial::states`
  std::vector<Write> writes;               ///< beside `SolvedMaterial::writes`
  std::vector<std::vector<NodeId>> marks;  ///< operands, beside `SolvedMaterial::marks`
  std::vector<Percept> percepts;           ///< beside `SolvedMaterial::percepts`
};

/// Turns terms into single-assignment values: constants folded, equal values shared, gradients written out.
LoweredMaterial lower(const SolvedMaterial& material);

}  // namespace wale
