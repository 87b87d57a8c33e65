#include "compiler/extract/regularity.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

namespace wale {
namespace {

constexpr double reach = 0.3;         // of the field's side: windows at this distance still overlap enough
constexpr double forgotten = 0.5;     // agreement must have fallen below this before a return counts
constexpr int waves_a_period = 8;     // steps per period
constexpr double as_strong = 0.5;     // of the strongest wave's power: a second wave of this power counts too
constexpr double least_angle = 0.2;   // rad between the two waves
constexpr double whole_again = 0.95;  // agreement after a period ...
constexpr double not_yet = 0.9;       // and less than this before
constexpr double least_power = 1e-4;  // of the strongest coefficient's; smaller powers are left out of long sums

/// The share of a window that overlaps with itself moved by some samples, including the part that comes in from behind.
class CommonShare {
 public:
  explicit CommonShare(std::size_t side) : shared_(side) {
    const std::vector<float> window = hann_window(side);
    for (std::size_t far = 0; far < side; ++far)
      for (std::size_t i = 0; i < side; ++i) shared_[far] += window[i] * window[(i + far) % side];
  }
  double at(std::size_t distance) const { return shared_[distance] / shared_[0]; }
  double between(double distance) const {
    const double low = std::floor(std::abs(distance)), part = std::abs(distance) - low;
    const auto far = static_cast<std::size_t>(low);
    return (1 - part) * at(far) + part * at(far + 1);
  }

 private:
  std::vector<double> shared_;
};

/// The agreement of a texture with itself at distances of whole samples; 1 at distance 0. Waves that are too fine for
/// the samples are used as they are.
class Agreement {
 public:
  explicit Agreement(const BandSpectrum& spectrum) : side_(spectrum.side()), common_(side_) {
    const std::vector<float>& power = spectrum.power();
    sums_ = inverse_fourier(side_, Spectrum(power.begin(), power.end()));
  }

  double at(std::ptrdiff_t right, std::ptrdiff_t down) const {
    const auto side = static_cast<std::ptrdiff_t>(side_);
    const auto column = static_cast<std::size_t>((right + side) % side);
    const auto row = static_cast<std::size_t>((down + side) % side);
    return sums_[row * side_ + column].real() / sums_.front().real() / (common_.at(column) * common_.at(row));
  }

  /// Between samples, approximately.
  double between(glm::dvec2 distance) const {
    const glm::dvec2 low = glm::floor(distance), part = distance - low;
    const auto right = static_cast<std::ptrdiff_t>(low.x), down = static_cast<std::ptrdiff_t>(low.y);
    return ((1 - part.x) * at(right, down) + part.x * at(right + 1, down)) * (1 - part.y) +
           ((1 - part.x) * at(right, down + 1) + part.x * at(right + 1, down + 1)) * part.y;
  }

 private:
  std::size_t side_;
  CommonShare common_;
  Spectrum sums_;
};

/// The same at any distance (m), as a sum over the waves.
double agreement_after(const BandSpectrum& spectrum, const CommonShare& common, glm::dvec2 distance) {
  const std::vector<float>& power = spectrum.power();
  const float least = static_cast<float>(least_power) * *std::ranges::max_element(power);
  double sum = 0, all = 0;
  for (std::size_t row = 0; row < spectrum.side(); ++row)
    for (std::size_t column = 0; column < spectrum.side(); ++column) {
      const double here = power[row * spectrum.side() + column];
      if (here < least) continue;
      all += here;
      sum += here * std::cos(2 * std::numbers::pi * glm::dot(spectrum.waves(column, row), distance));
    }
  const glm::dvec2 samples = distance / spectrum.extent() * static_cast<double>(spectrum.side());
  return sum / all / (common.between(samples.x) * common.between(samples.y));
}

/// The distance along a direction (of length 1) at which a texture begins to agree with its start again, m; empty if
/// it never changes.
std::optional<double> first_change(const Agreement& agreement, glm::dvec2 along, glm::dvec2 spacing, double farthest) {
  const double metres = 0.5 * std::min(spacing.x, spacing.y);
  const glm::dvec2 step = metres * along / spacing;  // in samples; at most half a sample
  double changed = metres, last = 1;
  for (int i = 1; 0.5 * i < farthest; ++i) {
    const double here = agreement.between(static_cast<double>(i) * step);
    if (here > last) break;
    last = here, changed = i * metres;
  }
  return last > forgotten ? std::nullopt : std::optional(changed);
}

/// The shorter of the two steps from crest to crest of one wave along the crests of the other, m.
std::optional<glm::dvec2> step_between(glm::dvec2 one, glm::dvec2 other) {
  const double area = one.x * other.y - one.y * other.x;
  if (std::abs(area) < least_angle * glm::length(one) * glm::length(other)) return std::nullopt;
  const glm::dvec2 along_other = glm::dvec2(other.y, -other.x) / area, along_one = glm::dvec2(-one.y, one.x) / area;
  return glm::length(along_other) < glm::length(along_one) ? along_other : along_one;
}

}  // namespace

double regularity(const BandSpectrum& spectrum, glm::dvec2 strongest) {
  const glm::dvec2 along = glm::normalize(strongest);
  const glm::dvec2 spacing = spectrum.extent() / static_cast<double>(spectrum.side());
  const double farthest = reach * static_cast<double>(spectrum.side());  // samples
  const Agreement agreement(spectrum);
  const auto changed = first_change(agreement, along, spacing, farthest);
  if (!changed) return 0;
  double found = 0;
  const auto most = static_cast<std::ptrdiff_t>(farthest);
  for (std::ptrdiff_t down = 0; down <= most; ++down)
    for (std::ptrdiff_t right = -most; right <= most; ++right) {
      const glm::dvec2 distance = spacing * glm::dvec2(static_cast<double>(right), static_cast<double>(down));
      // Along its crests a wave does not change.
      if (std::abs(glm::dot(distance, along)) > *changed) found = std::max(found, agreement.at(right, down));
    }
  return std::min(found, 1.0);
}

double repetition(const BandSpectrum& spectrum, const std::vector<WaveComponent>& components) {
  const glm::dvec2 strongest = components.front().waves;
  const double wave = 1 / glm::length(strongest), farthest = reach * std::min(spectrum.extent().x, spectrum.extent().y);
  const CommonShare common(spectrum.side());
  const auto again = [&](glm::dvec2 distance) { return agreement_after(spectrum, common, distance); };
  for (const WaveComponent& other : components) {
    if (other.share < as_strong * components.front().share) continue;
    const auto step = step_between(strongest, other.waves);
    if (step && glm::length(*step) < farthest && again(*step) >= whole_again) return glm::length(*step);
  }
  for (int waves = 1; waves <= waves_a_period && waves * wave <= farthest; ++waves) {
    const double here = again(waves * wave * wave * strongest);
    if (here >= whole_again || (waves == 1 && here >= not_yet)) return waves * wave;
  }
  return wave;
}

}  // namespace wale
