#pragma once

#include <array>
#include <map>
#include <vector>

#include "compiler/solve/solve.hpp"
#include "runtime/machine/spline.hpp"

/// Evaluates a solved material term by term in 32-bit floats, one operation after the other, for one hand at a time. It
/// does not use graphs, sharing, sections, registers or instructions. Only tests use it, and compare the machine with
/// it bit for bit.
namespace wale::reference {

/// The inputs of a tick, in the order of the input registers: position, velocity, ... (`Input`).
using FloatInputs = std::array<float, 32>;

/// Runs a material tick by tick.
class FloatSimulation {
 public:
  /// The material must outlive the object. `parameters` must be in their ranges. `inputs` hold patch and period.
  FloatSimulation(const SolvedMaterial& material, std::vector<float> parameters, const FloatInputs& inputs);

  /// Resets the memories, as when the program is placed.
  void place();
  /// The hand enters the patch: resets the states.
  void enter(const FloatInputs& hand);
  /// Returns the force on a hand, x and y, then advances states and memories.
  std::array<float, 2> tick(const FloatInputs& hand);

  const std::vector<float>& states() const { return states_; }
  /// The cells of all memories in order, each row by row from the lower left.
  const std::vector<float>& cells() const { return cells_; }

 private:
  friend class FloatEvaluation;

  const SolvedMaterial& material_;
  std::vector<float> parameters_;
  FloatInputs patch_;
  std::vector<Spline> splines_;           ///< by table
  std::vector<std::size_t> first_cells_;  ///< by memory
  std::vector<float> states_, initial_states_, cells_;
  std::map<TermId, float> peaks_;  ///< computed once: they change only with parameters and patch
};

}  // namespace wale::reference
