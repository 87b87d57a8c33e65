#pragma once

#include "compiler/extract/force_field.hpp"

namespace wale {

/// Spatial periods, m.
struct PeriodBand {
  double low = 0, high = 0;
};

/// What the static force of a program shows within a band of periods, over the patch less its rim.
struct TextureForce {
  double amplitude = 0;    ///< N: the 99th percentile of its size, as a lateral force's amplitude is defined
  double maximum = 0;      ///< N: the thesis's own, the largest that is found
  double rms = 0;          ///< N
  double mean = 0;         ///< N: of its size
  double transitions = 0;  ///< 1/m: how often it changes its sign along the strongest component
  double period = 0;       ///< m: of the strongest component; 0 without a texture
  double orientation = 0;  ///< rad from the x axis, in [0, pi): the direction in which it changes
  double anisotropy = 0;   ///< 0 the same in every direction .. 1 in one alone
  double regularity = 0;   ///< 0 .. 1: the share of it that comes back after a period, along that direction
  double steepness = 0;    ///< 1/m: the 99th percentile of how it changes with place, over its amplitude
};

/// Static forces at two scales: over the whole patch, and where its texture is strongest.
struct StaticForce {
  ForceField whole, close;
  LinearField slope;  ///< of `whole`

  explicit StaticForce(const Bank& bank);
};

/// Reads the texture whose periods lie within the band. What is slower, springs and hills, and what is faster counts
/// as no texture; at the band's ends components are let in gradually, within a fifth of their period.
TextureForce texture_force(const Bank& bank, const StaticForce& force, const PeriodBand& band);

}  // namespace wale
