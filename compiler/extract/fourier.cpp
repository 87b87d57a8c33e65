#include "compiler/extract/fourier.hpp"

#include <kiss_fft.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

namespace wale {
namespace {

/// Four lines side by side, which every processor that this is built for has instructions for.
using FourFloats [[gnu::vector_size(16)]] = float;
using FourBits [[gnu::vector_size(16)]] = std::int32_t;

struct FourComplex {
  FourFloats re, im;
};

inline FourComplex operator+(FourComplex a, FourComplex b) { return {a.re + b.re, a.im + b.im}; }
inline FourComplex operator-(FourComplex a, FourComplex b) { return {a.re - b.re, a.im - b.im}; }
inline FourComplex operator*(FourComplex a, std::complex<float> by) {
  return {a.re * by.real() - a.im * by.imag(), a.re * by.imag() + a.im * by.real()};
}

/// The transform of many lines of one length at once, by as many stages as that has factors: Stockham's, which leave
/// everything in its order (Van Loan 1992, Computational frameworks for the fast Fourier transform, section 1.7).
class LineTransform {
 public:
  LineTransform(std::size_t count, bool back) : count_(count), turn_(back ? 1.0f : -1.0f), roots_(count) {
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
      roots_[i] = {static_cast<float>(std::cos(angle)), turn_ * static_cast<float>(std::sin(angle))};
    }
    for (const std::size_t factor : {std::size_t{4}, std::size_t{2}, std::size_t{3}})
      for (; count % factor == 0; count /= factor) factors_.push_back(factor);
    for (std::size_t factor = 5; count > 1; factor += 2)
      for (; count % factor == 0; count /= factor) factors_.push_back(factor);
  }

  /// Lines in groups of four, value `i` of group `g` at i * groups + g. `room` is as large and left as it happens to
  /// be.
  void run(std::vector<FourComplex>& values, std::vector<FourComplex>& room, std::size_t groups) const {
    std::size_t left = count_, side_by_side = groups;
    for (const std::size_t factor : factors_) {
      const Stage stage{left / factor, side_by_side, values.data(), room.data()};
      switch (factor) {
        case 2: halve(stage); break;
        case 3: divide_by_three(stage); break;
        case 4: quarter(stage); break;
        default: divide(stage, factor);
      }
      values.swap(room);
      left /= factor, side_by_side *= factor;
    }
  }

 private:
  /// Every `parts` values of a stage become one, of as many that lie side by side.
  struct Stage {
    std::size_t parts, side_by_side;
    const FourComplex* from;
    FourComplex* to;
  };

  /// The root that belongs to result number `result` of part `part`, of `parts` * `factor` values.
  std::complex<float> root(std::size_t part, std::size_t result, std::size_t values) const {
    return roots_[part * result % values * (count_ / values)];
  }
  /// By the imaginary unit, forth or back.
  FourComplex turned(FourComplex a) const { return {-turn_ * a.im, turn_ * a.re}; }

  void halve(const Stage& stage) const {
    const auto [parts, beside, from, to] = stage;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::complex<float> one = root(part, 1, 2 * parts);
      const FourComplex *a = from + part * beside, *b = a + parts * beside;
      FourComplex *sum = to + 2 * part * beside, *difference = sum + beside;
      for (std::size_t i = 0; i < beside; ++i) sum[i] = a[i] + b[i], difference[i] = (a[i] - b[i]) * one;
    }
  }

  void divide_by_three(const Stage& stage) const {
    const auto [parts, beside, from, to] = stage;
    const float height = 0.5f * std::numbers::sqrt3_v<float>;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::complex<float> one = root(part, 1, 3 * parts), two = root(part, 2, 3 * parts);
      const FourComplex *a = from + part * beside, *b = a + parts * beside, *c = b + parts * beside;
      FourComplex* result = to + 3 * part * beside;
      for (std::size_t i = 0; i < beside; ++i) {
        const FourComplex sum = b[i] + c[i], middle = a[i] + sum * -0.5f, aside = turned((b[i] - c[i]) * height);
        result[i] = a[i] + sum;
        result[i + beside] = (middle + aside) * one;
        result[i + 2 * beside] = (middle - aside) * two;
      }
    }
  }

  void quarter(const Stage& stage) const {
    const auto [parts, beside, from, to] = stage;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::complex<float> one = root(part, 1, 4 * parts), two = root(part, 2, 4 * parts),
                                three = root(part, 3, 4 * parts);
      const FourComplex *a = from + part * beside, *b = a + parts * beside, *c = b + parts * beside,
                        *d = c + parts * beside;
      FourComplex* result = to + 4 * part * beside;
      for (std::size_t i = 0; i < beside; ++i) {
        const FourComplex even = a[i] + c[i], odd = b[i] + d[i], across = a[i] - c[i], aside = turned(b[i] - d[i]);
        result[i] = even + odd;
        result[i + beside] = (across + aside) * one;
        result[i + 2 * beside] = (even - odd) * two;
        result[i + 3 * beside] = (across - aside) * three;
      }
    }
  }

  /// By any factor, as the sum is written.
  void divide(const Stage& stage, std::size_t factor) const {
    const auto [parts, beside, from, to] = stage;
    for (std::size_t part = 0; part < parts; ++part)
      for (std::size_t result = 0; result < factor; ++result) {
        const std::complex<float> turn = root(part, result, factor * parts);
        for (std::size_t i = 0; i < beside; ++i) {
          FourComplex sum = from[part * beside + i];
          for (std::size_t j = 1; j < factor; ++j)
            sum = sum + from[(part + j * parts) * beside + i] * root(j, result, factor);
          to[(factor * part + result) * beside + i] = sum * turn;
        }
      }
  }

  friend FourComplex operator*(FourComplex a, float by) { return {a.re * by, a.im * by}; }

  std::size_t count_;
  float turn_;  ///< -1 forth, 1 back: the sign of the angles
  std::vector<std::complex<float>> roots_;
  std::vector<std::size_t> factors_;
};

/// Lines that are transformed at once: what they need stays in the cache.
constexpr std::size_t groups_at_once = 4, lines_at_once = 4 * groups_at_once;

/// Transforms lines of `side` values. Value `i` of line `k` is at `i * apart_in_line + k * apart` of both.
void transform_lines(const LineTransform& transform, std::size_t side, std::size_t lines,
                     const std::complex<float>* from, std::complex<float>* to, std::size_t apart_in_line,
                     std::size_t apart) {
  std::vector<FourComplex> values(side * groups_at_once), room(side * groups_at_once);
  for (std::size_t first = 0; first < lines; first += lines_at_once) {
    const std::size_t count = std::min(lines_at_once, lines - first);
    // Groups are filled with the last line.
    const auto line = [&](std::size_t number) { return (first + std::min(number, count - 1)) * apart; };
    FourBits any{};
    for (std::size_t group = 0; group < groups_at_once; ++group) {
      const std::complex<float>*a = from + line(4 * group), *b = from + line(4 * group + 1),
            *c = from + line(4 * group + 2), *d = from + line(4 * group + 3);
      for (std::size_t i = 0, at = 0; i < side; ++i, at += apart_in_line) {
        const FourFloats re{a[at].real(), b[at].real(), c[at].real(), d[at].real()};
        const FourFloats im{a[at].imag(), b[at].imag(), c[at].imag(), d[at].imag()};
        any |= reinterpret_cast<FourBits>(re) | reinterpret_cast<FourBits>(im);
        values[i * groups_at_once + group] = {re, im};
      }
    }
    // Of nothing nothing comes: of what is slow most lines are empty.
    if ((any[0] | any[1] | any[2] | any[3]) != 0) transform.run(values, room, groups_at_once);
    for (std::size_t group = 0; 4 * group < count; ++group)
      for (std::size_t i = 0; i < side; ++i) {
        const FourComplex& found = values[i * groups_at_once + group];
        for (std::size_t k = 0; k < std::min<std::size_t>(4, count - 4 * group); ++k)
          to[i * apart_in_line + line(4 * group + k)] = {found.re[k], found.im[k]};
      }
  }
}

Spectrum transformed_square(std::size_t side, std::span<const std::complex<float>> values, bool back) {
  const LineTransform transform(side, back);
  Spectrum result(values.size());
  transform_lines(transform, side, side, values.data(), result.data(), side, 1);
  transform_lines(transform, side, side, result.data(), result.data(), 1, side);
  return result;
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
  Spectrum result(values.size());
  transform_lines(LineTransform(count, false), count, values.size() / count, values.data(), result.data(), 1, count);
  return result;
}

Spectrum fourier_of_line(std::span<const std::complex<float>> values) {
  const std::unique_ptr<kiss_fft_state, decltype(&kiss_fft_free)> plan(
      kiss_fft_alloc(static_cast<int>(values.size()), false, nullptr, nullptr), &kiss_fft_free);
  Spectrum result(values.size());
  // A complex number is two floats one after the other in either library.
  kiss_fft(plan.get(), reinterpret_cast<const kiss_fft_cpx*>(values.data()),
           reinterpret_cast<kiss_fft_cpx*>(result.data()));
  return result;
}

}  // namespace wale
