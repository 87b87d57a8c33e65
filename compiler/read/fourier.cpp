#include "compiler/read/fourier.hpp"

#include <kiss_fft.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace wale {
namespace {

/// A plan for lines of one length.
class LineTransform {
 public:
  explicit LineTransform(std::size_t count)
      : plan_(kiss_fft_alloc(static_cast<int>(count), 0, nullptr, nullptr), &kiss_fft_free) {}

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

Spectrum transformed_lines(const LineTransform& transform, std::size_t count,
                           std::span<const std::complex<float>> values) {
  Spectrum result(values.size());
  for (std::size_t first = 0; first + count <= values.size(); first += count)
    if (!is_empty(values.subspan(first, count))) transform(values.data() + first, result.data() + first);
  return result;
}

using Lanes = float __attribute__((vector_size(16)));
constexpr std::size_t columns_at_once = sizeof(Lanes) / sizeof(float);  // that are transformed side by side
struct ComplexLanes {
  Lanes real, imaginary;
};
ComplexLanes operator+(const ComplexLanes& a, const ComplexLanes& b) {
  return {a.real + b.real, a.imaginary + b.imaginary};
}
ComplexLanes operator-(const ComplexLanes& a, const ComplexLanes& b) {
  return {a.real - b.real, a.imaginary - b.imaginary};
}
ComplexLanes operator*(const ComplexLanes& a, const std::complex<float>& b) {
  return {a.real * b.real() - a.imaginary * b.imag(), a.real * b.imag() + a.imaginary * b.real()};
}
/// Times minus the imaginary unit.
ComplexLanes turned_back(const ComplexLanes& a) { return {a.imaginary, -a.real}; }

/// The roots of one, exp(-2 pi i k / count).
Spectrum roots_of_one(std::size_t count) {
  Spectrum roots(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
    roots[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return roots;
}

/// The factors of a length, fours first.
std::vector<std::size_t> radices_of(std::size_t count) {
  std::vector<std::size_t> radices;
  for (; count % 4 == 0; count /= 4) radices.push_back(4);
  for (std::size_t radix = 2; count > 1; ++radix)
    for (; count % radix == 0; count /= radix) radices.push_back(radix);
  return radices;
}

/// One stage of Stockham's transform, which leaves the values in their order. `length` values are still together, each
/// `apart` from the next.
void transform_stage(std::size_t radix, std::size_t length, std::size_t apart, const Spectrum& roots,
                     const ComplexLanes* from, ComplexLanes* to) {
  const std::size_t part = length / radix, step = apart * part;  // from one of the values that are joined to the next
  for (std::size_t j = 0; j < part; ++j)
    for (std::size_t q = 0; q < apart; ++q) {
      const ComplexLanes* const in = from + q + apart * j;
      ComplexLanes* const out = to + q + apart * radix * j;
      const auto turn = [&](std::size_t k) { return roots[apart * j * k]; };
      if (radix == 2) {
        out[0] = in[0] + in[step];
        out[apart] = (in[0] - in[step]) * turn(1);
      } else if (radix == 4) {
        const ComplexLanes even = in[0] + in[2 * step], odd = in[step] + in[3 * step];
        const ComplexLanes across = in[0] - in[2 * step], back = turned_back(in[step] - in[3 * step]);
        out[0] = even + odd;
        out[apart] = (across + back) * turn(1);
        out[2 * apart] = (even - odd) * turn(2);
        out[3 * apart] = (across - back) * turn(3);
      } else {
        for (std::size_t k = 0; k < radix; ++k) {
          ComplexLanes sum = in[0];
          for (std::size_t i = 1; i < radix; ++i) sum = sum + in[i * step] * roots[i * k % radix * step];
          out[k * apart] = sum * turn(k);
        }
      }
    }
}

/// Transforms all columns of a square and transposes it.
Spectrum transformed_columns(std::size_t side, std::span<const std::complex<float>> values) {
  Spectrum result(values.size());
  const Spectrum roots = roots_of_one(side);
  const std::vector<std::size_t> radices = radices_of(side);
  std::vector<ComplexLanes> from(side), to(side);
  for (std::size_t first = 0; first < side; first += columns_at_once) {
    const std::size_t columns = std::min(columns_at_once, side - first);
    for (std::size_t row = 0; row < side; ++row)
      for (std::size_t i = 0; i < columns; ++i) {
        const std::complex<float> value = values[row * side + first + i];
        from[row].real[i] = value.real(), from[row].imaginary[i] = value.imag();
      }
    std::size_t length = side;
    for (const std::size_t radix : radices) {
      transform_stage(radix, length, side / length, roots, from.data(), to.data());
      std::swap(from, to), length /= radix;
    }
    for (std::size_t i = 0; i < columns; ++i)
      for (std::size_t row = 0; row < side; ++row)
        result[(first + i) * side + row] = {from[row].real[i], from[row].imaginary[i]};
  }
  return result;
}

}  // namespace

Spectrum fourier(std::size_t side, std::span<const std::complex<float>> values) {
  return transformed_columns(side, transformed_columns(side, values));
}

Spectrum inverse_fourier(std::size_t side, std::span<const std::complex<float>> coefficients) {
  Spectrum values(coefficients.size());
  std::ranges::transform(coefficients, values.begin(), [](std::complex<float> each) { return std::conj(each); });
  values = fourier(side, values);
  const float scale = 1 / static_cast<float>(side * side);
  for (auto& value : values) value = scale * std::conj(value);
  return values;
}

Spectrum fourier_of_lines(std::size_t count, std::span<const std::complex<float>> values) {
  return transformed_lines(LineTransform(count), count, values);
}

Spectrum fourier_of_line(std::span<const std::complex<float>> values) {
  return fourier_of_lines(values.size(), values);
}

}  // namespace wale
