#pragma once

#include "compiler/extract/force_field.hpp"
#include "compiler/extract/fourier.hpp"
#include "compiler/extract/period_band.hpp"

namespace wale {

/// One wave of a texture.
struct WaveComponent {
  glm::dvec2 waves{0};  ///< periods over a metre along x and y
  double share = 0;     ///< 0 .. 1: of the power of all that is in the band
};

/// What waves a square field is made of, seen through a window that fades to its edges (Hann's), within a band of
/// periods. Powers are of both components of the force together, on a scale of their own.
class BandSpectrum {
 public:
  BandSpectrum(const ForceField& field, const PeriodBand& band);

  std::size_t side() const { return side_; }
  glm::dvec2 extent() const { return extent_; }  ///< m, of the field
  /// Periods over a metre of coefficient (column, row).
  glm::dvec2 waves(std::size_t column, std::size_t row) const {
    return glm::dvec2(periods_over(side_, column), periods_over(side_, row)) / extent_;
  }
  /// Of coefficient row * side + column, as much as the band lets through.
  const std::vector<float>& power() const { return power_; }
  double whole_power() const { return whole_; }
  /// The share of the field's amplitude that the band lets through, of what is not slower than it.
  double share_of_amplitude() const;

  /// Sums over the band: of power times the cosine and the sine of twice the direction of its waves. Their length over
  /// the whole power is 0 where all directions are alike and 1 where there is but one.
  glm::dvec2 directions() const { return directions_; }
  /// The mean square number of periods over a metre along a direction (of length 1).
  double mean_square_waves(glm::dvec2 direction) const;

  /// At most `most` waves, the strongest first, each with at least this share of the power. Empty without power.
  std::vector<WaveComponent> components(std::size_t most, double least_share) const;

 private:
  float unlimited_at(std::ptrdiff_t column, std::ptrdiff_t row) const;
  /// Where between two coefficients the top of a peak lies, in coefficients.
  double off_peak(double before, double at, double after) const;

  std::size_t side_;
  glm::dvec2 extent_;
  std::vector<float> unlimited_, power_;
  double whole_ = 0, fast_ = 0;
  glm::dvec2 directions_{0};
};

/// Hann's window over `count` samples, so that a wave that does not fit a whole number of times stays in its place.
std::vector<float> hann_window(std::size_t count);

}  // namespace wale
