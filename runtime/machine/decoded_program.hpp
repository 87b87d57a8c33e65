#pragma once

#include <vector>

#include "runtime/machine/block_code.hpp"
#include "runtime/machine/spline.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// A verified program made ready: what `Program` points to.
///
/// One lane runs `description`'s flat instructions as they are; blocks of lanes run code of their own.
struct DecodedProgram {
  explicit DecodedProgram(PatchProgram verified);

  PatchProgram description;
  std::vector<Spline> splines;  ///< one for each table
  BlockCode tick, picture;
  std::vector<BlockCode> peaks;
  RegisterNumber force_x = 0, force_y = 0;  ///< the output registers
};

}  // namespace wale
