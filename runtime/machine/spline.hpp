#pragma once

#include <cstdint>
#include <vector>

#include "runtime/machine/spline_sample.hpp"
#include "wale/patch_program.hpp"

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

/// The spline at (a, b): a along rows and b down columns, in samples from the centre of the first sample.
inline SplineSample sample_of(const Spline& spline, float a, float b) {
  return sample_at(spline.coefficients.data(), spline.stride, spline.last_column, spline.last_row, a, b);
}

}  // namespace wale
