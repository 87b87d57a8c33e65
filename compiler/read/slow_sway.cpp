#include "compiler/read/slow_sway.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/fading_swing.hpp"
#include "compiler/read/relief_figures.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr double fastest_sway = 1.5;       // Hz: in 8 s are 12 periods, and means over some of them tell the rest
constexpr std::size_t sway_samples = 480;  // of the time
constexpr int sway_harmonics = 3;
constexpr int weighings = 12;            // of weights
constexpr double hardly_changed = 1e-3;  // of the largest change from one sample to the next
constexpr double farthest_off = 0.08;    // from the frequency that the spectrum shows, as a part of it
constexpr int frequencies = 8;           // that are tried on either side
constexpr int refinings = 14;            // times
constexpr double one_way_once = 1.4;     // times the range of what is left: so long is its way at most
constexpr double left_by_sway = 0.05;    // of the sway: less is what an impure sway leaves
constexpr int sway_phases = 512;
constexpr long some_ticks_apart = 3;
constexpr double left_by_repeating = 0.03;  // of the mean size of what changes
constexpr double told_well = 0.02;   // of the sway
constexpr double to_and_fro = 3;     // times its range: so far goes at least what sways, and what only comes goes it once
constexpr double slowest_unknown = 0.25, fastest_unknown = 0.5;  // Hz: two to four periods in 8 s

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, 2 * sway_harmonics>;
using Coefficients = Eigen::Matrix<double, 2 * sway_harmonics, 2>;
using Changes = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// cos and sin of each harmonic at some time.
Eigen::Matrix<double, 1, 2 * sway_harmonics> waves_at(double seconds, double frequency) {
  Eigen::Matrix<double, 1, 2 * sway_harmonics> row;
  for (int k = 0; k < sway_harmonics; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 1) * frequency * seconds;
    row[2 * k] = std::cos(angle), row[2 * k + 1] = std::sin(angle);
  }
  return row;
}

glm::dvec2 wave_at(const Coefficients& fit, double seconds, double frequency) {
  const Eigen::Matrix<double, 1, 2> force = waves_at(seconds, frequency) * fit;
  return {force[0], force[1]};
}

/// A periodic force that leaves a short way, and its length, N.
struct Fit {
  Coefficients coefficients = Coefficients::Zero();
  double way = HUGE_VAL;
};

/// Of the forces on one hand, every so-many-th tick.
class ShortestWay {
 public:
  ShortestWay(const std::vector<Force>& forces, double rate)
      : every_(std::max<std::size_t>(1, forces.size() / sway_samples)) {
    const auto count = static_cast<Eigen::Index>((forces.size() - 1) / every_);
    changes_.resize(count, 2);
    seconds_ = static_cast<double>(every_) / rate;
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i) * every_;
      const glm::dvec2 change = glm::dvec2(forces[at + every_]) - glm::dvec2(forces[at]);
      changes_(i, 0) = change.x, changes_(i, 1) = change.y;
    }
  }

  /// By weights that make the sum of squares one of sizes.
  Fit at(double frequency) const {
    const Eigen::Index count = changes_.rows();
    Matrix by(count, 2 * sway_harmonics);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double before = static_cast<double>(i) * seconds_;
      by.row(i) = waves_at(before + seconds_, frequency) - waves_at(before, frequency);
    }
    const double least = hardly_changed * std::max(1e-12, changes_.rowwise().norm().maxCoeff());
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(count);
    Fit fit;
    for (int round = 0; round < weighings; ++round) {
      const Matrix weighted = weights.asDiagonal() * by;
      const Eigen::Matrix<double, 2 * sway_harmonics, 2 * sway_harmonics> normal = by.transpose() * weighted;
      fit.coefficients = normal.ldlt().solve(weighted.transpose() * changes_);
      const Eigen::VectorXd sizes = (changes_ - by * fit.coefficients).rowwise().norm();
      fit.way = sizes.sum();
      weights = sizes.cwiseMax(least).cwiseInverse();
    }
    return fit;
  }

 private:
  std::size_t every_;
  double seconds_ = 0;  // between samples
  Changes changes_;
};

/// N: between the forces that are farthest_off apart along an axis.
double range_of(const std::vector<Force>& forces) {
  glm::vec2 low(HUGE_VALF), high(-HUGE_VALF);
  for (const Force& force : forces) low = glm::min(low, force), high = glm::max(high, force);
  return glm::length(glm::dvec2(high - low));
}

std::vector<Force> without(const std::vector<Force>& forces, const Coefficients& fit, double frequency, double rate) {
  std::vector<Force> left = forces;
  for (std::size_t i = 0; i < left.size(); ++i)
    left[i] = Force(glm::dvec2(left[i]) - wave_at(fit, static_cast<double>(i) / rate, frequency));
  return left;
}

/// rad in [0, pi): the axis along which a periodic force goes, if it has one.
std::optional<double> axis_of(const Coefficients& fit) {
  const double xx = fit.col(0).squaredNorm(), yy = fit.col(1).squaredNorm(), xy = fit.col(0).dot(fit.col(1));
  constexpr double plainly = 0.5, nearly_whole = 1e-3;
  if (std::hypot(xx - yy, 2 * xy) < plainly * (xx + yy) || !(xx + yy > 0)) return std::nullopt;
  const double angle = std::fmod(0.5 * std::atan2(2 * xy, xx - yy) + std::numbers::pi, std::numbers::pi);
  return std::numbers::pi - angle < nearly_whole ? 0 : angle;
}

/// N: how far a force goes in all.
double way_of(const std::vector<Force>& forces, double rate) {
  const auto every = std::max<std::size_t>(1, static_cast<std::size_t>(0.05 * rate));
  double way = 0;
  for (std::size_t i = every; i < forces.size(); i += every) way += glm::length(forces[i] - forces[i - every]);
  return way;
}

std::optional<PartedSway> parted_from_sway(const Bank& bank, const std::vector<std::vector<Force>>& felt,
                                           const Swing& sway) {
  if (felt.empty() || sway.frequency > fastest_sway || sway.course || !sway.parts.empty()) return std::nullopt;
  const double rate = bank.program().description().device.rate;
  const auto busiest = std::ranges::max_element(felt, {}, range_of);
  // Two or three periods may look like a drift in a spectrum.
  const bool is_known = sway.amplitude >= least_force && sway.frequency > 0;
  if (!is_known && (range_of(*busiest) < least_force || way_of(*busiest, rate) < to_and_fro * range_of(*busiest)))
    return std::nullopt;
  const ShortestWay at_busiest(*busiest, rate);
  double frequency = sway.frequency, shortest = HUGE_VAL, step = farthest_off / frequencies * sway.frequency;
  const auto look = [&](double tried) {
    if (const double way = at_busiest.at(tried).way; way < shortest) shortest = way, frequency = tried;
  };
  if (is_known) {
    for (int i = -frequencies; i <= frequencies; ++i) look(sway.frequency + i * step);
  } else {
    step = (fastest_unknown - slowest_unknown) / (2 * frequencies);
    for (int i = 0; i <= 2 * frequencies; ++i) look(slowest_unknown + i * step);
  }
  for (int i = 0; i < refinings; ++i) {
    step *= 0.6;
    const double middle = frequency;
    look(middle - step), look(middle + step);
  }
  PartedSway found{.frequency = frequency};
  double most = 0, longest_left = -HUGE_VAL;
  for (const std::vector<Force>& forces : felt) {
    const Fit fit = ShortestWay(forces, rate).at(frequency);
    found.left.push_back(without(forces, fit.coefficients, frequency, rate));
    std::vector<double> sizes;
    for (int i = 0; i < sway_phases; ++i)
      sizes.push_back(glm::length(wave_at(fit.coefficients, i / (sway_phases * frequency), frequency)));
    if (&forces == &*busiest) found.axis = axis_of(fit.coefficients);
    found.amplitude = std::max(found.amplitude, percentile(sizes, percentile_of_amplitude));
    const double range = range_of(found.left.back());
    most = std::max(most, range), longest_left = std::max(longest_left, fit.way - one_way_once * range);
  }
  if (found.amplitude < least_force) return std::nullopt;
  found.alone = most < std::max(least_force, left_by_sway * found.amplitude);
  if (!found.alone && (!is_known || longest_left > left_by_sway * found.amplitude)) return std::nullopt;
  // What three harmonics do not tell well has its size from the spectrum.
  if (found.alone && is_known && most > told_well * found.amplitude) found.amplitude = sway.amplitude;
  return found;
}

/// Hz: the rate at which a force of any waveform repeats, near a frequency; nothing if it does not.
std::optional<double> repeats_at(const std::vector<Force>& forces, double frequency, double rate) {
  const auto count = static_cast<long>(forces.size());
  const auto longest = std::min(count / 2 + count / 4, std::lround(rate / (frequency * (1 - farthest_off))));
  double least = HUGE_VAL, changing = 0;
  long best = 0;
  glm::dvec2 mean{0};
  for (const Force& force : forces) mean += glm::dvec2(force) / static_cast<double>(count);
  for (const Force& force : forces) changing += glm::length(glm::dvec2(force) - mean) / static_cast<double>(count);
  for (long apart = std::lround(rate / (frequency * (1 + farthest_off))); apart <= longest; ++apart) {
    double differs = 0;
    for (long i = 0; i + apart < count; i += some_ticks_apart)
      differs += glm::length(forces[static_cast<std::size_t>(i + apart)] - forces[static_cast<std::size_t>(i)]);
    differs *= static_cast<double>(some_ticks_apart) / static_cast<double>(count - apart);
    if (differs < least) least = differs, best = apart;
  }
  if (!(least < left_by_repeating * changing)) return std::nullopt;
  return rate / static_cast<double>(best);
}

}  // namespace

SlowParts slow_parts(const Bank& bank, const std::vector<std::vector<Force>>& felt, Swing& sway,
                     const Swing& vibration) {
  SlowParts parts;
  if (const Swing& fading = sway.rate_of_change != 0 ? sway : vibration; fading.rate_of_change != 0) {
    const double rate = bank.program().description().device.rate;
    PartedSway parted{.amplitude = fading.amplitude, .frequency = fading.frequency};
    parted.left = without_fading(felt, rate, fading.frequency, fading.rate_of_change);
    const double most = range_of(*std::ranges::max_element(parted.left, {}, range_of));
    parted.alone = most < std::max(least_force, left_by_sway * fading.course->greatest);
    if (!parted.alone) parts.change = slow_change(bank, parted.left, {}, {});
    parts.sway = std::move(parted);
    return parts;
  }
  if (vibration.amplitude < least_force) parts.sway = parted_from_sway(bank, felt, sway);
  if (!parts.sway) {
    // What repeats goes nowhere, whatever its waveform is and whatever the means over a few periods are.
    if (sway.amplitude >= least_force && sway.frequency > 0 && sway.frequency <= fastest_sway && !felt.empty()) {
      const double rate = bank.program().description().device.rate;
      const auto busiest = std::ranges::max_element(felt, {}, range_of);
      if (const auto repeats = repeats_at(*busiest, sway.frequency, rate)) {
        // A vibration beside it repeats at its own multiples.
        if (vibration.amplitude < least_force) sway.frequency = *repeats;
        return parts;
      }
    }
    parts.change = slow_change(bank, felt, sway, vibration);
    return parts;
  }
  if (!(sway.frequency > 0) || sway.amplitude < least_force) sway.axis = parts.sway->axis;
  sway.amplitude = parts.sway->amplitude, sway.frequency = parts.sway->frequency;
  if (!parts.sway->alone) parts.change = slow_change(bank, parts.sway->left, {}, {});
  return parts;
}

}  // namespace wale
