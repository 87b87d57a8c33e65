#pragma once

#include "compiler/preview/canvas.hpp"
#include "compiler/preview/felt_spectrum.hpp"

namespace wale {

/// The force's amplitude over its frequencies, up to the highest that matters. `box` is the frame, as a plot's is.
void draw_spectrum(Canvas& canvas, const PageBox& box, const FeltSpectrum& spectrum);

/// The same over the time of the stroke: the darker the stronger.
void draw_spectrogram(Canvas& canvas, const PageBox& box, const FeltSpectrum& spectrum);

}  // namespace wale
