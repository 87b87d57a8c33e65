#pragma once

#include <vector>

#include "compiler/extract/period_band.hpp"
#include "compiler/extract/static_force.hpp"

namespace wale {

/// One of the waves that a texture is made of.
struct TextureWave {
  double period = 0;       ///< m
  double orientation = 0;  ///< rad from the x axis, in [0, pi): the direction in which it changes
  double share = 0;        ///< 0 .. 1: of the mean square of the force
};

/// What the static force of a program shows within a band of periods, over the patch less its rim.
struct TextureForce {
  double amplitude = 0;    ///< N: the 99th percentile of its size, as a lateral force's amplitude is defined
  double maximum = 0;      ///< N: the thesis's own, the largest that is found
  double rms = 0;          ///< N
  double mean = 0;         ///< N: of its size
  double transitions = 0;  ///< 1/m: how often it changes its sign along the strongest component
  /// m: of the strongest component, or the distance after which all comes back where that is a harmonic of it or
  /// crosses another; 0 without a texture
  double period = 0;
  double orientation = 0;  ///< rad from the x axis, in [0, pi): the direction in which it changes
  double anisotropy = 0;   ///< 0 the same in every direction .. 1 in one alone
  double regularity = 0;   ///< 0 .. 1: the share of it that comes back some way on
  double steepness = 0;    ///< 1/m: the 99th percentile of how it changes with place, over its amplitude
  /// The dominant ones, the strongest first, each with at least a tenth of the mean square; no multiples of one
  /// another.
  std::vector<TextureWave> waves;

  /// It comes back, so that its period can be told: otherwise it is a noise with a grain of about that size.
  bool regular() const { return amplitude > 0 && regularity >= 0.5; }
  /// It changes mostly in one direction, so that this can be told.
  bool oriented() const { return amplitude > 0 && anisotropy >= 0.5; }
};

/// Reads the texture whose periods lie within the band. What is slower, springs and hills, and what is faster counts
/// as no texture; at the band's ends components are let in gradually, within a fifth of their period. Nothing where its
/// amplitude is below `least` (N).
TextureForce texture_force(const Bank& bank, const StaticForce& force, const PeriodBand& band, double least = 0);

}  // namespace wale
