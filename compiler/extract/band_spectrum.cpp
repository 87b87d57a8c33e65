#include "compiler/extract/band_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

namespace wale {
namespace {

/// Waves whose strength differs by rounding only are ordered by direction, those along x first, so that rounding does
/// not choose among them.
constexpr float as_strong_as = 0.9999f;
constexpr std::ptrdiff_t reach_of_peak = 2;  // the window spreads one wave over so many coefficients on either side

}  // namespace

std::vector<float> hann_window(std::size_t count) {
  std::vector<float> window(count);
  for (std::size_t i = 0; i < count; ++i)
    window[i] = static_cast<float>(
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count)));
  return window;
}

BandSpectrum::BandSpectrum(const ForceField& field, const PeriodBand& band)
    : side_(field.side), extent_(field.extent()), unlimited_(side_ * side_), power_(side_ * side_) {
  const std::vector<float> window = hann_window(side_);
  Spectrum values = as_complex(without(field, linear_part(field)).forces);
  for (std::size_t row = 0; row < side_; ++row)
    for (std::size_t column = 0; column < side_; ++column) values[row * side_ + column] *= window[row] * window[column];
  const Spectrum spectrum = fourier(side_, values);
  const auto size = [](std::complex<float> value) { return value.real() * value.real() + value.imag() * value.imag(); };
  const double fastest = 1 / (band.low * band.low);
  std::vector<double> right(side_);
  for (std::size_t column = 0; column < side_; ++column) right[column] = periods_over(side_, column) / extent_.x;
  // The two halves of a transform are mirror images, and so are their powers.
  for (std::size_t row = 0; row <= side_ / 2; ++row) {
    const double down = periods_over(side_, row) / extent_.y;
    for (std::size_t column = 0; column < side_; ++column) {
      // In the transform of x + i y, a coefficient and its mirror image together hold those of x and of y.
      const std::size_t at = row * side_ + column;
      const std::size_t mirror = (side_ - row) % side_ * side_ + (side_ - column) % side_;
      const float here = 0.5f * (size(spectrum[at]) + size(spectrum[mirror]));
      unlimited_[at] = unlimited_[mirror] = here;
      const double squared = right[column] * right[column] + down * down;
      const double share = share_let_through(band, squared);
      const double through = here * share * share;
      power_[at] = power_[mirror] = static_cast<float>(through);
      const double count = row == 0 || 2 * row == side_ ? 1 : 2;  // these lines occur twice in the whole
      if (squared > fastest) fast_ += count * (here - through);
      if (through <= 0) continue;
      whole_ += count * through;
      directions_ +=
          count * through / squared * glm::dvec2(right[column] * right[column] - down * down, 2 * right[column] * down);
    }
  }
}

double BandSpectrum::share_of_amplitude() const {
  return whole_ + fast_ > 0 ? std::sqrt(whole_ / (whole_ + fast_)) : 0;
}

double BandSpectrum::mean_square_waves(glm::dvec2 direction) const {
  double sum = 0;
  for (std::size_t row = 0; row < side_; ++row) {
    const double down = periods_over(side_, row) / extent_.y * direction.y;
    for (std::size_t column = 0; column < side_; ++column) {
      const float power = power_[row * side_ + column];
      if (power <= 0) continue;
      const double along = periods_over(side_, column) / extent_.x * direction.x + down;
      sum += power * along * along;
    }
  }
  return sum / whole_;
}

float BandSpectrum::unlimited_at(std::ptrdiff_t column, std::ptrdiff_t row) const {
  const auto side = static_cast<std::ptrdiff_t>(side_);
  return unlimited_[static_cast<std::size_t>((row + side) % side * side + (column + side) % side)];
}

double BandSpectrum::off_peak(double before, double at, double after) const {
  // Under Hann's window, let r be the ratio in amplitude of the larger neighbour to a wave's strongest coefficient. The
  // wave then lies (2 r - 1) / (1 + r) coefficients further on: Grandke 1983, IEEE Trans. Instrum. Meas. 32(2).
  const double ratio = std::sqrt(std::max(before, after) / at);
  const double off = std::clamp((2 * ratio - 1) / (1 + ratio), 0.0, 0.5);
  return after > before ? off : -off;
}

std::vector<WaveComponent> BandSpectrum::components(std::size_t most, double least_share) const {
  std::vector<WaveComponent> found;
  if (whole_ <= 0) return found;
  // One of two coefficients that are mirror images is enough.
  const std::size_t half = side_ / 2 + 1;
  std::vector<float> left(half * side_);
  for (std::size_t row = 0; row < side_; ++row)
    std::copy_n(power_.begin() + static_cast<std::ptrdiff_t>(row * side_), half,
                left.begin() + static_cast<std::ptrdiff_t>(row * half));
  const auto rows = static_cast<std::ptrdiff_t>(side_), columns = static_cast<std::ptrdiff_t>(half);
  const auto at = [&](std::ptrdiff_t column, std::ptrdiff_t row) -> float& {
    if (column < 0) column = -column, row = -row;
    return left[static_cast<std::size_t>((row % rows + rows) % rows * columns + std::min(column, columns - 1))];
  };
  while (found.size() < most) {
    const float least = as_strong_as * *std::ranges::max_element(left);
    std::ptrdiff_t column = columns, row = 0;
    for (std::ptrdiff_t i = 0; column == columns; ++i) {
      row = (rows - i) % rows;
      const float* line = left.data() + row * columns;
      column = std::find_if(line, line + columns, [&](float power) { return power >= least; }) - line;
    }
    if (at(column, row) <= 0) break;
    double sum = 0;
    for (std::ptrdiff_t down = -reach_of_peak; down <= reach_of_peak; ++down)
      for (std::ptrdiff_t right = -reach_of_peak; right <= reach_of_peak; ++right) {
        sum += std::exchange(at(column + right, row + down), 0.0f);
        // Lines with zero periods across hold both images.
        if (column + right == 0) at(0, -row - down) = 0;
      }
    WaveComponent component;
    component.share = std::min(1.0, 2 * sum / whole_);
    if (!found.empty() && component.share < least_share) break;
    const glm::dvec2 off{
        off_peak(unlimited_at(column - 1, row), unlimited_at(column, row), unlimited_at(column + 1, row)),
        off_peak(unlimited_at(column, row - 1), unlimited_at(column, row), unlimited_at(column, row + 1))};
    component.waves = waves(static_cast<std::size_t>(column), static_cast<std::size_t>(row)) + off / extent_;
    found.push_back(component);
  }
  return found;
}

}  // namespace wale
