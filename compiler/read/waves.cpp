#include "compiler/read/waves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <utility>

#include "compiler/read/fundamental.hpp"
#include "compiler/read/window_spectrum.hpp"

namespace wale {
namespace {

constexpr std::array<double, 3> closer = {4, 16, 96};  // windows are so many times smaller than the patch
constexpr std::size_t closer_side = 128;
constexpr std::size_t candidates = 5;
constexpr std::size_t few_places_a_part = 16;     // ... and until it hardly moves any more
constexpr std::size_t places_a_part = 48;         // of a period, to move a wave by
constexpr double least_explained = 0.3;           // of what is left, by a wave ...
constexpr double least_explained_by_few = 0.7;    // ... and by one with few periods
constexpr double least_explained_by_many = 0.12;  // ... and by one with many
constexpr double few_periods = 6, many_periods = 25;
constexpr double slow_periods = 12;  // over the patch
constexpr double least_explained_locally = 0.5;
constexpr double plainly_there = 0.95;  // explained in a small window
constexpr double same_period = 0.03;    // relative difference
constexpr double coherent = 0.7;        // of the share in a small window, also in the whole
constexpr double negligible = 0.004;    // of the whole mean square
constexpr double slowest_lattice = 4;   // periods over the patch
constexpr double too_fine = 0.97;       // of the mean square: nothing is left to search in this window
constexpr std::size_t lattice_parts = 20;
constexpr std::size_t finer_lattice_parts = 40;
constexpr std::size_t lattice_places = 9000;
constexpr double least_lattice = 0.6;
constexpr double most_joined_harmonic = 24;  // that is found before the wave whose harmonic it is
constexpr double least_turn = 0.2;           // rad between two directions

/// Every fourth place or so, chosen as if by chance: a regular choice would alias.
StillForces thinned_by_chance(const StillForces& window, const std::vector<glm::dvec2>& forces, std::size_t about) {
  StillForces thin{window.side, window.centre, window.size, {}, {}};
  thin.places.reserve(about + about / 8), thin.forces.reserve(about + about / 8);
  std::uint64_t random = 88172645463325252u;  // Marsaglia's xorshift
  for (std::size_t i = 0; i < forces.size(); ++i) {
    random ^= random << 13, random ^= random >> 7, random ^= random << 17;
    if ((random >> 32) * forces.size() >> 32 >= about) continue;
    thin.places.push_back(window.places[i]), thin.forces.push_back(forces[i]);
  }
  return thin;
}

/// Moves waves so slow that quarters of the window hold too little of them to where they explain most.
glm::dvec2 best_explained(const StillForces& thin, glm::dvec2 waves) {
  constexpr std::size_t bins = 24;
  double step = 0.25;  // periods over the window
  double best = explained_by(thin.places, thin.forces, waves, bins);
  while (step > 0.01) {
    bool moved = false;
    for (const glm::dvec2 aside : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
      const glm::dvec2 other = waves + step * aside / thin.size;
      const double here = explained_by(thin.places, thin.forces, other, bins);
      if (here > best) best = here, waves = other, moved = true;
    }
    if (!moved) step *= 0.5;
  }
  return waves;
}

/// Searches the waves of one program.
class WaveSearch {
 public:
  WaveSearch(const StillField& field, const StillForces& whole, const std::vector<Feature>& features)
      : field_(field), whole_(whole), features_(features) {
    update_rest();
    found_.trend = linear_force(whole.places, found_.rest);
    update_rest();
    all_ = mean_square(found_.rest);
  }

  FoundWaves search() {
    if (!(all_ > 0)) return std::move(found_);
    StillForces closer_window;
    std::vector<glm::dvec2> rest_there;
    const StillForces* window = &whole_;
    const std::vector<glm::dvec2>* forces = &found_.rest;  // in the window
    bool again = false;
    for (std::size_t level = 0;; ++level) {
      WindowSpectrum spectrum(*window, *forces);
      while (found_.waves.size() < most_waves_found && mean_square(*forces) > 0 &&
             next_wave(*window, *forces, spectrum, level)) {
        if (found_.local) return finished();
        if (mean_square(found_.rest) < negligible * all_) return finished();
        if (level > 0) rest_there = rest_at(window->places, window->forces);
        spectrum = WindowSpectrum(*window, *forces);
        again |= level > 0;
      }
      // Without its fine waves the whole may show slow ones that were too small a part of it.
      if (again && found_.waves.size() < most_waves_found) {
        again = false, level = 0, window = &whole_, forces = &found_.rest;
        spectrum = WindowSpectrum(*window, *forces);
        while (found_.waves.size() < most_waves_found && next_wave(*window, *forces, spectrum, level))
          spectrum = WindowSpectrum(*window, *forces);
        if (mean_square(found_.rest) < negligible * all_) return finished();
      }
      if (level == 0 && find_lattice(spectrum)) return finished();
      const bool finer = spectrum.finer() * mean_square(*forces) > 0.5 * negligible * all_;
      const bool enough = level == 0 ? !finer && !found_.waves.empty() : !finer;
      if (enough || level == closer.size() || found_.waves.size() == most_waves_found) return finished();
      const double longest = std::max(whole_.size.x, whole_.size.y);
      const glm::dvec2 size = glm::min(glm::dvec2(longest / closer[level]), whole_.size),
                       room = 0.5 * (whole_.size - size);
      glm::dvec2 centre = level == 0 ? busiest_place(whole_, found_.rest) : window->centre;
      centre = glm::clamp(centre, whole_.centre - room, whole_.centre + room);
      closer_window = still_forces(field_, centre, size, closer_side);
      rest_there = rest_at(closer_window.places, closer_window.forces);
      window = &closer_window, forces = &rest_there;
    }
  }

 private:
  std::vector<glm::dvec2> rest_at(const std::vector<glm::dvec2>& places, std::vector<glm::dvec2> forces) const {
    for (std::size_t i = 0; i < places.size(); ++i) {
      forces[i] -= found_.trend.at(places[i]);
      if (!features_.empty()) forces[i] = beside(features_, places[i], forces[i]);
      for (const FoundWave& each : found_.waves) forces[i] -= each.wave.at(places[i]);
    }
    return forces;
  }
  void update_rest() { found_.rest = rest_at(whole_.places, whole_.forces); }

  /// Finds one more wave in a window and takes it off. False if there is none.
  bool next_wave(const StillForces& window, const std::vector<glm::dvec2>& forces, const WindowSpectrum& spectrum,
                 std::size_t level) {
    if (spectrum.finer() > too_fine) return false;
    const StillForces thin = thinned_by_chance(window, forces, 5000);
    for (glm::dvec2 peak : spectrum.peaks(candidates, level == 0 ? 1.4 : 4)) {
      const glm::dvec2 rough = peak;
      const double periods = glm::length(peak) * length_along(window.size, peak);
      if (periods > 5)
        peak = in_phase(thin.places, thin.forces, window.centre, window.size, peak);
      else
        peak = best_explained(thin, peak);
      const double moved = glm::length((peak - rough) * window.size);
      if (!(moved < 2)) continue;
      if (periods > 5)
        for (int turn = 0; turn < 2; ++turn) peak = better_fitting(thin.places, thin.forces, peak, 16);
      const Fundamental fundamental = fundamental_of(thin, peak);
      const double held = glm::length(fundamental.waves) * length_along(window.size, fundamental.waves);
      // In noise a wave explains the less the more of its periods there are.
      const double least = level > 0 || held > many_periods ? least_explained_by_many
                           : held < few_periods             ? least_explained_by_few
                                                            : least_explained;
      // A window that is hardly longer than a wave shows one all the same, if nothing else is there.
      const double fewest = level == 0 ? 1.9 : fundamental.explained < plainly_there ? 4 : 2.9;
      if (held < fewest || fundamental.explained < least) continue;
      if (level == 0) return take_off(fundamental.waves, fundamental);
      const auto wider = widened(window, fundamental);
      if (wider) return take_off_wider(*wider, fundamental);
      if (fundamental.explained < least_explained_locally || !found_.waves.empty() ||
          !holds_where_it_is(window, fundamental))
        continue;
      keep_local(window, forces, fundamental);
      return true;
    }
    return false;
  }

  /// The waves of a fundamental that was found in a small window, made exact over the whole patch; nothing if they do
  /// not hold there.
  std::optional<glm::dvec2> widened(const StillForces& window, const Fundamental& fundamental) const {
    glm::dvec2 waves = fundamental.waves, size = window.size;
    // The strongest harmonic has the finest phase.
    const auto multiple = static_cast<double>(fundamental.multiple);
    while (size.x < whole_.size.x * 0.99 || size.y < whole_.size.y * 0.99) {
      size = glm::min(3.0 * glm::dvec2(std::max(size.x, size.y)), whole_.size);
      const glm::dvec2 room = 0.5 * (whole_.size - size);
      const glm::dvec2 centre = glm::clamp(window.centre, whole_.centre - room, whole_.centre + room);
      const StillForces wide = still_forces(field_, centre, size, 56);
      const std::vector<glm::dvec2> forces = rest_at(wide.places, wide.forces);
      waves = in_phase(wide.places, forces, centre, size, waves * multiple) / multiple;
      const double here = explained_by(wide.places, forces, waves,
                                       most_bins(parts_of_a_wave * fundamental.multiple / 2, forces.size()));
      // Slower waves that a small window does not show share the whole patch with these.
      if (here < 0.05 || (here < coherent * fundamental.explained && size == whole_.size &&
                          here * mean_square(forces) < 0.2 * mean_square(found_.rest)))
        return std::nullopt;
    }
    return waves;
  }

  /// Whether the same wave is found far from the window, in any phase, wherever the force is nearly as strong there.
  /// The period of a chirp is that of one place only.
  bool holds_where_it_is(const StillForces& window, const Fundamental& fundamental) const {
    const double here = mean_square(rest_at(window.places, window.forces));
    const glm::dvec2 room = 0.5 * (whole_.size - window.size);
    int strong = 0, held = 0;
    for (const glm::dvec2 way : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
      const glm::dvec2 centre =
          glm::clamp(window.centre + 0.25 * way * whole_.size, whole_.centre - room, whole_.centre + room);
      const StillForces beside = still_forces(field_, centre, window.size, 56);
      const std::vector<glm::dvec2> forces = rest_at(beside.places, beside.forces);
      if (mean_square(forces) < 0.3 * here) continue;
      strong += 1;
      // The strongest harmonic tells whether the period has changed.
      const auto multiple = static_cast<double>(fundamental.multiple);
      const glm::dvec2 waves =
          in_phase(beside.places, forces, centre, window.size, multiple * fundamental.waves) / multiple;
      const double stretched = glm::length(waves) / glm::length(fundamental.waves);
      held +=
          std::abs(stretched - 1) < same_period &&
          explained_by(beside.places, forces, waves,
                       most_bins(parts_of_a_wave * fundamental.multiple / 2, forces.size())) >= least_explained_locally;
    }
    return 4 * held >= 3 * strong;
  }

  /// Takes off a wave that was found in a small window. If it leaves much, it may be a part of a longer one, of which
  /// the window holds too few periods.
  bool take_off_wider(glm::dvec2 waves, const Fundamental& fundamental) {
    if (fundamental.explained >= plainly_there) return take_off(waves, fundamental);
    const StillForces thin = thinned_by_chance(whole_, found_.rest, 5000);
    Fundamental longer = fundamental_of(thin, waves);
    const bool better = longer.multiple > 1 && longer.explained >= plainly_there;
    if (!better) return take_off(waves, fundamental);
    longer.multiple *= fundamental.multiple;
    return take_off(longer.waves, longer);
  }

  bool take_off(glm::dvec2 waves, const Fundamental& fundamental) {
    const std::size_t bins = most_bins(2 * parts_of_a_wave * fundamental.multiple, whole_.places.size() / 4);
    FoldedWave wave = folded(whole_.places, found_.rest, waves, std::max<std::size_t>(bins, 192));
    if (wave.explained < 0.02) return false;
    found_.waves.push_back({std::move(wave), 0, fundamental.parts});
    fit_together(is_slow(waves));
    // Over the whole patch the harmonics are clean: if only every so many-th is there, the wave is that much shorter.
    FoundWave& last = found_.waves.back();
    const std::vector<double> powers = harmonics_of(last.wave, std::min<std::size_t>(60, last.wave.profile.size() / 3));
    std::size_t step = 0;
    for (std::size_t i = 0; i < powers.size(); ++i)
      if (powers[i] >= weak_part) step = std::gcd(step, i + 1);
    if (step > 1 && last.parts.size() == 1) shorten(last, step);
    join_harmonics();
    StillForces some = every(3);
    some.forces = rest_at(some.places, std::move(some.forces));
    fit_trend(some);
    update_rest();
    for (FoundWave& each : found_.waves) each.power = mean_square(each.wave.profile);
    return true;
  }

  /// Finds a wave anew whose harmonics are all multiples of one.
  void shorten(FoundWave& found, std::size_t step) {
    add_to_rest(found.wave, 1);
    found.wave = folded(whole_.places, found_.rest, static_cast<double>(step) * found.wave.waves,
                        std::max<std::size_t>(found.wave.profile.size() / step, 64));
    add_to_rest(found.wave, -1);
  }

  /// A wave that lay nearly where a part of a sum does looked like one until it was found itself.
  void drop_parts_that_are_gone() {
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

  /// The number of a wave among the harmonics of a coarser one; 0 if it is none.
  std::size_t harmonic_of(const FoundWave& coarse, const FoundWave& fine) const {
    const double ratio = glm::dot(fine.wave.waves, coarse.wave.waves) / glm::dot(coarse.wave.waves, coarse.wave.waves);
    const double number = std::round(ratio);
    const glm::dvec2 off = (fine.wave.waves - number * coarse.wave.waves) * whole_.size;
    return std::abs(number) >= 2 && std::abs(number) <= most_joined_harmonic && glm::length(off) < out_of_place
               ? static_cast<std::size_t>(std::abs(number))
               : 0;
  }

  /// Joins waves that are harmonics of another one to it, unless they are waves of their own.
  void join_harmonics() {
    for (std::size_t coarse = 0; coarse < found_.waves.size(); ++coarse)
      for (std::size_t fine = 0; fine < found_.waves.size(); ++fine) {
        const std::size_t number = harmonic_of(found_.waves[coarse], found_.waves[fine]);
        if (number == 0 || found_.waves[coarse].parts.size() > 1 || found_.waves[fine].parts.size() > 1) continue;
        FoundWave &one = found_.waves[coarse], &other = found_.waves[fine];
        std::vector<glm::dvec2> forces = found_.rest;
        for (std::size_t i = 0; i < forces.size(); ++i)
          forces[i] += one.wave.at(whole_.places[i]) + other.wave.at(whole_.places[i]);
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

  /// Fits the trend and all waves, the last of which is new, in turn: at few places, at more, then once at all.
  void fit_together(bool slow) {
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
        add_wave(each.wave, 1, some);
        const glm::dvec2 waves = better_fitting(some.places, some.forces, each.wave.waves, bins / 4);
        each.wave = folded(some.places, some.forces, waves, bins);
        add_wave(each.wave, -1, some);
      }
      if (!slow && mean_square(some.forces) < negligible * all_) turn = std::max(turn, turns - 2);
    }
    update_rest();
    for (FoundWave& each : found_.waves) {
      add_to_rest(each.wave, 1);
      each.wave = folded(whole_.places, found_.rest, each.wave.waves, each.wave.profile.size());
      add_to_rest(each.wave, -1);
    }
  }

  static void add_wave(const FoldedWave& wave, double times, StillForces& still) {
    for (std::size_t i = 0; i < still.places.size(); ++i) still.forces[i] += times * wave.at(still.places[i]);
  }
  void add_to_rest(const FoldedWave& wave, double times) {
    for (std::size_t i = 0; i < whole_.places.size(); ++i) found_.rest[i] += times * wave.at(whole_.places[i]);
  }
  /// Every so-many-th place of the whole. They lie anywhere in their cells, so that no choice among them aliases.
  StillForces every(std::size_t step) const {
    StillForces some{whole_.side, whole_.centre, whole_.size, {}, {}};
    for (std::size_t i = 0; i < whole_.places.size(); i += step)
      some.places.push_back(whole_.places[i]), some.forces.push_back(whole_.forces[i]);
    return some;
  }

  /// The linear part of what the waves leave. Slow waves are fitted with it: a few periods look a little like a slope.
  void fit_trend(StillForces& rest) {
    std::vector<glm::dvec2> slow, forces = rest.forces;
    for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += found_.trend.at(rest.places[i]);
    for (const FoundWave& each : found_.waves) {
      if (!is_slow(each.wave.waves)) continue;
      slow.push_back(each.wave.waves);
      // Beyond the harmonics that are fitted with it.
      for (const std::size_t part : each.parts)
        if (part > harmonics_beside) slow.push_back(static_cast<double>(part) * each.wave.waves);
      for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += each.wave.at(rest.places[i]);
    }
    const LinearForce before = found_.trend;
    found_.trend = slow.empty() ? linear_force(rest.places, forces) : linear_beside(rest.places, forces, slow);
    const LinearForce more{before.mean - found_.trend.mean, before.by_x - found_.trend.by_x,
                           before.by_y - found_.trend.by_y};
    for (std::size_t i = 0; i < forces.size(); ++i) rest.forces[i] += more.at(rest.places[i]);
  }
  bool is_slow(glm::dvec2 waves) const { return glm::length(waves * whole_.size) < slow_periods; }

  void keep_local(const StillForces& window, const std::vector<glm::dvec2>& forces, const Fundamental& fundamental) {
    FoldedWave wave = folded(window.places, forces, fundamental.waves,
                             most_bins(2 * parts_of_a_wave * fundamental.multiple, forces.size() / 4));
    found_.share = wave.explained;
    const double power = mean_square(wave.profile);
    found_.waves.push_back({std::move(wave), power, fundamental.parts});
    found_.local = true;
  }

  bool find_lattice(const WindowSpectrum& spectrum) {
    if (mean_square(found_.rest) < 0.1 * all_) return false;
    std::vector<glm::dvec2> peaks;
    for (const FoundWave& each : found_.waves) peaks.push_back(each.wave.waves);
    const StillForces left = thinned_by_chance(whole_, rest_at(whole_.places, whole_.forces), lattice_places);
    if (peaks.size() < 2)
      for (const glm::dvec2 peak : spectrum.peaks(6, 5))
        peaks.push_back(in_phase(left.places, left.forces, whole_.centre, whole_.size, peak));
    StillForces all = left;
    for (std::size_t i = 0; i < all.places.size(); ++i)
      for (const FoundWave& each : found_.waves) all.forces[i] += each.wave.at(all.places[i]);
    Lattice best;
    double fewest = HUGE_VAL;
    for (std::size_t i = 0; i < std::min<std::size_t>(peaks.size(), 2); ++i)
      for (std::size_t j = i + 1; j < peaks.size(); ++j) {
        const double turn = std::abs(peaks[i].x * peaks[j].y - peaks[i].y * peaks[j].x);
        if (turn < least_turn * glm::length(peaks[i]) * glm::length(peaks[j])) continue;
        for (const double a : {1.0, 2.0, 3.0})
          for (const double b : {1.0, 2.0, 3.0}) {
            if (glm::length(peaks[i] / a * whole_.size) < slowest_lattice ||
                glm::length(peaks[j] / b * whole_.size) < slowest_lattice)
              continue;
            const double share =
                explained_by_lattice(all.places, all.forces, peaks[i] / a, peaks[j] / b, lattice_parts);
            const double cell = a * b / turn;
            if (share > best.share + 0.03 || (share > best.share - 0.03 && cell < 0.9 * fewest))
              best = {peaks[i] / a, peaks[j] / b, share}, fewest = cell;
          }
      }
    if (best.share < least_lattice || best.share < 1 - mean_square(found_.rest) / all_ + 0.01) return false;
    // Narrow wires need finer parts than the search does.
    std::vector<glm::dvec2> forces = found_.rest;
    for (std::size_t i = 0; i < forces.size(); ++i)
      for (const FoundWave& each : found_.waves) forces[i] += each.wave.at(whole_.places[i]);
    for (int turn = 0; turn < 2; ++turn)
      for (glm::dvec2* each : {&best.one, &best.other}) *each = better_fitting(whole_.places, forces, *each, 24);
    best.share =
        std::max(best.share, explained_by_lattice(whole_.places, forces, best.one, best.other, finer_lattice_parts));
    found_.lattice = best;
    return true;
  }

  /// A harmonic that two waves share belongs to the one that has others beside it.
  void settle_shared_harmonics() {
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

  FoundWaves finished() {
    if (found_.local) return std::move(found_);
    drop_parts_that_are_gone();
    settle_shared_harmonics();
    const double rest = mean_square(found_.rest);
    double waves = 0;
    for (const FoundWave& each : found_.waves) waves += each.power;
    found_.share = waves + rest > 0 ? waves / (waves + rest) : 0;
    if (found_.lattice) found_.share = std::max(found_.share, found_.lattice->share);
    std::ranges::stable_sort(found_.waves, std::greater(), &FoundWave::power);
    return std::move(found_);
  }

  const StillField& field_;
  const StillForces& whole_;
  const std::vector<Feature>& features_;
  FoundWaves found_;
  double all_ = 0;  // N^2, without the first trend
};

}  // namespace

FoundWaves find_waves(const StillField& field, const StillForces& whole, const std::vector<Feature>& features) {
  return WaveSearch(field, whole, features).search();
}

}  // namespace wale
