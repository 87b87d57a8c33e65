#pragma once

#include "wale/record.hpp"

namespace wale {

/// The part of a force that a texture makes as the hand moves over it: what is faster than the hand's own motion.
struct TextureForce {
  double size = 0;       ///< N, the 99th percentile of its magnitude
  double rms = 0;        ///< N
  double frequency = 0;  ///< Hz, of a sine with the same root mean square and the same mean rate of change
};

/// What a presentation did to the hand.
struct FeltSize {
  TextureForce interaction;  ///< of the force between hand and handle, through the handle's mass and friction
  TextureForce actuator;
  double speed = 0;          ///< m/s, root mean square of the hand's
  bool interaction_known = false;
};

/// Measures a record without its first half second, over the ticks within a patch. All zero if there are none.
FeltSize felt_size(const Record& record);

}  // namespace wale
