#pragma once

#include <optional>

#include "compiler/read/relief.hpp"

namespace wale {

/// What the hand meets of a wave through an encoder that tells its place in steps of `count` (m) along x and along y.
/// Nothing if the encoder follows the wave: it has at least two counts in each period along either axis. Otherwise the
/// wave on the lattice of the encoder's places is the same as a longer one, whose period and direction are returned:
/// the wave vector less the nearest whole numbers of waves to the count. The period is infinite if all places are
/// alike.
std::optional<ReliefWave> encoder_pattern(const ReliefWave& wave, double count);

}  // namespace wale
