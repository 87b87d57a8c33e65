#pragma once

#include "compiler/extract/band_spectrum.hpp"

namespace wale {

/// The regularity of a texture, 0 .. 1: the largest share of it that is found again at a distance of more than half a
/// wave. The strongest wave has `waves` periods per metre along x and y. Strictly periodic textures have 1, in one
/// direction or more; noise has little.
double regularity(const BandSpectrum& spectrum, glm::dvec2 strongest);

/// The distance after which a regular texture repeats, m: the period of its strongest wave, or a longer one if this
/// wave is a harmonic or crosses another. `components` are those of the spectrum, at least one; the band holds no
/// period that is too short for the samples.
double repetition(const BandSpectrum& spectrum, const std::vector<WaveComponent>& components);

}  // namespace wale
