#include "compiler/read/window_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/fourier.hpp"

namespace wale {
namespace {

constexpr double cells_a_period = 2.5;  // at least, for a wave that a window's cells resolve

constexpr double least_peak = 0.012;  // of the mean square: less is no harmonic of a wave that counts

/// The share of an amplitude that is left when places lie anywhere in their cells.
double left_by_chance(double periods_a_cell) {
  const double angle = std::numbers::pi * periods_a_cell;
  return angle == 0 ? 1 : std::sin(angle) / angle;
}

}  // namespace

std::vector<float> hann_window(std::size_t count) {
  std::vector<float> window(count);
  for (std::size_t i = 0; i < count; ++i)
    window[i] = static_cast<float>(
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count)));
  return window;
}

WindowSpectrum::WindowSpectrum(const StillForces& window, std::span<const glm::dvec2> forces)
    : side_(window.side), size_(window.size), shares_(side_ * (side_ / 2 + 1)) {
  finest_ = cells_a_period * std::max(window.cell().x, window.cell().y);
  const LinearForce trend = linear_force(window.places, forces);
  Spectrum values(side_ * side_);
  double whole = 0;
  const std::vector<float> fade = hann_window(side_);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const glm::dvec2 force = double{fade[i % side_] * fade[i / side_]} * (forces[i] - trend.at(window.places[i]));
    values[i] = {static_cast<float>(force.x), static_cast<float>(force.y)};
    whole += glm::dot(force, force);
  }
  if (!(whole > 0)) return;
  const Spectrum spectrum = fourier(side_, values);
  const auto count = static_cast<double>(side_ * side_);
  const auto wavy = [&](std::size_t column, std::size_t row) {
    return glm::dvec2(periods_over(side_, column), periods_over(side_, row));
  };
  // The waves at the corners are as strong as chance makes them; half of all chances are below ln 2 of the mean, and a
  // mean over two components and two images is nearly symmetrical.
  std::vector<double> corners;
  const double fine = 0.5 * static_cast<double>(side_) * 0.9;
  for (std::size_t row = 0; row <= side_ / 2; ++row)
    for (std::size_t column = 0; column < side_; ++column) {
      const std::size_t at = row * side_ + column;
      const std::size_t mirror = (side_ - row) % side_ * side_ + (side_ - column) % side_;
      // In the transform of x + i y, a coefficient and its mirror image together hold those of x and of y.
      const double power =
          (std::norm(spectrum[at]) + std::norm(spectrum[mirror])) / (whole * count) * (at == mirror ? 0.5 : 1);
      const glm::dvec2 periods = wavy(column, row);
      if (glm::dot(periods, periods) > fine * fine) corners.push_back(power);
      if ((row == 0 || 2 * row == side_) && 2 * column > side_) continue;  // the image of one that was visited
      shares_[at] = power;
    }
  const auto middle = corners.begin() + static_cast<std::ptrdiff_t>(corners.size() / 2);
  std::ranges::nth_element(corners, middle);
  const double noise = *middle / 0.84;
  std::vector<double> left(side_);  // of an amplitude, along one axis
  for (std::size_t i = 0; i < side_; ++i) left[i] = left_by_chance(periods_over(side_, i) / static_cast<double>(side_));
  double resolved = 0;
  for (std::size_t row = 0; row <= side_ / 2; ++row)
    for (std::size_t column = 0; column < side_; ++column) {
      double& share = shares_[row * side_ + column];
      const glm::dvec2 waves = wavy(column, row) / size_;
      const double both = left[row] * left[column];
      const bool seen = glm::dot(waves, waves) * finest_ * finest_ <= 1;
      share = seen ? std::max(0.0, share - noise) / (both * both) : 0;
      resolved += share;
    }
  // Chance leaves as much above the noise as below it; only the sum is without that.
  finer_ = std::clamp(noise * count / 2, 0.0, 1.0);
  const double scale = resolved > 0 ? (1 - finer_) / resolved : 0;
  for (double& share : shares_) share *= scale;
}

std::vector<glm::dvec2> WindowSpectrum::peaks(std::size_t most, double fewest_periods) const {
  std::vector<double> left = shares_;
  std::vector<glm::dvec2> found;
  const auto side = static_cast<std::ptrdiff_t>(side_);
  const auto slow = std::min(side_ / 2, static_cast<std::size_t>(fewest_periods) + 1);
  for (std::size_t row = 0; row <= slow; ++row)
    for (std::size_t column = 0; column < side_; ++column)
      if (glm::length(glm::dvec2(periods_over(side_, column), periods_over(side_, row))) < fewest_periods)
        left[row * side_ + column] = 0;
  while (found.size() < most) {
    const auto peak = std::ranges::max_element(left);
    if (!(*peak > 0)) break;
    const auto at = peak - left.begin();
    const std::ptrdiff_t row = at / side, column = at % side;
    // The top of a peak between waves, from the centre of its power.
    double sum = 0;
    glm::dvec2 centre{0};
    for (std::ptrdiff_t down = -2; down <= 2; ++down)
      for (std::ptrdiff_t right = -2; right <= 2; ++right) {
        std::ptrdiff_t r = row + down, c = (column + right + side) % side;
        if (r < 0) r = -r, c = (side - c) % side;
        if (r > side / 2) continue;
        double& power = left[static_cast<std::size_t>(r * side + c)];
        if (std::abs(down) < 2 && std::abs(right) < 2)
          sum += power, centre += power * glm::dvec2(static_cast<double>(right), static_cast<double>(down));
        power = 0;
        if (r == 0) left[static_cast<std::size_t>((side - c) % side)] = 0;
      }
    const glm::dvec2 periods{periods_over(side_, static_cast<std::size_t>(column)), static_cast<double>(row)};
    if (sum < least_peak) break;
    found.push_back((periods + centre / sum) / size_);
  }
  return found;
}

void WindowSpectrum::each(const std::function<void(glm::dvec2, double)>& visit) const {
  for (std::size_t row = 0; row <= side_ / 2; ++row)
    for (std::size_t column = 0; column < side_; ++column)
      if (const double share = shares_[row * side_ + column]; share > 0)
        visit(glm::dvec2(periods_over(side_, column), periods_over(side_, row)) / size_, share);
}

}  // namespace wale
