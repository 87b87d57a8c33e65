#include "compiler/read/fitted_waves.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

namespace wale {
namespace {

constexpr std::size_t few_places_a_part = 16;        // of a period, to move a wave by ...
constexpr std::size_t places_a_part = 48;            // ... and at last, to put it where it is
constexpr std::size_t places_together = 1500;        // to move several waves by ...
constexpr std::size_t places_of_line = 3000;         // ... and to fit a line beside them
constexpr double slow_periods = 12;                  // over the patch
constexpr double few_periods_together = 25;          // over the patch, so that two waves look alike
constexpr double least_taken = 0.02;                 // of what is left, by one more wave
constexpr double least_parted = 5e-4;                // of the whole mean square: worth it to look for two waves in one
constexpr double hardly_any = 0.1;                   // of what waves leave, if one of them is parted ...
constexpr double much_less = 0.5;                    // of what waves leave, if they are moved together
constexpr std::size_t bins_together = 96;            // of waves that are found together ...
constexpr double times_less_in_means = 10;           // finer waves' square: 16 in the mean, and more by chance
constexpr double fewest_together = 2.5;              // periods over the patch, of each
constexpr double mostly_first = 0.9;                 // of its mean square, in its first harmonic
constexpr double as_strong_as_the_strongest = 0.85;  // of its power
constexpr std::size_t most_joined_harmonic = 24;     // that is found before the wave whose harmonic it is

}  // namespace

FittedWaves::FittedWaves(const StillForces& whole, const std::vector<Feature>& features)
    : whole_(whole), features_(features) {
  update_rest();
  found_.trend = linear_force(whole.places, found_.rest);
  update_rest();
  // Where a feature jumps nothing was left, and now nothing but what the line has there.
  for (int turn = 0; turn < 2 && !features.empty(); ++turn) {
    const LinearForce more = linear_force(whole.places, found_.rest);
    found_.trend.mean += more.mean, found_.trend.by_x += more.by_x, found_.trend.by_y += more.by_y;
    update_rest();
  }
  all_ = mean_square(found_.rest);
}

std::vector<glm::dvec2> FittedWaves::rest_at(const std::vector<glm::dvec2>& places,
                                             std::vector<glm::dvec2> forces) const {
  for (std::size_t i = 0; i < places.size(); ++i) forces[i] -= found_.trend.at(places[i]);
  if (!features_.empty())
    for (std::size_t i = 0; i < places.size(); ++i) forces[i] = beside(features_, places[i], forces[i]);
  for (const FoundWave& each : found_.waves) each.wave.add_to(places, forces, -1);
  return forces;
}

void FittedWaves::update_rest_after(const LinearForce& trend) {
  // Where a feature jumps the rest is nothing, whatever the trend.
  if (!features_.empty()) return update_rest();
  const LinearForce more{trend.mean - found_.trend.mean, trend.by_x - found_.trend.by_x,
                         trend.by_y - found_.trend.by_y};
  for (std::size_t i = 0; i < found_.rest.size(); ++i) found_.rest[i] += more.at(whole_.places[i]);
}

bool FittedWaves::take_off(glm::dvec2 waves, const Fundamental& fundamental) {
  const std::size_t bins = most_bins(2 * parts_of_a_wave * fundamental.multiple, whole_.places.size() / 4);
  FoldedWave wave = folded(whole_.places, found_.rest, waves, std::max<std::size_t>(bins, 192));
  if (wave.explained < least_taken) return false;
  const double before = mean_square(found_.rest);
  found_.waves.push_back({std::move(wave), 0, fundamental.parts});
  fit_together(is_slow(waves));
  shorten_if_longer(found_.waves.back());
  join_harmonics();
  StillForces some = every(3);
  some.forces = rest_at(some.places, std::move(some.forces));
  const LinearForce trend = found_.trend;
  fit_trend(some);
  update_rest_after(trend);
  settle_shared_harmonics();
  part_slow_waves();
  for (FoundWave& each : found_.waves) shorten_if_longer(each);
  for (FoundWave& each : found_.waves) each.power = mean_square(each.wave.profile);
  // A wave that joins another one and leaves as much as before would be found again without end.
  return mean_square(found_.rest) < (1 - least_taken) * before;
}

void FittedWaves::shorten_if_longer(FoundWave& found) {
  if (found.parts.size() > 1) return;
  // Over the whole patch the harmonics are clean.
  const std::vector<double> powers = harmonics_of(found.wave, std::min<std::size_t>(60, found.wave.profile.size() / 3));
  std::size_t step = 0;
  for (std::size_t i = 0; i < powers.size(); ++i)
    if (powers[i] >= weak_part) step = std::gcd(step, i + 1);
  if (step > 1) shorten(found, step);
}

void FittedWaves::shorten(FoundWave& found, std::size_t step) {
  fold_anew(found, static_cast<double>(step) * found.wave.waves,
            std::max<std::size_t>(found.wave.profile.size() / step, 64));
}

void FittedWaves::fold_anew(FoundWave& found, glm::dvec2 waves, std::size_t bins) {
  add_to_rest(found.wave, 1);
  found.wave = folded(whole_.places, found_.rest, waves, bins);
  add_to_rest(found.wave, -1);
}

void FittedWaves::drop_parts_that_are_gone() {
  for (FoundWave& each : found_.waves) {
    if (each.parts.size() < 2) continue;
    std::vector<std::size_t> left;
    for (const WavePart& part : parts_of(each))
      if (part.share >= strong_part) left.push_back(part.number);
    if (left.size() != 1) continue;
    shorten(each, left.front());
    each.parts = {1}, each.power = mean_square(each.wave.profile);
  }
}

std::size_t FittedWaves::harmonic_of(const FoundWave& coarse, const FoundWave& fine) const {
  const auto number =
      static_cast<std::size_t>(std::abs(whole_periods(coarse.wave.waves, fine.wave.waves, whole_.size)));
  return number >= 2 && number <= most_joined_harmonic ? number : 0;
}

void FittedWaves::join_harmonics() {
  for (std::size_t coarse = 0; coarse < found_.waves.size(); ++coarse)
    for (std::size_t fine = 0; fine < found_.waves.size(); ++fine) {
      const std::size_t number = harmonic_of(found_.waves[coarse], found_.waves[fine]);
      if (number == 0 || found_.waves[coarse].parts.size() > 1 || found_.waves[fine].parts.size() > 1) continue;
      FoundWave &one = found_.waves[coarse], &other = found_.waves[fine];
      std::vector<glm::dvec2> forces = found_.rest;
      for (const FoundWave* each : {&one, &other}) each->wave.add_to(whole_.places, forces, 1);
      const std::size_t bins =
          most_bins(std::max(one.wave.profile.size(), parts_of_a_wave * number), forces.size() / 4);
      FoldedWave both = folded(whole_.places, forces, one.wave.waves, bins);
      if (fine_wave(harmonics_of(both, both.profile.size() / 2)) == number) continue;
      one.wave = std::move(both);
      found_.waves.erase(found_.waves.begin() + static_cast<std::ptrdiff_t>(fine));
      update_rest();
      return join_harmonics();
    }
}

std::vector<glm::dvec2> FittedWaves::may_be_waves() const {
  std::vector<std::pair<double, glm::dvec2>> found;  // N^2
  for (const FoundWave& each : found_.waves) {
    std::vector<WavePart> parts = parts_of(each);
    if (parts.size() == 1) {
      const std::vector<double> powers = harmonics_of(each.wave, each.wave.profile.size() / 3);
      const auto finer = std::max_element(powers.begin() + 1, powers.end());
      if (*finer >= strong_part) parts.push_back({static_cast<std::size_t>(finer - powers.begin()) + 1, *finer});
    }
    const double power = mean_square(each.wave.profile);
    for (const WavePart& part : parts)
      found.emplace_back(part.share * power, static_cast<double>(part.number) * each.wave.waves);
  }
  std::ranges::stable_sort(found, std::greater(), [](const auto& each) { return each.first; });
  if (found.size() > most_waves_found) found.resize(most_waves_found);
  std::vector<glm::dvec2> waves;
  for (const auto& each : found) waves.push_back(each.second);
  return waves;
}

void FittedWaves::part_slow_waves() {
  if (!(mean_square(found_.rest) > least_parted * all_)) return;
  bool few = false;
  std::size_t bins = 0;
  for (const FoundWave& each : found_.waves) {
    few = few || glm::length(each.wave.waves * whole_.size) < few_periods_together;
    bins = std::max(bins, each.wave.profile.size());
  }
  if (!few) return;
  const std::vector<glm::dvec2> waves = may_be_waves();
  if (waves.size() < 2) return;
  const StillForces some = to_fit_together();
  HarmonicFit fit = fit_harmonics(some.places, some.forces, waves, whole_.size, bins);
  // A few harmonics that are free to move fill any waveform a little better.
  const bool parts_one = waves.size() > found_.waves.size();
  if (fit.left > (parts_one ? hardly_any : much_less) * fit.left_there) return;
  replace_by(std::move(fit));
}

StillForces FittedWaves::to_fit_together() const {
  StillForces some = every(std::max<std::size_t>(1, whole_.places.size() / places_together));
  some.forces = rest_at(some.places, std::move(some.forces));
  for (std::size_t i = 0; i < some.places.size(); ++i) some.forces[i] += found_.trend.at(some.places[i]);
  for (const FoundWave& each : found_.waves) each.wave.add_to(some.places, some.forces, 1);
  return some;
}

bool FittedWaves::replace_by(HarmonicFit fit) {
  const FoundWaves before = found_;
  const double left_before = mean_square(found_.rest);
  found_.waves.clear();
  for (FoldedWave& each : fit.waves) found_.waves.push_back({std::move(each), 0, {1}});
  found_.trend = fit.line;
  update_rest();
  for (int turn = 0; turn < 2; ++turn)
    for (FoundWave& each : found_.waves) fold_anew(each, each.wave.waves, each.wave.profile.size());
  if (mean_square(found_.rest) < left_before) return true;
  found_ = before;
  return false;
}

bool FittedWaves::take_off_together(const std::vector<glm::dvec2>& waves) {
  const StillForces some = to_fit_together();
  HarmonicFit fit = fit_harmonics(some.places, some.forces, waves, whole_.size, bins_together);
  double all = 0;
  for (const FoldedWave& each : fit.waves) all += mean_square(each.profile);
  if (!(all > 0)) return false;
  for (const FoldedWave& each : fit.waves) {
    const double periods = glm::length(each.waves) * length_along(whole_.size, each.waves);
    if (periods < fewest_together || mean_square(each.profile) < least_taken * all ||
        harmonics_of(each, 1).front() < mostly_first)
      return false;
  }
  const FoundWaves before = found_;
  if (replace_by(std::move(fit)) && hardly_any_slow_rest()) {
    for (FoundWave& each : found_.waves) each.power = mean_square(each.wave.profile);
    return true;
  }
  found_ = before;
  return false;
}

bool FittedWaves::hardly_any_slow_rest() const {
  const double even = mean_square(cell_means(whole_.side, found_.rest)), fine = mean_square(found_.rest) - even;
  return even < negligible_rest * all_ + fine / times_less_in_means;
}

void FittedWaves::fit_together(bool slow) {
  const int turns = slow ? 4 : 3;
  std::size_t most = 0;
  for (const FoundWave& each : found_.waves) most = std::max(most, each.wave.profile.size());
  const auto at_places = [&](std::size_t a_part) {
    StillForces some = every(std::max<std::size_t>(1, whole_.places.size() / (a_part * most)));
    some.forces = rest_at(some.places, std::move(some.forces));
    return some;
  };
  StillForces some = at_places(few_places_a_part);
  for (int turn = 0; turn < turns; ++turn) {
    if (turn + 1 == turns) some = at_places(places_a_part);
    fit_trend(some);
    for (FoundWave& each : found_.waves) {
      const std::size_t bins = each.wave.profile.size();
      each.wave.add_to(some.places, some.forces, 1);
      const glm::dvec2 waves = better_fitting(some.places, some.forces, each.wave.waves, bins / 4);
      each.wave = folded(some.places, some.forces, waves, bins);
      each.wave.add_to(some.places, some.forces, -1);
    }
    if (!slow && mean_square(some.forces) < negligible_rest * all_) turn = std::max(turn, turns - 2);
  }
  update_rest();
  for (FoundWave& each : found_.waves) fold_anew(each, each.wave.waves, each.wave.profile.size());
}

void FittedWaves::add_to_rest(const FoldedWave& wave, double times) { wave.add_to(whole_.places, found_.rest, times); }

StillForces FittedWaves::every(std::size_t step) const {
  StillForces some{whole_.side, whole_.centre, whole_.size, {}, {}};
  for (std::size_t i = 0; i < whole_.places.size(); i += step)
    some.places.push_back(whole_.places[i]), some.forces.push_back(whole_.forces[i]);
  return some;
}

void FittedWaves::fit_trend(StillForces& rest) {
  std::vector<glm::dvec2> slow, forces = rest.forces;
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += found_.trend.at(rest.places[i]);
  for (const FoundWave& each : found_.waves) {
    if (!is_slow(each.wave.waves)) continue;
    slow.push_back(each.wave.waves);
    // Beyond the harmonics that are fitted with it.
    for (const std::size_t part : each.parts)
      if (part > harmonics_beside) slow.push_back(static_cast<double>(part) * each.wave.waves);
    each.wave.add_to(rest.places, forces, 1);
  }
  const LinearForce before = found_.trend;
  found_.trend = slow.empty() ? linear_force(rest.places, forces) : linear_beside(rest.places, forces, slow);
  const LinearForce more{before.mean - found_.trend.mean, before.by_x - found_.trend.by_x,
                         before.by_y - found_.trend.by_y};
  for (std::size_t i = 0; i < forces.size(); ++i) rest.forces[i] += more.at(rest.places[i]);
}

void FittedWaves::settle_trend() {
  if (found_.waves.empty() || found_.lattice) return;
  StillForces some = every(std::max<std::size_t>(1, whole_.places.size() / places_of_line));
  some.forces = rest_at(some.places, std::move(some.forces));
  std::vector<glm::dvec2> waves;
  for (const FoundWave& each : found_.waves) {
    each.wave.add_to(some.places, some.forces, 1);
    for (const std::size_t part : each.parts) waves.push_back(static_cast<double>(part) * each.wave.waves);
  }
  for (std::size_t i = 0; i < some.places.size(); ++i) some.forces[i] += found_.trend.at(some.places[i]);
  const FoundWaves before = found_;
  const double left = mean_square(found_.rest);
  found_.trend = line_beside_waves(some.places, some.forces, waves, whole_.size);
  update_rest_after(before.trend);
  for (FoundWave& each : found_.waves) fold_anew(each, each.wave.waves, each.wave.profile.size());
  if (!(mean_square(found_.rest) < left)) found_ = before;
}

bool FittedWaves::is_slow(glm::dvec2 waves) const { return glm::length(waves * whole_.size) < slow_periods; }

void FittedWaves::keep_local(const StillForces& window, const std::vector<glm::dvec2>& forces,
                             const Fundamental& fundamental) {
  FoldedWave wave = folded(window.places, forces, fundamental.waves,
                           most_bins(2 * parts_of_a_wave * fundamental.multiple, forces.size() / 4));
  found_.share = wave.explained;
  const double power = mean_square(wave.profile);
  found_.waves.push_back({std::move(wave), power, fundamental.parts});
  found_.local = true;
}

void FittedWaves::settle_shared_harmonics() {
  for (FoundWave& one : found_.waves)
    for (FoundWave& other : found_.waves) {
      const SharedHarmonic shared = shared_harmonic(one, other, whole_.size);
      if (shared.of_one == 0 || !belongs_to_other(one, other, shared)) continue;
      for (FoundWave* each : {&one, &other}) add_to_rest(each->wave, 1);
      take_harmonic_off(one.wave, shared.of_one);
      add_to_rest(one.wave, -1);
      other.wave = folded(whole_.places, found_.rest, other.wave.waves, other.wave.profile.size());
      add_to_rest(other.wave, -1);
      for (FoundWave* each : {&one, &other}) each->power = mean_square(each->wave.profile);
    }
}

void FittedWaves::tell_carrier(FoundWave& found) {
  if (found.parts.size() > 1) return;
  const std::vector<double> powers = harmonics_of(found.wave, found.wave.profile.size() / 3);
  if (powers.empty() || fine_wave(powers) > 0) return;
  const auto strongest = static_cast<std::size_t>(std::ranges::max_element(powers) - powers.begin()) + 1;
  const std::size_t periods = carrier_of(powers, strongest);
  if (periods > 0 && strongest % periods == 0) found.parts = {strongest / periods};
}

FoundWaves FittedWaves::finished() {
  if (found_.local) return std::move(found_);
  drop_parts_that_are_gone();
  settle_shared_harmonics();
  settle_trend();
  for (FoundWave& each : found_.waves) tell_carrier(each);
  const double rest = mean_square(found_.rest);
  double waves = 0;
  for (const FoundWave& each : found_.waves) waves += each.power;
  found_.share = waves + rest > 0 ? waves / (waves + rest) : 0;
  if (found_.lattice) found_.share = std::max(found_.share, found_.lattice->share);
  std::ranges::stable_sort(found_.waves, std::greater(), &FoundWave::power);
  // Which of some that are as strong is read as the strongest is chance: the finest is told.
  const auto as_strong = std::ranges::partition_point(found_.waves, [&](const FoundWave& each) {
    return each.power > as_strong_as_the_strongest * found_.waves.front().power;
  });
  std::ranges::stable_sort(found_.waves.begin(), as_strong, std::greater(),
                           [](const FoundWave& each) { return glm::length(each.felt()); });
  return std::move(found_);
}

}  // namespace wale
