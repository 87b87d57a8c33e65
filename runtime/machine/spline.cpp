#include "runtime/machine/spline.hpp"

#include <algorithm>
#include <span>

namespace wale {
namespace {

/// The pole of the cubic B-spline's inverse filter, sqrt(3) - 2.
constexpr double pole = -0.26794919243112270647;
/// The pole's 30th power is 7e-18, below a double's precision: samples farther away make no difference.
constexpr std::size_t horizon = 30;

/// The number of signals that are filtered side by side: none waits for another, and as columns they fill a cache line.
constexpr std::size_t at_once = 16;

/// Turns samples into B-spline coefficients in place (Unser, Aldroubi and Eden 1993, "B-spline signal processing"),
/// with each signal mirrored about its first and last sample. Sample i of signal k is number i * at_once + k.
void to_coefficients(std::span<double> lines) {
  const std::size_t last = lines.size() / at_once - 1;
  const std::size_t period = 2 * last;
  const auto samples = [&](std::size_t i) { return lines.data() + i * at_once; };
  const auto mirrored_samples = [&](std::size_t i) {
    const std::size_t within = i % period;
    return samples(within > last ? period - within : within);
  };
  double first[at_once] = {};
  double power = 1;
  for (std::size_t i = 0; i < horizon; ++i, power *= pole) {
    const double* const there = mirrored_samples(i);
    for (std::size_t k = 0; k < at_once; ++k) first[k] += power * there[k];
  }
  std::copy_n(first, at_once, samples(0));
  for (std::size_t i = 1; i <= last; ++i) {
    double* const here = samples(i);
    const double* const before = samples(i - 1);
    for (std::size_t k = 0; k < at_once; ++k) here[k] += pole * before[k];
  }
  double* const end = samples(last);
  const double* const before_end = samples(last - 1);
  for (std::size_t k = 0; k < at_once; ++k) end[k] = pole / (pole * pole - 1) * (end[k] + pole * before_end[k]);
  for (std::size_t i = last; i-- > 0;) {
    double* const here = samples(i);
    const double* const after = samples(i + 1);
    for (std::size_t k = 0; k < at_once; ++k) here[k] = pole * (after[k] - here[k]);
  }
  for (double& coefficient : lines) coefficient *= 6;
}

/// `value` rounded to a float, with 0 for subnormal results, so that the thread's mode makes no difference.
float coefficient_of(double value) {
  return value < arithmetic::least_normal && value > -arithmetic::least_normal ? 0.0f : static_cast<float>(value);
}

/// The index of the sample, 0 .. samples - 1, whose coefficient number `i`, -1 .. samples + 1, is by mirroring.
std::size_t mirrored_index(std::ptrdiff_t i, std::ptrdiff_t samples) {
  const std::ptrdiff_t period = 2 * (samples - 1);
  const std::ptrdiff_t within = (i + period) % period;
  return static_cast<std::size_t>(within < samples ? within : period - within);
}

}  // namespace

Spline::Spline(const HeightTable& table)
    : width(table.width),
      height(table.height),
      last_column(static_cast<float>(table.width - 1)),
      last_row(static_cast<float>(table.height - 1)),
      stride(table.width + 3),
      coefficients(static_cast<std::size_t>(stride) * (table.height + 3)) {
  const auto row = [&](std::size_t j) { return coefficients.data() + (j + 1) * stride + 1; };

  const std::uint16_t* const heights = table.heights.data();
  std::vector<double> lines(std::size_t{width} * at_once);
  for (std::size_t first = 0; first < height; first += at_once) {
    const std::size_t count = std::min<std::size_t>(at_once, height - first);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint16_t* const codes = heights + (first + k) * width;
      for (std::size_t i = 0; i < width; ++i) lines[i * at_once + k] = codes[i] / 65535.0;
    }
    to_coefficients(lines);
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t i = 0; i < width; ++i) row(first + k)[i] = coefficient_of(lines[i * at_once + k]);
  }
  lines.assign(std::size_t{height} * at_once, 0.0);
  for (std::size_t first = 0; first < width; first += at_once) {
    const std::size_t count = std::min<std::size_t>(at_once, width - first);
    for (std::size_t j = 0; j < height; ++j) std::copy_n(row(j) + first, count, lines.data() + j * at_once);
    to_coefficients(lines);
    for (std::size_t j = 0; j < height; ++j)
      for (std::size_t k = 0; k < count; ++k) row(j)[first + k] = coefficient_of(lines[j * at_once + k]);
  }

  for (std::size_t j = 0; j < height; ++j) {
    for (const std::ptrdiff_t i : {std::ptrdiff_t{-1}, std::ptrdiff_t{width}, std::ptrdiff_t{width} + 1}) {
      row(j)[i] = row(j)[mirrored_index(i, width)];
    }
  }
  const std::ptrdiff_t rows = height;
  for (const std::ptrdiff_t j : {std::ptrdiff_t{-1}, rows, rows + 1}) {
    const float* from = row(mirrored_index(j, rows)) - 1;
    std::copy(from, from + stride, coefficients.data() + static_cast<std::size_t>(j + 1) * stride);
  }
}

}  // namespace wale
