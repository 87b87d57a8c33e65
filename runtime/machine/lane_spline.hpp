#pragma once

#include <cstring>

#include "runtime/machine/spline.hpp"

namespace wale {

#if defined(__GNUC__)

/// Four floats side by side, each multiplied and added like a single float.
using FourFloats [[gnu::vector_size(16)]] = float;

/// Gives the same bits as `sample_of`, for one lane. It sums over four rows at a time, and does not mirror a place
/// within the table, which the processor predicts.
inline SplineSample sample_in_lane(const Spline& spline, float a, float b) {
  const auto placed = [](float coordinate, float last) -> MirroredCoordinate {
    const float u = absolute(coordinate);
    if (coordinate >= 0.0f && u <= last) [[likely]] {
      const auto cell = static_cast<std::int32_t>(u);
      return {static_cast<std::uint32_t>(cell), u - static_cast<float>(cell), 1.0f};
    }
    return mirrored(coordinate, last);
  };
  const MirroredCoordinate column = placed(a, spline.last_column);
  const MirroredCoordinate row = placed(b, spline.last_row);

  // The weights of `CubicWeights`: along a and b at the fraction f, then along both at 1 - f. By symmetry, the weights
  // of the two samples after the place are those of the two before it at 1 - f.
  const float across = column.fraction, down = row.fraction;
  const FourFloats f = {across, down, 1.0f - across, 1.0f - down};
  const FourFloats f_squared = f * f;
  const FourFloats outer = f_squared * f * (1.0f / 6.0f);
  const FourFloats inner = f_squared * (0.5f * f - 1.0f) + 2.0f / 3.0f;
  const FourFloats outer_slope = FourFloats{0.5f, 0.5f, -0.5f, -0.5f} * f * f;
  const FourFloats inner_slope = f * (FourFloats{1.5f, 1.5f, -1.5f, -1.5f} * f - FourFloats{2.0f, 2.0f, -2.0f, -2.0f});
  const auto of_b = [](FourFloats outside, FourFloats inside) {
    const FourFloats in_pairs = __builtin_shufflevector(outside, inside, 3, 1, 5, 7);
    return __builtin_shufflevector(in_pairs, in_pairs, 0, 2, 3, 1);
  };
  const FourFloats down_value = of_b(outer, inner), down_slope = of_b(outer_slope, inner_slope);

  const std::size_t stride = spline.stride;
  const float* corner = spline.coefficients.data() + (row.cell * stride + column.cell);
  const auto four = [](const float* from) {
    FourFloats read;
    std::memcpy(&read, from, sizeof read);
    return read;
  };
  const FourFloats row0 = four(corner), row1 = four(corner + stride);
  const FourFloats row2 = four(corner + 2 * stride), row3 = four(corner + 3 * stride);
  const FourFloats low01 = __builtin_shufflevector(row0, row1, 0, 4, 1, 5);
  const FourFloats low23 = __builtin_shufflevector(row2, row3, 0, 4, 1, 5);
  const FourFloats high01 = __builtin_shufflevector(row0, row1, 2, 6, 3, 7);
  const FourFloats high23 = __builtin_shufflevector(row2, row3, 2, 6, 3, 7);
  const FourFloats column0 = __builtin_shufflevector(low01, low23, 0, 1, 4, 5);
  const FourFloats column1 = __builtin_shufflevector(low01, low23, 2, 3, 6, 7);
  const FourFloats column2 = __builtin_shufflevector(high01, high23, 0, 1, 4, 5);
  const FourFloats column3 = __builtin_shufflevector(high01, high23, 2, 3, 6, 7);

  // As `sample_among`; each float belongs to a row.
  const FourFloats row_value = (outer[2] * column0 + inner[0] * column1) + (inner[2] * column2 + outer[0] * column3);
  const FourFloats row_slope =
      (outer_slope[2] * column0 + inner_slope[0] * column1) + (inner_slope[2] * column2 + outer_slope[0] * column3);
  const FourFloats value = down_value * row_value, along_a = down_value * row_slope, along_b = down_slope * row_value;
  const FourFloats value_a01 = __builtin_shufflevector(value, along_a, 0, 4, 1, 5);
  const FourFloats value_a23 = __builtin_shufflevector(value, along_a, 2, 6, 3, 7);
  const FourFloats b01 = __builtin_shufflevector(along_b, along_b, 0, 0, 1, 1);
  const FourFloats b23 = __builtin_shufflevector(along_b, along_b, 2, 2, 3, 3);
  FourFloats sum = {0.0f, 0.0f, 0.0f, 0.0f};
  sum += __builtin_shufflevector(value_a01, b01, 0, 1, 4, 5);
  sum += __builtin_shufflevector(value_a01, b01, 2, 3, 6, 7);
  sum += __builtin_shufflevector(value_a23, b23, 0, 1, 4, 5);
  sum += __builtin_shufflevector(value_a23, b23, 2, 3, 6, 7);
  return {sum[0], column.sign * sum[1], row.sign * sum[2]};
}

#else

inline SplineSample sample_in_lane(const Spline& spline, float a, float b) { return sample_of(spline, a, b); }

#endif

}  // namespace wale
