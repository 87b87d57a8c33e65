#include "compiler/extract/fourier.hpp"

#include <kiss_fftnd.h>

#include <array>
#include <memory>

namespace wale {
namespace {

Spectrum transformed(std::span<const int> sides, std::span<const std::complex<float>> values, bool back) {
  const std::unique_ptr<kiss_fftnd_state, decltype(&kiss_fft_free)> plan(
      kiss_fftnd_alloc(sides.data(), static_cast<int>(sides.size()), back, nullptr, nullptr), &kiss_fft_free);
  Spectrum result(values.size());
  // A complex number is two floats one after the other in either library.
  kiss_fftnd(plan.get(), reinterpret_cast<const kiss_fft_cpx*>(values.data()),
             reinterpret_cast<kiss_fft_cpx*>(result.data()));
  return result;
}

Spectrum transformed_square(std::size_t side, std::span<const std::complex<float>> values, bool back) {
  const std::array<int, 2> sides{static_cast<int>(side), static_cast<int>(side)};
  return transformed(sides, values, back);
}

}  // namespace

Spectrum fourier(std::size_t side, std::span<const std::complex<float>> values) {
  return transformed_square(side, values, false);
}

Spectrum inverse_fourier(std::size_t side, std::span<const std::complex<float>> coefficients) {
  Spectrum values = transformed_square(side, coefficients, true);
  const float scale = 1 / static_cast<float>(side * side);
  for (auto& value : values) value *= scale;
  return values;
}

Spectrum fourier_of_line(std::span<const std::complex<float>> values) {
  const int count = static_cast<int>(values.size());
  return transformed({&count, 1}, values, false);
}

}  // namespace wale
