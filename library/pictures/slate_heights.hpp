#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace wale {

/// The heights of slate.png: a cleft face of slate, computed and not photographed.
///
/// Uses only sums, products and floors of doubles and integers, so that every machine makes the same pixels.
class SlateHeights {
 public:
  static constexpr int side = 256;  ///< pixels; at 0.5 mm each, a tile of 128 mm

  /// Row-major from the top left, 0 lowest, 65535 highest. The steps run upright, across the motion of a hand that rubs
  /// sideways.
  static std::vector<std::uint16_t> draw() {
    std::vector<double> heights;
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column) heights.push_back(height(row, column));
    double low = heights.front(), high = low;
    for (const double each : heights) low = each < low ? each : low, high = each > high ? each : high;
    std::vector<std::uint16_t> pixels;
    for (const double each : heights)
      pixels.push_back(static_cast<std::uint16_t>(std::floor((each - low) / (high - low) * 65535 + 0.5)));
    return pixels;
  }

 private:
  /// Layers of stone that break off along ragged edges, with a grain on their faces.
  static double height(double x, double y) {
    const double lean = 0.55 * x + y;
    const double leaves = lean / 75 + 2.2 * fractal(x / 80, lean / 46, 4, 10);
    const double leaf = std::floor(leaves), edge = (leaves - leaf - 0.86) / 0.14;
    const double step = edge <= 0 ? 0 : eased(edge);
    const double grain = fractal((x + 0.4 * y) / 12, y / 5, 2, 20);
    return 0.5 * (leaf + step - lean / 75) + 1.1 * grain;
  }

  /// A sum of smooth noises: each octave is half as wide and half as high as the one before.
  static double fractal(double x, double y, std::uint32_t octaves, std::uint32_t layer) {
    double sum = 0, size = 0.5;
    for (std::uint32_t octave = 0; octave < octaves; ++octave) {
      sum += size * noise(x, y, layer + octave);
      x = 2 * x + 0.37, y = 2 * y + 0.71, size /= 2;
    }
    return sum;
  }

  /// Smooth noise from 0 to 1, with hills about as wide as the lattice's cells.
  static double noise(double x, double y, std::uint32_t layer) {
    const double column = std::floor(x), row = std::floor(y);
    const double u = eased(x - column), v = eased(y - row);
    const auto at = [&](int i, int j) {
      return hashed(static_cast<std::uint32_t>(static_cast<int>(column) + i + 1000),
                    static_cast<std::uint32_t>(static_cast<int>(row) + j + 1000), layer);
    };
    const double upper = at(0, 0) + u * (at(1, 0) - at(0, 0)), lower = at(0, 1) + u * (at(1, 1) - at(0, 1));
    return upper + v * (lower - upper);
  }

  static double eased(double t) { return t * t * t * (10 + t * (6 * t - 15)); }

  /// A pseudorandom number in [0, 1) for a point of the lattice.
  static double hashed(std::uint32_t column, std::uint32_t row, std::uint32_t layer) {
    std::uint32_t bits = column * 0x9e3779b1u ^ row * 0x85ebca77u ^ layer * 0xc2b2ae3du;
    bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
    bits = (bits ^ bits >> 12) * 0x297a2d39u;
    return (bits ^ bits >> 15) / 4294967295.0;
  }
};

}  // namespace wale
