#pragma once

#include <array>
#include <map>
#include <vector>

#include "compiler/solve/solve.hpp"
#include "runtime/machine/spline.hpp"

/// A solved material worked out term by term in 32-bit floats, one operation after the other, for one hand at a time.
/// Knows nothing of graphs, sharing, sections, registers and instructions; used by nothing but tests, which hold the
/// machine to its every bit.
namespace wale::reference {

/// What a tick is asked about, in the order of their input registers: position, velocity, ... (`Input`).
using FloatInputs = std::array<float, 32>;

/// A material that runs, tick by tick.
class FloatSimulation {
 public:
  /// The material outlives it. `parameters` lie in their ranges; `inputs` hold patch and period.
  FloatSimulation(const SolvedMaterial& material, std::vector<float> parameters, const FloatInputs& inputs);

  /// Memories begin anew, as when the program is placed.
  void place();
  /// The hand has come in: states begin.
  void enter(const FloatInputs& hand);
  /// The force on a hand, x and y; then states and memories go on.
  std::array<float, 2> tick(const FloatInputs& hand);

  const std::vector<float>& states() const { return states_; }
  /// Of all memories in their order, each row by row from the lower left.
  const std::vector<float>& cells() const { return cells_; }

 private:
  friend class FloatEvaluation;

  const SolvedMaterial& material_;
  std::vector<float> parameters_;
  FloatInputs patch_;
  std::vector<Spline> splines_;           ///< by table
  std::vector<std::size_t> first_cells_;  ///< by memory
  std::vector<float> states_, initial_states_, cells_;
  std::map<TermId, float> peaks_;  ///< worked out once: they change with parameters and patch only
};

}  // namespace wale::reference
