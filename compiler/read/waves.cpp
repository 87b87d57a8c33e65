#include "compiler/read/waves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "compiler/read/fitted_waves.hpp"
#include "compiler/read/fundamental.hpp"
#include "compiler/read/pair_of_waves.hpp"
#include "compiler/read/window_spectrum.hpp"

namespace wale {
namespace {

constexpr std::array<double, 3> closer = {4, 16, 96};  // windows are so many times smaller than the patch
constexpr std::size_t closer_side = 128;
constexpr std::size_t candidates = 5;
constexpr double least_explained = 0.3;           // of what is left, by a wave ...
constexpr double least_explained_by_few = 0.7;    // ... and by one with few periods
constexpr double least_explained_by_many = 0.12;  // ... and by one with many
constexpr double few_periods = 6, many_periods = 25;
constexpr double least_explained_locally = 0.5;
constexpr double plainly_there = 0.95;  // explained in a small window
constexpr double same_period = 0.03;    // relative difference
constexpr double coherent = 0.7;        // of the share in a small window, also in the whole
constexpr double slowest_lattice = 4;   // periods over the patch
constexpr double too_fine = 0.97;       // of the mean square: nothing is left to search in this window
constexpr double few_waves_left = 0.5;        // of the mean square, too fine for the window
constexpr std::size_t places_of_few = 1500;
constexpr std::size_t lattice_parts = 20;
constexpr std::size_t finer_lattice_parts = 40;
constexpr std::size_t lattice_places = 9000;
constexpr double least_lattice = 0.6;
constexpr double least_turn = 0.2;  // rad between two directions

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
      : field_(field), whole_(whole), fitted_(whole, features) {}

  FoundWaves search(const std::optional<glm::dvec2>& known) {
    if (!(fitted_.all() > 0)) return fitted_.finished();
    if (known) {
      fitted_.take_off(*known, {.waves = *known, .explained = 1});
      if (mean_square(found_.rest) < negligible_rest * fitted_.all()) return fitted_.finished();
    }
    StillForces closer_window;
    std::vector<glm::dvec2> rest_there;
    const StillForces* window = &whole_;
    const std::vector<glm::dvec2>* forces = &found_.rest;  // in the window
    bool again = false;
    for (std::size_t level = 0;; ++level) {
      WindowSpectrum spectrum(*window, *forces);
      while (found_.waves.size() < most_waves_found && mean_square(*forces) > 0 &&
             next_wave(*window, *forces, spectrum, level)) {
        if (found_.local) return fitted_.finished();
        if (mean_square(found_.rest) < negligible_rest * fitted_.all()) return fitted_.finished();
        // Nothing more is searched in it.
        if (found_.waves.size() == most_waves_found && found_.waves.size() >= 2) break;
        if (level > 0) rest_there = fitted_.rest_at(window->places, window->forces);
        spectrum = WindowSpectrum(*window, *forces);
        again |= level > 0;
      }
      // Without its fine waves the whole may show slow ones that were too small a part of it.
      if (again && found_.waves.size() < most_waves_found) {
        again = false, level = 0, window = &whole_, forces = &found_.rest;
        spectrum = WindowSpectrum(*window, *forces);
        while (found_.waves.size() < most_waves_found && next_wave(*window, *forces, spectrum, level))
          spectrum = WindowSpectrum(*window, *forces);
        if (mean_square(found_.rest) < negligible_rest * fitted_.all()) return fitted_.finished();
      }
      if (level == 0 && two_of_few_periods(spectrum)) {
        if (mean_square(found_.rest) < negligible_rest * fitted_.all()) return fitted_.finished();
        spectrum = WindowSpectrum(*window, *forces);
      }
      if (level == 0 && find_lattice(spectrum)) return fitted_.finished();
      const bool finer = spectrum.finer() * mean_square(*forces) > 0.5 * negligible_rest * fitted_.all();
      const bool enough = level == 0 ? !finer && !found_.waves.empty() : !finer;
      if (enough || level == closer.size() || found_.waves.size() == most_waves_found) return fitted_.finished();
      const double longest = std::max(whole_.size.x, whole_.size.y);
      const glm::dvec2 size = glm::min(glm::dvec2(longest / closer[level]), whole_.size),
                       room = 0.5 * (whole_.size - size);
      glm::dvec2 centre = level == 0 ? busiest_place(whole_, found_.rest) : window->centre;
      centre = glm::clamp(centre, whole_.centre - room, whole_.centre + room);
      closer_window = still_forces(field_, centre, size, closer_side);
      rest_there = fitted_.rest_at(closer_window.places, closer_window.forces);
      window = &closer_window, forces = &rest_there;
    }
  }

 private:
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
      if (level == 0) return fitted_.take_off(fundamental.waves, fundamental);
      const auto wider = widened(window, fundamental);
      if (wider) return take_off_wider(*wider, fundamental);
      if (fundamental.explained < least_explained_locally || !found_.waves.empty() ||
          !holds_where_it_is(window, fundamental))
        continue;
      fitted_.keep_local(window, forces, fundamental);
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
      const std::vector<glm::dvec2> forces = fitted_.rest_at(wide.places, wide.forces);
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
    const double here = mean_square(fitted_.rest_at(window.places, window.forces));
    const glm::dvec2 room = 0.5 * (whole_.size - window.size);
    int strong = 0, held = 0;
    for (const glm::dvec2 way : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
      const glm::dvec2 centre =
          glm::clamp(window.centre + 0.25 * way * whole_.size, whole_.centre - room, whole_.centre + room);
      const StillForces beside = still_forces(field_, centre, window.size, 56);
      const std::vector<glm::dvec2> forces = fitted_.rest_at(beside.places, beside.forces);
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
    if (fundamental.explained >= plainly_there) return fitted_.take_off(waves, fundamental);
    const StillForces thin = thinned_by_chance(whole_, found_.rest, 5000);
    Fundamental longer = fundamental_of(thin, waves);
    const bool better = longer.multiple > 1 && longer.explained >= plainly_there;
    if (!better) return fitted_.take_off(waves, fundamental);
    longer.multiple *= fundamental.multiple;
    return fitted_.take_off(longer.waves, longer);
  }

  /// Finds two waves of which the patch holds so few periods that neither explains much alone, and takes them off.
  bool two_of_few_periods(const WindowSpectrum& spectrum) {
    if (!found_.waves.empty() || spectrum.finer() > few_waves_left) return false;
    const std::vector<glm::dvec2> first = spectrum.peaks(1, 1.4);
    if (first.empty() || glm::length(first.front()) * length_along(whole_.size, first.front()) > 2 * few_periods)
      return false;
    const std::vector<glm::dvec2> places = some_of(whole_.places, places_of_few),
                                  some = some_of(found_.rest, places_of_few);
    const HarmonicFit fit = fit_harmonics(places, some, first, whole_.size, parts_of_a_wave);
    if (fit.left > (1 - least_explained) * mean_square(some)) return false;
    // Beside the first one the second is no peak.
    const glm::dvec2 way = glm::normalize(first.front());
    const auto pair = best_pair_along(places, some, way, length_along(whole_.size, way));
    if (fitted_.take_off_together({pair[0], pair[1]})) return true;
    // Across each other, what the first leaves is the second, nearly.
    std::vector<glm::dvec2> left = found_.rest;
    for (std::size_t i = 0; i < left.size(); ++i) left[i] -= fit.line.at(whole_.places[i]);
    for (const FoldedWave& each : fit.waves) each.add_to(whole_.places, left, -1);
    const std::vector<glm::dvec2> second = WindowSpectrum(whole_, left).peaks(1, 1.4);
    return !second.empty() && fitted_.take_off_together({fit.waves.front().waves, second.front()});
  }

  bool find_lattice(const WindowSpectrum& spectrum) {
    if (mean_square(found_.rest) < 0.1 * fitted_.all()) return false;
    std::vector<glm::dvec2> peaks;
    for (const FoundWave& each : found_.waves) peaks.push_back(each.wave.waves);
    const StillForces left = thinned_by_chance(whole_, fitted_.rest_at(whole_.places, whole_.forces), lattice_places);
    if (peaks.size() < 2)
      for (const glm::dvec2 peak : spectrum.peaks(6, 5))
        peaks.push_back(in_phase(left.places, left.forces, whole_.centre, whole_.size, peak));
    StillForces all = left;
    for (const FoundWave& each : found_.waves) each.wave.add_to(all.places, all.forces, 1);
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
    if (best.share < least_lattice || best.share < 1 - mean_square(found_.rest) / fitted_.all() + 0.01) return false;
    // Narrow wires need finer parts than the search does.
    std::vector<glm::dvec2> forces = found_.rest;
    for (const FoundWave& each : found_.waves) each.wave.add_to(whole_.places, forces, 1);
    for (int turn = 0; turn < 2; ++turn)
      for (glm::dvec2* each : {&best.one, &best.other}) *each = better_fitting(whole_.places, forces, *each, 24);
    best.share =
        std::max(best.share, explained_by_lattice(whole_.places, forces, best.one, best.other, finer_lattice_parts));
    fitted_.keep_lattice(best);
    return true;
  }

  const StillField& field_;
  const StillForces& whole_;
  FittedWaves fitted_;
  const FoundWaves& found_ = fitted_.found();
};

}  // namespace

FoundWaves find_waves(const StillField& field, const StillForces& whole, const std::vector<Feature>& features,
                      const std::optional<glm::dvec2>& known) {
  return WaveSearch(field, whole, features).search(known);
}

}  // namespace wale
