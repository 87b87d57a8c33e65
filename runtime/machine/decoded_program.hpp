#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "runtime/machine/block_code.hpp"
#include "runtime/machine/grid.hpp"
#include "runtime/machine/held_state.hpp"
#include "runtime/machine/inputs.hpp"
#include "runtime/machine/shared_maps.hpp"
#include "runtime/machine/spline.hpp"
#include "runtime/machine/threaded_code.hpp"
#include "wale/patch_program.hpp"

namespace wale {

struct DecodedProgram;

/// A section's code for blocks of lanes, decoded at the first request. A program that runs only on a device needs no
/// more than the code of its peaks.
class BlockSection {
 public:
  /// `instructions` are a section of the program, which must outlive this.
  BlockSection(const DecodedProgram& program, std::span<const Instruction> instructions)
      : program_(program), instructions_(instructions) {}

  /// From any thread but the real-time one: the first caller decodes, which allocates, and others wait for it.
  const BlockCode& code() const;

 private:
  const DecodedProgram& program_;
  std::span<const Instruction> instructions_;
  mutable std::mutex decoding_;
  mutable std::atomic<bool> is_decoded_ = false;
  mutable BlockCode code_;
};

/// A verified program, ready to run: `Program` points to it.
///
/// Code that runs at the device's rate is decoded for one lane when the program is loaded, and for blocks of lanes when
/// a batch needs it. Setup and predictions run `description`'s instructions as they are.
struct DecodedProgram {
  explicit DecodedProgram(PatchProgram verified);

  PatchProgram description;
  std::vector<std::shared_ptr<const SharedMap>> maps;         ///< one for each table
  std::vector<std::reference_wrapper<const Spline>> splines;  ///< those of `maps`
  std::vector<GridShape> grids;                               ///< one for each grid
  std::vector<float> initial_cells;                           ///< of all grids, for a new memory
  Envelope envelope;
  std::vector<Input> tick_inputs;  ///< those that change from tick to tick and that tick, enter, picture or frame reads
  HandReader hand_reader;          ///< reads `tick_inputs`
  ThreadedCode lane_enter, lane_tick, lane_frame;
  BlockSection enter{*this, description.enter}, tick{*this, description.tick}, picture{*this, description.picture.code};
  std::vector<std::unique_ptr<const BlockSection>> peaks;
  RegisterNumber force_x = 0, force_y = 0;  ///< the output registers
  RegisterNumber first_state = 0;
  std::vector<StateRule> state_rules;
  std::vector<WriteRule> write_rules;

  LaneLookups lookups(const float* cells) const { return {splines.data(), grids.data(), cells}; }
};

}  // namespace wale
