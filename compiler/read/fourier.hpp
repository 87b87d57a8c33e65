#pragma once

#include <complex>
#include <span>
#include <vector>

namespace wale {

using Spectrum = std::vector<std::complex<float>>;

/// The discrete Fourier transform of `side` * `side` complex values, row by row, without a scale factor. Coefficient
/// (u, v) is at v * side + u and belongs to u and v periods over the sides; indices above side / 2 stand for u - side
/// and v - side. Two real fields can be transformed as one complex field.
Spectrum fourier(std::size_t side, std::span<const std::complex<float>> values);

/// The inverse transform.
Spectrum inverse_fourier(std::size_t side, std::span<const std::complex<float>> coefficients);

/// The transforms of consecutive lines of `count` values each.
Spectrum fourier_of_lines(std::size_t count, std::span<const std::complex<float>> values);

/// The transform of a line of values.
Spectrum fourier_of_line(std::span<const std::complex<float>> values);

/// The signed number of periods over `side` samples of coefficient `index`.
inline double periods_over(std::size_t side, std::size_t index) {
  return static_cast<double>(index) - (index <= side / 2 ? 0.0 : static_cast<double>(side));
}

}  // namespace wale
