#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/machine/arithmetic.hpp"

namespace wale {

/// A spline's value, in [0, 1] except for overshoot, and its derivatives along each coordinate, per sample.
struct SplineSample {
  float value, along_a, along_b;
};

/// A coordinate brought into the table by mirroring.
struct MirroredCoordinate {
  std::uint32_t cell;  ///< 0 .. the last sample's number
  float fraction;      ///< within the cell
  float sign;          ///< of the derivative: -1 where the mirror image runs backwards
};

/// `coordinate` mirrored into 0 .. `last`, the last sample's number. Takes any float: not-a-number and infinities
/// count as 0, and far beyond the table the position has the float's own resolution.
inline MirroredCoordinate mirrored(float coordinate, float last) {
  const float period = last + last;
  const float image =
      coordinate - floor_of(arithmetic::quotient(coordinate, period)) * period;  // [0, period], rounding aside
  const float folded = image > last ? period - image : image;
  const float inside = absolute(folded);
  const float least = inside > 0.0f ? inside : 0.0f;  // not-a-number gives 0
  const float u = least < last ? least : last;
  const auto cell = static_cast<std::uint32_t>(static_cast<std::int32_t>(u));
  const bool backwards = (image > last) != (folded < 0.0f);
  return {cell, u - static_cast<float>(cell), backwards ? -1.0f : 1.0f};
}

/// The four weights of a uniform cubic B-spline at `f` in [0, 1], and their derivatives.
struct CubicWeights {
  explicit CubicWeights(float f) {
    const float g = 1.0f - f;
    using arithmetic::product;
    value[0] = g * g * g * (1.0f / 6.0f);
    value[1] = f * f * (0.5f * f - 1.0f) + 2.0f / 3.0f;
    value[2] = g * g * (0.5f * g - 1.0f) + 2.0f / 3.0f;
    value[3] = product(product(product(f, f), f), 1.0f / 6.0f);
    slope[0] = -0.5f * g * g;
    slope[1] = f * (1.5f * f - 2.0f);
    slope[2] = g * (2.0f - 1.5f * g);
    slope[3] = product(product(0.5f, f), f);
  }
  float value[4], slope[4];
};

/// The weighted sum over four by four coefficients; `coefficient` gives them by row and column.
template <class Coefficient>
SplineSample sample_among(const Coefficient& coefficient, const CubicWeights& across, const CubicWeights& down) {
  float value = 0.0f, along_a = 0.0f, along_b = 0.0f;
  // No loop over rows: compilers vectorise the loop over lanes only if there is none inside.
  const auto add_row = [&](int j) {
    const float c0 = coefficient(j, 0), c1 = coefficient(j, 1), c2 = coefficient(j, 2), c3 = coefficient(j, 3);
    using namespace arithmetic;
    const auto weighted = [&](const float(&weights)[4]) {
      return sum(sum(product(weights[0], c0), product(weights[1], c1)),
                 sum(product(weights[2], c2), product(weights[3], c3)));
    };
    const float row_value = weighted(across.value), row_slope = weighted(across.slope);
    value = sum(value, product(down.value[j], row_value));
    along_a = sum(along_a, product(down.value[j], row_slope));
    along_b = sum(along_b, product(down.slope[j], row_value));
  };
  add_row(0);
  add_row(1);
  add_row(2);
  add_row(3);
  return {value, along_a, along_b};
}

/// The spline at (a, b): a along rows and b down columns, in samples from the centre of the first sample.
/// `coefficients` are rows of `stride`, one mirrored coefficient before each row and a row of them before the first.
inline SplineSample sample_at(const float* coefficients, std::size_t stride, float last_column, float last_row, float a,
                              float b) {
  const MirroredCoordinate column = mirrored(a, last_column);
  const MirroredCoordinate row = mirrored(b, last_row);
  const float* corner = coefficients + (row.cell * stride + column.cell);
  const SplineSample sample = sample_among(
      [=](int j, int i) { return corner[static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i)]; },
      CubicWeights(column.fraction), CubicWeights(row.fraction));
  return {sample.value, column.sign * sample.along_a, row.sign * sample.along_b};
}

}  // namespace wale
