#include "compiler/read/fourier.hpp"

#include <kiss_fft.h>

#include <algorithm>
#include <memory>

namespace wale {
namespace {

/// A plan for lines of one length.
class LineTransform {
 public:
  LineTransform(std::size_t count, bool back)
      : plan_(kiss_fft_alloc(static_cast<int>(count), back, nullptr, nullptr), &kiss_fft_free) {}

  void operator()(const std::complex<float>* from, std::complex<float>* to) const {
    // Both libraries store a complex number as two consecutive floats.
    kiss_fft(plan_.get(), reinterpret_cast<const kiss_fft_cpx*>(from), reinterpret_cast<kiss_fft_cpx*>(to));
  }

 private:
  std::unique_ptr<kiss_fft_state, decltype(&kiss_fft_free)> plan_;
};

/// Most lines of a slow field are empty, and their transform is zero.
bool is_empty(std::span<const std::complex<float>> line) {
  return std::ranges::all_of(line, [](const std::complex<float>& value) { return value == 0.0f; });
}

/// Transposes a matrix of `side` * `side` values, a block at a time, which stays in the cache.
Spectrum transposed(std::size_t side, const Spectrum& values) {
  constexpr std::size_t block = 16;
  Spectrum result(values.size());
  for (std::size_t row = 0; row < side; row += block)
    for (std::size_t column = 0; column < side; column += block)
      for (std::size_t i = row; i < std::min(row + block, side); ++i)
        for (std::size_t j = column; j < std::min(column + block, side); ++j)
          result[j * side + i] = values[i * side + j];
  return result;
}

Spectrum transformed_lines(const LineTransform& transform, std::size_t count,
                           std::span<const std::complex<float>> values) {
  Spectrum result(values.size());
  for (std::size_t first = 0; first + count <= values.size(); first += count)
    if (!is_empty(values.subspan(first, count))) transform(values.data() + first, result.data() + first);
  return result;
}

Spectrum transformed_square(std::size_t side, std::span<const std::complex<float>> values, bool back) {
  const LineTransform transform(side, back);
  const Spectrum columns = transposed(side, transformed_lines(transform, side, values));
  return transposed(side, transformed_lines(transform, side, columns));
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

Spectrum fourier_of_lines(std::size_t count, std::span<const std::complex<float>> values) {
  return transformed_lines(LineTransform(count, false), count, values);
}

Spectrum fourier_of_line(std::span<const std::complex<float>> values) {
  return fourier_of_lines(values.size(), values);
}

}  // namespace wale
