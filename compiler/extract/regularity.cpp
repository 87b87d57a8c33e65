#include "compiler/extract/regularity.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace wale {
namespace {

constexpr double reach = 0.3;         // of the field's side: so far apart windows still see much in common
constexpr double forgotten = 0.5;     // less agreement than this has been, or it has not begun to change
constexpr int waves_a_period = 8;     // to one period
constexpr double whole_again = 0.95;  // agreement after a period ...
constexpr double not_yet = 0.9;       // ... and less than this before
constexpr double least_power = 1e-4;  // of the strongest coefficient's, that counts where many are summed

/// How well a texture agrees with itself at distances that are whole samples, 1 at none.
class Agreement {
 public:
  explicit Agreement(const BandSpectrum& spectrum) : side_(spectrum.side()), shared_(side_) {
    const std::vector<float>& power = spectrum.power();
    sums_ = inverse_fourier(side_, Spectrum(power.begin(), power.end()));
    // What the windows have in common at a distance, the one that comes in from behind included.
    const std::vector<float> window = hann_window(side_);
    for (std::size_t far = 0; far < side_; ++far)
      for (std::size_t i = 0; i < side_; ++i) shared_[far] += window[i] * window[(i + far) % side_];
  }

  double at(std::ptrdiff_t right, std::ptrdiff_t down) const {
    const auto side = static_cast<std::ptrdiff_t>(side_);
    const auto column = static_cast<std::size_t>((right + side) % side),
               row = static_cast<std::size_t>((down + side) % side);
    const double both = shared_[column] * shared_[row] / (shared_[0] * shared_[0]);
    return sums_[row * side_ + column].real() / sums_.front().real() / both;
  }

  /// At any distance, from the waves themselves: exact, and slow.
  double exactly(const BandSpectrum& spectrum, glm::dvec2 distance) const {
    const std::vector<float>& power = spectrum.power();
    const float least = static_cast<float>(least_power) * *std::ranges::max_element(power);
    const glm::dvec2 metres = distance * spectrum.extent() / static_cast<double>(side_);
    double sum = 0, all = 0;
    for (std::size_t row = 0; row < side_; ++row)
      for (std::size_t column = 0; column < side_; ++column) {
        const double here = power[row * side_ + column];
        if (here < least) continue;
        all += here;
        sum += here * std::cos(2 * std::numbers::pi * glm::dot(spectrum.waves(column, row), metres));
      }
    return sum / all / (common(distance.x) * common(distance.y));
  }

  /// Between samples.
  double between(glm::dvec2 distance) const {
    const glm::dvec2 low = glm::floor(distance), part = distance - low;
    const auto right = static_cast<std::ptrdiff_t>(low.x), down = static_cast<std::ptrdiff_t>(low.y);
    return ((1 - part.x) * at(right, down) + part.x * at(right + 1, down)) * (1 - part.y) +
           ((1 - part.x) * at(right, down + 1) + part.x * at(right + 1, down + 1)) * part.y;
  }

 private:
  double common(double distance) const {
    const double low = std::floor(std::abs(distance)), part = std::abs(distance) - low;
    const auto far = static_cast<std::size_t>(low);
    return ((1 - part) * shared_[far] + part * shared_[far + 1]) / shared_[0];
  }

  std::size_t side_;
  Spectrum sums_;
  std::vector<double> shared_;
};

}  // namespace

Repetition repetition(const BandSpectrum& spectrum, glm::dvec2 strongest) {
  Repetition found;
  const Agreement agreement(spectrum);
  const glm::dvec2 along = glm::normalize(strongest);
  const glm::dvec2 spacing = spectrum.extent() / static_cast<double>(spectrum.side());
  const glm::dvec2 step = 0.5 * spacing.x * along / spacing;  // in samples
  const double farthest = reach * static_cast<double>(spectrum.side());

  // From place to place along its strongest wave it agrees with itself less and less, before it can come back.
  double changed = 0.5 * spacing.x, last = 1, least = 1;  // m
  for (int i = 1; 0.5 * i < farthest; ++i) {
    const double here = agreement.between(static_cast<double>(i) * step);
    if (here > last) break;
    least = last = here, changed = 0.5 * i * spacing.x;
  }
  if (least > forgotten) return found;

  const auto most = static_cast<std::ptrdiff_t>(farthest);
  for (std::ptrdiff_t down = 0; down <= most; ++down)
    for (std::ptrdiff_t right = -most; right <= most; ++right) {
      const glm::dvec2 distance = spacing * glm::dvec2(static_cast<double>(right), static_cast<double>(down));
      // Along its crests anything stays as it is.
      if (std::abs(glm::dot(distance, along)) <= changed) continue;
      found.regularity = std::max(found.regularity, agreement.at(right, down));
    }
  found.regularity = std::min(found.regularity, 1.0);
  if (found.regularity < whole_again) return found;
  const double wave = 1 / glm::length(strongest);
  for (int waves = 1; waves <= waves_a_period && waves * wave <= farthest * spacing.x; ++waves) {
    const double again = agreement.exactly(spectrum, waves * wave * along / spacing);
    if (waves == 1 && again >= not_yet) break;
    if (again >= whole_again) {
      found.waves = waves;
      break;
    }
  }
  return found;
}

}  // namespace wale
