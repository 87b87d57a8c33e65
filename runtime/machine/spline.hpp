#pragma once

#include <cstdint>
#include <vector>

#include "runtime/machine/arithmetic.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// A height table as the coefficients of the cubic B-spline that passes through its samples (code 65535 is 1),
/// continued beyond its edges by mirroring about the first and last samples.
///
/// Coefficients are computed in double and kept as float, row by row; the spline is within 3e-7 of each sample.
/// Coefficients of 16 bits would leave 2e-5, more than a step of the table's own codes, and gain no speed: at a random
/// place of a map larger than the cache the four rows are fetched at once, and tiles of four by four take as long.
struct Spline {
  explicit Spline(const HeightTable& table);

  std::uint32_t width, height;      ///< samples, 2 or more
  float last_column, last_row;      ///< numbers of the last samples, width - 1 and height - 1
  std::uint32_t stride;             ///< coefficients in a row, width + 3: mirrored ones, one before and two after
  std::vector<float> coefficients;  ///< height + 3 rows, mirrored likewise
};

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
  const float image = coordinate - floor_of(coordinate / period) * period;  // [0, period], rounding aside
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
    value[0] = g * g * g * (1.0f / 6.0f);
    value[1] = f * f * (0.5f * f - 1.0f) + 2.0f / 3.0f;
    value[2] = g * g * (0.5f * g - 1.0f) + 2.0f / 3.0f;
    value[3] = f * f * f * (1.0f / 6.0f);
    slope[0] = -0.5f * g * g;
    slope[1] = f * (1.5f * f - 2.0f);
    slope[2] = g * (2.0f - 1.5f * g);
    slope[3] = 0.5f * f * f;
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
    const float row_value =
        (across.value[0] * c0 + across.value[1] * c1) + (across.value[2] * c2 + across.value[3] * c3);
    const float row_slope =
        (across.slope[0] * c0 + across.slope[1] * c1) + (across.slope[2] * c2 + across.slope[3] * c3);
    value += down.value[j] * row_value;
    along_a += down.value[j] * row_slope;
    along_b += down.slope[j] * row_value;
  };
  add_row(0);
  add_row(1);
  add_row(2);
  add_row(3);
  return {value, along_a, along_b};
}

/// The spline at (a, b): a along rows and b down columns, in samples from the centre of the first sample.
inline SplineSample sample_of(const Spline& spline, float a, float b) {
  const MirroredCoordinate column = mirrored(a, spline.last_column);
  const MirroredCoordinate row = mirrored(b, spline.last_row);
  const std::size_t stride = spline.stride;
  const float* corner = spline.coefficients.data() + (row.cell * stride + column.cell);
  const SplineSample sample = sample_among(
      [=](int j, int i) { return corner[static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i)]; },
      CubicWeights(column.fraction), CubicWeights(row.fraction));
  return {sample.value, column.sign * sample.along_a, row.sign * sample.along_b};
}

}  // namespace wale
