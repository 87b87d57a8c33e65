#include "compiler/read/fundamental.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <span>

namespace wale {
namespace {

constexpr std::size_t most_multiples = 40;  // of a peak's period, for its fundamental
constexpr std::size_t few_multiples = 12;   // after which ...
constexpr double hopeless = 0.12;           // ... so little explained means that there is no wave
constexpr double hardly_less = 0.015;       // of the mean square: as well explained
constexpr std::size_t small_common_multiple = 5;
constexpr double least_of_sum = 0.05;           // of the mean square: of each wave in a sum with a period of its own
constexpr double clearly_more = 0.03;           // of the mean square
constexpr double wholly = 0.985;                // explained: no longer period can be better
constexpr double least_carrier = 7;             // periods of a wave in the time in which it wavers
constexpr double about_carrier = 0.4;           // of the carrier's number: harmonics are so near, at most, ...
constexpr double about_its_harmonics = 0.3;     // ... or so near to a multiple of it ...
constexpr double hardly_beside_carrier = 0.12;  // ... but for so much of the mean square
constexpr std::size_t most_of_carrier = 4;      // its strongest harmonic
constexpr double fewest_periods = 3;            // that tell a wave from a chance
constexpr double fewest_if_exact = 2;           // the same of one that explains ...
constexpr double exact = 0.95;                  // ... so much ...
constexpr double far_more = 0.2;                // ... and so much more than any of shorter period

/// Whether one of the waves that seem to be harmonics of a common one does not quite fit it when looked for by itself,
/// or is a harmonic of another one.
bool lies_elsewhere(const StillForces& thin, glm::dvec2 common, const std::vector<std::size_t>& numbers) {
  return std::ranges::any_of(numbers, [&](std::size_t number) {
    const glm::dvec2 waves = static_cast<double>(number) * common;
    const glm::dvec2 there = in_phase(thin.places, thin.forces, thin.centre, thin.size, waves);
    if (glm::length((there - waves) * thin.size) > out_of_place) return true;
    const auto explained = [&](std::size_t multiple) {
      return explained_by(thin.places, thin.forces, waves / static_cast<double>(multiple),
                          most_bins(parts_of_a_wave * multiple, thin.places.size()));
    };
    const double alone = explained(1);
    return (number % 2 != 0 && explained(2) > alone + clearly_more) ||
           (number % 3 != 0 && explained(3) > alone + clearly_more);
  });
}

/// Whether a long period only says how often a much shorter wave wavers, or comes and goes: all its harmonics stand
/// close about that of the carrier and its multiples. Those of a narrow ridge begin with the first and lie everywhere.
bool only_wavers(const std::vector<double>& powers, double carrier) {
  if (carrier < least_carrier) return false;
  double near = 0, all = 0;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    const double carriers = static_cast<double>(i + 1) / carrier, nearest = std::max(1.0, std::round(carriers));
    all += powers[i];
    if (std::abs(carriers - nearest) <= (nearest > 1 ? about_its_harmonics : about_carrier)) near += powers[i];
  }
  return near > (1 - hardly_beside_carrier) * all;
}

}  // namespace

std::size_t carrier_of(const std::vector<double>& powers, std::size_t strongest) {
  for (std::size_t periods = 1; periods <= most_of_carrier; ++periods)
    if (only_wavers(powers, static_cast<double>(strongest) / static_cast<double>(periods))) return periods;
  return 0;
}

int whole_periods(glm::dvec2 wave, glm::dvec2 other, glm::dvec2 size) {
  const double whole = std::round(glm::dot(other, wave) / glm::dot(wave, wave));
  constexpr double most = 1000;
  return std::abs(whole) < most && glm::length((other - whole * wave) * size) < out_of_place ? static_cast<int>(whole)
                                                                                             : 0;
}

double length_along(glm::dvec2 size, glm::dvec2 direction) {
  const glm::dvec2 way = glm::abs(glm::normalize(direction));
  return std::min(way.x > 0 ? size.x / way.x : HUGE_VAL, way.y > 0 ? size.y / way.y : HUGE_VAL);
}

std::size_t most_bins(std::size_t wanted, std::size_t places) {
  return std::clamp<std::size_t>(wanted, 16, places / 5);
}

std::vector<double> harmonics_of(const FoldedWave& wave, std::size_t most) {
  std::vector<double> powers(most);
  const std::size_t parts = wave.profile.size();
  const auto count = static_cast<double>(parts);
  std::vector<std::complex<double>> turned(parts);
  for (std::size_t i = 0; i < parts; ++i)
    turned[i] = std::polar(1 / count, -2 * std::numbers::pi * static_cast<double>(i) / count);
  const double all = mean_square(wave.profile);
  for (std::size_t harmonic = 1; harmonic <= most; ++harmonic) {
    std::complex<double> x = 0, y = 0;
    for (std::size_t i = 0, at = 0; i < parts; ++i) {
      x += wave.profile[i].x * turned[at], y += wave.profile[i].y * turned[at];
      at += harmonic;
      while (at >= parts) at -= parts;
    }
    powers[harmonic - 1] = all > 0 ? 2 * (std::norm(x) + std::norm(y)) / all : 0;
  }
  return powers;
}

Fundamental fundamental_of(const StillForces& thin, glm::dvec2 peak, bool may_lie_beside) {
  const double period = 1 / glm::length(peak), length = length_along(thin.size, peak);
  const auto explained = [&](std::size_t multiple) {
    return explained_by(thin.places, thin.forces, peak / static_cast<double>(multiple),
                        most_bins(parts_of_a_wave * multiple, thin.places.size()));
  };
  Fundamental found{peak, 1, explained(1), {1}};
  // What lay beside a peak may be the common multiple of several waves.
  if (may_lie_beside && found.explained >= wholly) return found;
  const auto most_in = [&](double fewest) {
    return std::min<std::size_t>(most_multiples, static_cast<std::size_t>(length / fewest / period));
  };
  std::vector<double> all{found.explained};
  for (std::size_t multiple = 2; multiple <= most_in(fewest_periods); ++multiple) {
    all.push_back(explained(multiple));
    if (multiple == few_multiples && std::ranges::max(all) < hopeless) break;
  }
  const std::size_t untold = all.size() < few_multiples || std::ranges::max(all) >= hopeless ? most_in(fewest_if_exact) : 0;
  // A harmonic of a wave that is too long to be found by itself is not told as a wave.
  for (std::size_t multiple = all.size() + 1; multiple <= untold; ++multiple) {
    const double shorter = std::ranges::max(all), longer = explained(multiple);
    if (longer < exact || longer < shorter + far_more) continue;
    all.resize(multiple - 1), all.push_back(longer);
  }
  std::vector<double> powers;
  for (std::size_t longest = all.size();;) {
    const double best = std::ranges::max(std::span(all).first(longest));
    for (std::size_t i = 0; i < longest; ++i)
      if (all[i] >= best - hardly_less) {
        found.waves = peak / static_cast<double>(i + 1), found.multiple = i + 1, found.explained = all[i];
        break;
      }
    if (may_lie_beside && found.multiple == 1) return found;
    const FoldedWave wave =
        folded(thin.places, thin.forces, found.waves, most_bins(parts_of_a_wave * found.multiple, thin.places.size()));
    powers = harmonics_of(wave, std::min(6 * found.multiple + 6, wave.profile.size() / 2));
    longest = carrier_of(powers, found.multiple);
    if (longest == 0) break;
  }
  // A peak may lie beside the wave, at an even part of a multiple: then only every so many-th harmonic is there.
  std::size_t step = 0;
  for (std::size_t i = 0; i < powers.size(); ++i)
    if (powers[i] >= weak_part) step = std::gcd(step, i + 1);
  if (step > 1 && may_lie_beside) {
    glm::dvec2 finer = static_cast<double>(step) * found.waves;
    for (int turn = 0; turn < 3; ++turn) finer = better_fitting(thin.places, thin.forces, finer, parts_of_a_wave);
    return fundamental_of(thin, finer, false);
  }
  // A coarse wave beside the peak's, not its fundamental.
  if (fine_wave(powers) == found.multiple) return {peak, 1, all.front(), {1}};
  // Harmonics of one wave, or of several that share this period: those whose multiples the others are.
  std::vector<std::size_t> own;
  std::vector<double> shares;
  double in_own = 0, in_all = 0;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    in_all += powers[i];
    auto of = std::ranges::find_if(own, [&](std::size_t other) { return (i + 1) % other == 0; });
    if (of == own.end()) {
      if (!(powers[i] >= strong_part)) continue;
      shares.push_back(0), of = own.insert(own.end(), i + 1);
    }
    shares[static_cast<std::size_t>(of - own.begin())] += powers[i], in_own += powers[i];
  }
  // One wave may be there alone, and a finer one fit into the longer period by chance.
  const bool alone = own.size() == 1 && own.front() > 1;
  const bool several = own.size() >= 2 && own.size() <= most_waves_found && in_own > 0.85 * in_all;
  if (!alone && !several) return found;
  const bool each_counts = std::ranges::min(shares) >= least_of_sum * in_own;
  if (several && each_counts && own.back() <= small_common_multiple && !lies_elsewhere(thin, found.waves, own)) {
    found.parts = own;
    return found;
  }
  for (const std::size_t part : own) {
    if (found.multiple % part != 0) continue;
    const std::size_t multiple = found.multiple / part;
    return {peak / static_cast<double>(multiple), multiple, all[multiple - 1], {1}};
  }
  if (several) found = {static_cast<double>(own.front()) * found.waves, 1, all.front(), {1}};
  return found;
}

}  // namespace wale
