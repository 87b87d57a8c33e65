#pragma once

#include "compiler/extract/band_spectrum.hpp"

namespace wale {

/// How regular a texture is whose strongest wave has so many periods over a metre along x and y, 0 .. 1: the largest
/// share of it that is found again somewhere further on than half a wave. 1 of what is strictly periodic in one
/// direction or more, however its waves are divided; little of noise.
double regularity(const BandSpectrum& spectrum, glm::dvec2 strongest);

/// The distance after which a regular texture comes back, m: that of its strongest wave, or longer where this is a
/// harmonic or crosses another. `components` are those of the spectrum, at least one; the band holds no period that is
/// too short for the samples.
double repetition(const BandSpectrum& spectrum, const std::vector<WaveComponent>& components);

}  // namespace wale
