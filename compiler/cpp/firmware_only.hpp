#pragma once

#include "compiler/cpp/operations.hpp"
#include "runtime/machine/spline_sample.hpp"

/// What the headers of `wale build --emit cpp` need besides the machine's arithmetic.
namespace wale {

/// A table of heights as the coefficients of its spline, which Wale has computed.
struct SplineTable {
  const float* coefficients;
  std::uint32_t stride;  ///< coefficients in a row
  float last_column, last_row;
};

inline SplineSample sample_of(const SplineTable& table, float a, float b) {
  return sample_at(table.coefficients, table.stride, table.last_column, table.last_row, a, b);
}

/// Coordinate i of a Kronecker lattice in -1 .. 1.
inline float lattice_coordinate(std::uint32_t i, std::uint32_t step) {
  const std::uint32_t turned = (i * step) ^ 0x80000000u;
  return static_cast<float>(static_cast<std::int32_t>(turned)) * 0x1p-31f;
}

/// Value number `rank`, from 1 on, of the values 0 .. `count` - 1 in ascending order. Asks for each value four times
/// and keeps none: a histogram of 256 counts, 1 KiB of stack, finds eight bits of the result at a time. Values that are
/// not finite, and -0, count as 0.
template <class ValueOf>
float ranked_value(std::uint32_t count, std::uint32_t rank, const ValueOf& value_of) {
  // Floats in ascending order have these keys in ascending order.
  const auto key_of = [](float value) {
    const std::uint32_t bits = absolute(value) < arithmetic::infinity ? arithmetic::bits_of(value + 0.0f) : 0;
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
  };
  std::uint32_t found = 0;
  for (int shift = 24; shift >= 0; shift -= 8) {
    std::uint32_t counts[256] = {};
    const std::uint32_t known = shift == 24 ? 0 : 0xffffffffu << (shift + 8);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t key = key_of(value_of(i));
      if ((key & known) == found) ++counts[(key >> shift) & 255u];
    }
    std::uint32_t digit = 0;
    for (; rank > counts[digit]; ++digit) rank -= counts[digit];
    found |= digit << shift;
  }
  return arithmetic::float_of((found & 0x80000000u) != 0 ? found & 0x7fffffffu : ~found);
}

/// A patch's extent, m, as setup reads it.
struct PatchExtent {
  float half_width, half_height, rim;
};

/// A size, corrected: a side that is not positive is the default's, one longer than `most` is `most`; a rim that leaves
/// no middle is a quarter of the smaller side.
inline PatchExtent extent_of(float width, float height, float rim, const PatchExtent& otherwise, float most) {
  const float largest = std::numeric_limits<float>::max();
  const auto side = [&](float asked, float half) {
    const float usable = asked >= 0x1p-125f && asked <= largest ? asked : half + half;
    return most < usable ? most : usable;
  };
  const float w = side(width, otherwise.half_width), h = side(height, otherwise.half_height);
  const float smaller = h < w ? h : w;
  const float usable = rim >= 0.0f && rim <= largest ? rim : otherwise.rim;
  const float held = usable >= 0.5f * smaller ? arithmetic::product(0.25f, smaller) : usable;
  return {0.5f * w, 0.5f * h, arithmetic::flushed(held)};
}

}  // namespace wale
