#include "runtime/machine/peak.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wale {
namespace {

/// Coordinate number `i` of a Kronecker lattice of the given step: 2 u - 1, rounded once, where u is
/// (i step mod 2^32) / 2^32.
float lattice_coordinate(std::uint32_t i, std::uint32_t step) {
  const auto centred = static_cast<std::int32_t>(i * step ^ 0x80000000u);  // 2^32 u - 2^31
  return static_cast<float>(centred) * 0x1p-31f;
}

}  // namespace

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void place_lanes(float* x, float* y, std::uint32_t first, float half_width, float half_height) {
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    x[lane] = lattice_coordinate(first + lane, 3242174889u) * half_width;
    y[lane] = lattice_coordinate(first + lane, 2447445414u) * half_height;
  }
}

float value_of_peak(const DecodedProgram& program, std::size_t index, std::span<const float> registers) {
  const Peak& peak = program.description.peaks[index];
  std::vector<float> values(peak.points);
  each_under_peak(program, index, registers, [&](std::size_t point, float value) { values[point] = value; });
  const auto rank = static_cast<std::uint32_t>(std::ceil(peak.percentile * static_cast<float>(peak.points)));
  const auto nth = values.begin() + (std::clamp(rank, 1u, peak.points) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace wale
