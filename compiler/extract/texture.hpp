#pragma once

#include <vector>

#include "compiler/extract/period_band.hpp"
#include "compiler/extract/static_force.hpp"

namespace wale {

/// One wave of a texture.
struct TextureWave {
  double period = 0;       ///< m
  double orientation = 0;  ///< rad from the x axis, in [0, pi): the direction in which it changes
  double share = 0;        ///< 0 .. 1: of the mean square of the force
};

/// The texture of a program's static force within a band of periods, over the patch without its rim.
struct TextureForce {
  double amplitude = 0;    ///< N: the 99th percentile of its size, as the amplitude of a lateral force is defined
  double maximum = 0;      ///< N: the definition of Minsky 1995, the largest force found
  double rms = 0;          ///< N
  double mean = 0;         ///< N: the mean of its size
  double transitions = 0;  ///< 1/m: sign changes along the strongest component
  /// m: the period of the strongest component, or the distance after which the texture repeats if that component is a
  /// harmonic or crosses another; 0 without a texture
  double period = 0;
  double orientation = 0;  ///< rad from the x axis, in [0, pi): the direction in which it changes
  double anisotropy = 0;   ///< 0: the same in every direction; 1: in one direction only
  double regularity = 0;   ///< 0 .. 1: the share of it that repeats
  double steepness = 0;    ///< 1/m: the 99th percentile of its change with position, over its amplitude
  /// The dominant waves, strongest first, each with at least a tenth of the mean square; none is a multiple of another.
  std::vector<TextureWave> waves;

  /// Whether it repeats, so that it has a period; otherwise it is a noise with a grain of about that size.
  bool regular() const { return amplitude > 0 && regularity >= 0.5; }
  /// Whether it changes mostly in one direction, so that this direction has a meaning.
  bool oriented() const { return amplitude > 0 && anisotropy >= 0.5; }
};

/// Reads the texture with periods within the band. Slower forces, such as springs and hills, and faster ones are no
/// texture; the band fades in within a fifth of a period at its ends. There is no texture if the amplitude is below
/// `least` (N).
TextureForce texture_force(const Bank& bank, const StaticForce& force, const PeriodBand& band, double least = 0);

}  // namespace wale
