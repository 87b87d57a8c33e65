#pragma once

#include <complex>
#include <span>
#include <vector>

namespace wale {

/// The discrete Fourier transform of a square of `side` * `side` complex values, row by row, without a scale:
/// coefficient (u, v), at v * side + u, belongs to u and v periods over the sides, those above side / 2 to u - side and
/// v - side. Two real fields go as one complex field.
std::vector<std::complex<float>> fourier(std::size_t side, std::span<const std::complex<float>> values);

/// Back: the values whose transform is given.
std::vector<std::complex<float>> inverse_fourier(std::size_t side, std::span<const std::complex<float>> coefficients);

}  // namespace wale
