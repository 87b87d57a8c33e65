#pragma once

#include "compiler/extract/band_spectrum.hpp"

namespace wale {

/// How far a texture comes back.
struct Repetition {
  /// 0 .. 1: the largest share of it that is found again somewhere further on than half a wave. 1 of what is strictly
  /// periodic in one direction or more, however its waves are divided; little of noise.
  double regularity = 0;
  /// How many waves of its strongest component it takes until it comes back: more than one where that is a harmonic.
  int waves = 1;
};

/// Of the texture in a spectrum, whose strongest component is this one.
Repetition repetition(const BandSpectrum& spectrum, glm::dvec2 strongest);

}  // namespace wale
