#pragma once

#include <span>
#include <vector>

#include "compiler/graph/graph.hpp"
#include "runtime/machine/block_code.hpp"
#include "wale/program.hpp"

namespace wale {

/// Some values of a lifted tick, worked out for many hands by the machine's own blocks of lanes.
class LiftedField {
 public:
  /// The values of `roots`, any nodes of `graph`, which was lifted from the bank's program. Check `fits` before use.
  LiftedField(const Graph& graph, std::span<const NodeId> roots, const Bank& bank);

  /// Whether the machine has registers enough for what was asked; otherwise nothing can be worked out.
  bool fits() const { return fits_; }

  /// `values[root * hands.size() + hand]`. `states` has the program's states for each hand, hand by hand, or is empty
  /// for a program without any. Grids are as they are at first. Uses all cores; the same values on however many.
  void evaluate(std::span<const Hand> hands, std::span<const float> states, std::vector<float>& values);

 private:
  /// The hands of blocks `begin` .. `end` - 1.
  void evaluate_blocks(std::size_t begin, std::size_t end, std::span<const Hand> hands, std::span<const float> states,
                       std::vector<float>& values) const;

  Program program_;      ///< that the splines and grids belong to
  PatchProgram layout_;  ///< of the registers that the code below uses
  std::vector<RegisterNumber> roots_;
  std::vector<float> registers_;  ///< what is the same for all lanes
  std::vector<Input> inputs_;     ///< that the code reads
  BlockCode code_;
  long cost_ = 0;  ///< of the code for one hand
  bool fits_ = false;
};

}  // namespace wale
