#include "compiler/extract/fourier.hpp"

#include <kiss_fftnd.h>

#include <array>
#include <memory>

namespace wale {
namespace {

using Complexes = std::vector<std::complex<float>>;

Complexes transformed(std::size_t side, std::span<const std::complex<float>> values, bool back) {
  const std::array<int, 2> sides{static_cast<int>(side), static_cast<int>(side)};
  const std::unique_ptr<kiss_fftnd_state, decltype(&kiss_fft_free)> plan(
      kiss_fftnd_alloc(sides.data(), 2, back, nullptr, nullptr), &kiss_fft_free);
  Complexes result(values.size());
  // A complex number is two floats one after the other in either library.
  kiss_fftnd(plan.get(), reinterpret_cast<const kiss_fft_cpx*>(values.data()),
             reinterpret_cast<kiss_fft_cpx*>(result.data()));
  return result;
}

}  // namespace

Complexes fourier(std::size_t side, std::span<const std::complex<float>> values) {
  return transformed(side, values, false);
}

Complexes inverse_fourier(std::size_t side, std::span<const std::complex<float>> coefficients) {
  Complexes values = transformed(side, coefficients, true);
  for (auto& value : values) value /= static_cast<float>(side * side);
  return values;
}

}  // namespace wale
