#include "runtime/machine/spline.hpp"

#include <algorithm>
#include <span>

namespace wale {
namespace {

/// The pole of the cubic B-spline's inverse filter, sqrt(3) - 2.
constexpr double pole = -0.26794919243112270647;
/// The pole's 30th power is 7e-18: samples farther away do not reach a double.
constexpr std::size_t horizon = 30;

/// Turns samples into B-spline coefficients in place (Unser, Aldroubi and Eden 1993, "B-spline signal processing"),
/// with the signal mirrored about its first and last sample.
void to_coefficients(std::span<double> line) {
  const std::size_t last = line.size() - 1;
  const std::size_t period = 2 * last;
  const auto mirrored_sample = [&](std::size_t i) {
    const std::size_t within = i % period;
    return line[within > last ? period - within : within];
  };
  double first = 0, power = 1;
  for (std::size_t i = 0; i < horizon; ++i, power *= pole) first += power * mirrored_sample(i);
  line[0] = first;
  for (std::size_t i = 1; i <= last; ++i) line[i] += pole * line[i - 1];
  line[last] = pole / (pole * pole - 1) * (line[last] + pole * line[last - 1]);
  for (std::size_t i = last; i-- > 0;) line[i] = pole * (line[i + 1] - line[i]);
  for (double& coefficient : line) coefficient *= 6;
}

/// Where coefficient `i`, -1 .. samples + 1, stands among 0 .. samples - 1.
std::size_t mirrored_index(std::ptrdiff_t i, std::ptrdiff_t samples) {
  const std::ptrdiff_t period = 2 * (samples - 1);
  const std::ptrdiff_t within = (i + period) % period;
  return static_cast<std::size_t>(within < samples ? within : period - within);
}

}  // namespace

Spline::Spline(const HeightTable& table)
    : width(table.width),
      height(table.height),
      stride(table.width + 3),
      coefficients(static_cast<std::size_t>(stride) * (table.height + 3)) {
  const auto row = [&](std::size_t j) { return coefficients.data() + (j + 1) * stride + 1; };

  std::vector<double> line(width);
  for (std::size_t j = 0; j < height; ++j) {
    for (std::size_t i = 0; i < width; ++i) line[i] = table.heights[j * width + i] / 65535.0;
    to_coefficients(line);
    std::transform(line.begin(), line.end(), row(j), [](double c) { return static_cast<float>(c); });
  }
  line.resize(height);
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t j = 0; j < height; ++j) line[j] = row(j)[i];
    to_coefficients(line);
    for (std::size_t j = 0; j < height; ++j) row(j)[i] = static_cast<float>(line[j]);
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
