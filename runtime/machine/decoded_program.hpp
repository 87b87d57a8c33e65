#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "runtime/machine/block_code.hpp"
#include "runtime/machine/grid.hpp"
#include "runtime/machine/held_state.hpp"
#include "runtime/machine/inputs.hpp"
#include "runtime/machine/shared_maps.hpp"
#include "runtime/machine/spline.hpp"
#include "runtime/machine/threaded_code.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// A verified program made ready: what `Program` points to.
///
/// What runs at the device's rate is decoded twice, for one lane and for blocks of lanes; setup and predictions run
/// `description`'s instructions as they are.
struct DecodedProgram {
  explicit DecodedProgram(PatchProgram verified);

  PatchProgram description;
  std::vector<std::shared_ptr<const SharedMap>> maps;         ///< one for each table
  std::vector<std::reference_wrapper<const Spline>> splines;  ///< theirs
  std::vector<GridShape> grids;                               ///< one for each grid
  std::vector<float> initial_cells;                           ///< of all grids, as they are when the program is placed
  Envelope envelope;
  std::vector<Input> tick_inputs;  ///< that change from tick to tick and are read by tick, enter or what follows them
  HandReader hand_reader;          ///< of these
  ThreadedCode lane_enter, lane_tick, lane_frame;
  BlockCode enter, tick, picture;
  std::vector<BlockCode> peaks;
  RegisterNumber force_x = 0, force_y = 0;  ///< the output registers
  RegisterNumber first_state = 0;
  std::vector<StateRule> state_rules;
  std::vector<WriteRule> write_rules;

  LaneLookups lookups(const float* cells) const { return {splines.data(), grids.data(), cells}; }
};

}  // namespace wale
