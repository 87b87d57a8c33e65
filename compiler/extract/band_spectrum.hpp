#pragma once

#include "compiler/extract/force_field.hpp"
#include "compiler/extract/fourier.hpp"
#include "compiler/extract/period_band.hpp"

namespace wale {

/// One wave of a texture.
struct WaveComponent {
  glm::dvec2 waves{0};  ///< periods over a metre along x and y
  double share = 0;     ///< 0 .. 1: of the whole power in the band
};

/// The waves of a square field within a band of periods, seen through Hann's window, which fades to the field's edges.
/// Powers are those of both components of the force together, in arbitrary units.
class BandSpectrum {
 public:
  BandSpectrum(const ForceField& field, const PeriodBand& band);

  std::size_t side() const { return side_; }
  glm::dvec2 extent() const { return extent_; }  ///< m, of the field
  /// Periods over a metre of coefficient (column, row).
  glm::dvec2 waves(std::size_t column, std::size_t row) const {
    return glm::dvec2(periods_over(side_, column), periods_over(side_, row)) / extent_;
  }
  /// The power of coefficient row * side + column, weighted by the band.
  const std::vector<float>& power() const { return power_; }
  double whole_power() const { return whole_; }
  /// The share of the field's amplitude that is in the band, compared with all frequencies at or above its lower end.
  double share_of_amplitude() const;

  /// Sums over the band of power times the cosine and the sine of twice the wave's direction. The length of this vector
  /// over the whole power is 0 if all directions are alike and 1 if there is only one.
  glm::dvec2 directions() const { return directions_; }
  /// The mean square number of periods over a metre along a direction (of length 1).
  double mean_square_waves(glm::dvec2 direction) const;

  /// At most `most` waves, strongest first, each with at least this share of the power. Empty if there is no power.
  std::vector<WaveComponent> components(std::size_t most, double least_share) const;

 private:
  float unlimited_at(std::ptrdiff_t column, std::ptrdiff_t row) const;
  /// The position of a peak's top between two coefficients, in coefficients.
  double off_peak(double before, double at, double after) const;

  std::size_t side_;
  glm::dvec2 extent_;
  std::vector<float> unlimited_, power_;
  double whole_ = 0, fast_ = 0;
  glm::dvec2 directions_{0};
};

/// Hann's window over `count` samples. It keeps a wave that does not fit a whole number of times from spreading.
std::vector<float> hann_window(std::size_t count);

}  // namespace wale
