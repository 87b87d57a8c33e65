#pragma once

#include <array>
#include <optional>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/graph/graph.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

/// A solved material as the values of its program, which `emit` sorts into sections.
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
  std::array<NodeId, 2> force{};    ///< each limited at its ceiling; on a pad the amplitude and the frequency
  std::array<NodeId, 2> ceiling{};  ///< the device's force, or its acceleration and its highest frequency
  std::optional<NodeId> relief;
  std::optional<std::array<NodeId, 3>> colour;
  std::vector<State> states;               ///< in the order of `SolvedMaterial::states`
  std::vector<Write> writes;               ///< in the order of `SolvedMaterial::writes`
  std::vector<std::vector<NodeId>> marks;  ///< operands, in the order of `SolvedMaterial::marks`
  bool flat = false;                       ///< a texture without slope: a peak of 0 at every parameter
  std::vector<Percept> percepts;           ///< in the order of `SolvedMaterial::percepts`
};

/// Turns terms into single-assignment values: folds constants, shares equal values and writes out gradients. The only
/// error is that it takes too much work, which is reported; the result is fit for `emit` only without one.
LoweredMaterial lower(const SolvedMaterial& material, Diagnostics& diagnostics);

}  // namespace wale
