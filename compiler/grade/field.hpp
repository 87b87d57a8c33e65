#pragma once

#include <span>
#include <vector>

#include "compiler/graph/graph.hpp"
#include "runtime/machine/block_code.hpp"
#include "wale/program.hpp"

namespace wale {

/// Computes some values of a lifted tick for many hands, by the machine's own blocks of lanes.
class LiftedField {
 public:
  /// `roots` are the nodes of `graph` to compute; `graph` was lifted from the bank's program. Check `fits` before use.
  LiftedField(const Graph& graph, std::span<const NodeId> roots, const Bank& bank);

  /// Whether the machine has enough registers; otherwise `evaluate` must not be called.
  bool fits() const { return fits_; }

  /// Writes `values[root * hands.size() + hand]`. `states` has the program's states for each hand, hand by hand; it is
  /// empty for a program without states. Memories have their initial values. Uses all cores; the values do not depend
  /// on their number.
  void evaluate(std::span<const Hand> hands, std::span<const float> states, std::vector<float>& values);

 private:
  /// Evaluates the hands of blocks `begin` .. `end` - 1.
  void evaluate_blocks(std::size_t begin, std::size_t end, std::span<const Hand> hands, std::span<const float> states,
                       std::vector<float>& values) const;

  Program program_;      ///< owner of the splines and grids
  PatchProgram layout_;  ///< layout of the registers that the code below uses
  std::vector<RegisterNumber> roots_;
  std::vector<float> registers_;  ///< initial values, the same for all lanes
  std::vector<Input> inputs_;     ///< those that the code reads
  BlockCode code_;
  long cost_ = 0;  ///< cost of the code for one hand
  bool fits_ = false;
};

}  // namespace wale
