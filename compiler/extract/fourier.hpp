#pragma once

#include <complex>
#include <span>
#include <vector>

namespace wale {

using Spectrum = std::vector<std::complex<float>>;

/// The discrete Fourier transform of a square of `side` * `side` complex values, row by row, without a scale:
/// coefficient (u, v), at v * side + u, belongs to u and v periods over the sides, those above side / 2 to u - side and
/// v - side. Two real fields go as one complex field.
Spectrum fourier(std::size_t side, std::span<const std::complex<float>> values);

/// Back: the values whose transform is given.
Spectrum inverse_fourier(std::size_t side, std::span<const std::complex<float>> coefficients);

/// The transforms of lines of `count` values, one after the other.
Spectrum fourier_of_lines(std::size_t count, std::span<const std::complex<float>> values);

/// The transform of a line of values.
Spectrum fourier_of_line(std::span<const std::complex<float>> values);

/// The signed number of periods over `side` samples that coefficient `index` belongs to.
inline double periods_over(std::size_t side, std::size_t index) {
  return static_cast<double>(index) - (index <= side / 2 ? 0.0 : static_cast<double>(side));
}

}  // namespace wale
