#pragma once

#include <string>

#include "compiler/drawing/canvas.hpp"
#include "compiler/preview/felt_spectrum.hpp"

namespace wale {

/// The amplitude of the force over frequency, up to the highest that matters, on a hand that strokes along `way`: "x".
/// `box` is the frame, as for a plot.
void draw_spectrum(Canvas& canvas, const PageBox& box, const FeltSpectrum& spectrum, const std::string& way);

/// The same over the time of the stroke; darker is stronger.
void draw_spectrogram(Canvas& canvas, const PageBox& box, const FeltSpectrum& spectrum);

}  // namespace wale
