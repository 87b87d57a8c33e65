#include "compiler/read/beside_waves.hpp"

#include <algorithm>
#include <utility>

#include "compiler/read/fundamental.hpp"
#include "compiler/read/harmonic_fit.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/window_spectrum.hpp"

namespace wale {
namespace {

constexpr std::size_t most_harmonics = 8;
constexpr double weak_harmonic = 1e-3;      // of a wave's mean square
constexpr double left_by_waves = 2e-3;      // of the mean square beyond a line: nothing stands beside the waves
constexpr double left_in_a_quarter = 0.01;  // of the mean square there: waves are all that it holds
constexpr double even_over_cells = 0.3;     // of the mean square
constexpr double left_beside_both = 0.02;   // of what a line leaves, by wall and wave
constexpr double few_harmonics = 0.3;       // ... or of a wave that jumps, by its first harmonics
constexpr double left_by_a_jumping_wave = 0.05;  // ... and by its whole form, where it jumps within a part of it
constexpr double times_noise_of_fine = 1.7;      // which means over cells may hold, beside a finer texture
constexpr std::size_t cells_a_mean_side = 4;     // as `cell_means` has them
constexpr std::size_t places_of_a_quarter = 2000, bins_of_a_wave = 96;

/// A quarter of the patch, by its corner; all of a lattice's places that lie in it.
StillForces quarter_of(const StillForces& whole, std::size_t corner) {
  const std::size_t side = whole.side / 2, top = corner / 2 * side, left = corner % 2 * side;
  StillForces quarter{side, whole.centre + 0.25 * whole.size * glm::dvec2(left > 0 ? 1 : -1, top > 0 ? 1 : -1),
                      0.5 * whole.size, {}, {}};
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column) {
      const std::size_t i = (top + row) * whole.side + left + column;
      quarter.places.push_back(whole.places[i]), quarter.forces.push_back(whole.forces[i]);
    }
  return quarter;
}

/// A part of the patch seen through means over small cells, which hardly hold what is finer.
struct WithoutFine {
  StillForces means;
  double noise = 0;  ///< N^2: what the finer leaves in them
};
WithoutFine without_fine(const StillForces& part) {
  const std::size_t side = part.side / cells_a_mean_side;
  WithoutFine found{
      {side, part.centre, part.size, cell_means(part.side, part.places), cell_means(part.side, part.forces)}};
  constexpr double cells = cells_a_mean_side * cells_a_mean_side;
  found.noise = (mean_square(part.forces) - mean_square(found.means.forces)) / cells;
  return found;
}

/// The forces less waves and a line that explain all of them in a quarter of the patch, but for `noise` (N^2); nothing
/// if none do. Both are then the same elsewhere, and what stands in the rest of the patch stands beside them. The waves
/// are put into `slow`.
std::optional<std::vector<glm::dvec2>> left_by_waves_of(const StillForces& quarter, double noise,
                                                        const StillForces& whole, double bent,
                                                        std::vector<SlowWave>& slow) {
  std::vector<glm::dvec2> rest = quarter.forces;
  const LinearForce line = linear_force(quarter.places, rest);
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= line.at(quarter.places[i]);
  const double by_line = mean_square(rest);
  if (by_line < least_force * least_force) return std::nullopt;
  const std::vector<glm::dvec2> peaks = WindowSpectrum(quarter, rest).peaks(1, 1.4);
  if (peaks.empty()) return std::nullopt;
  const std::vector<glm::dvec2> places = some_of(quarter.places, places_of_a_quarter),
                                forces = some_of(quarter.forces, places_of_a_quarter);
  HarmonicFit fit = fit_harmonics(places, forces, peaks, quarter.size, bins_of_a_wave);
  if (fit.left > few_harmonics * by_line) return std::nullopt;
  if (noise > 0 && fit.left > left_in_a_quarter * by_line + noise) return std::nullopt;
  if (noise == 0 && fit.left > left_in_a_quarter * by_line) {
    // What jumps has many more harmonics.
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = quarter.forces[i] - fit.line.at(quarter.places[i]);
    const glm::dvec2 exact = better_fitting(quarter.places, rest, fit.waves.front().waves, bins_of_a_wave);
    fit.waves = {folded(quarter.places, rest, exact, bins_of_a_wave)};
    fit.waves.front().add_to(quarter.places, rest, -1);
    if (mean_square(rest) > left_by_a_jumping_wave * by_line) return std::nullopt;
  }
  std::vector<glm::dvec2> left = whole.forces;
  for (std::size_t i = 0; i < left.size(); ++i) left[i] -= fit.line.at(whole.places[i]);
  for (const FoldedWave& each : fit.waves) {
    each.add_to(whole.places, left, -1);
    slow.push_back({each.waves, harmonics_worth({each})});
  }
  // What is left there belongs to what stands in the rest.
  return mean_square(left) > bent ? std::optional(std::move(left)) : std::nullopt;
}

/// Whether walls and steps alone are all that waves leave.
bool stand_alone(const StillForces& whole, const FoundWaves& waves) {
  return find_obstacles(whole, waves.without_waves(whole.places)).has_value();
}

}  // namespace

std::size_t harmonics_worth(const FoundWave& wave) {
  const std::vector<double> powers = harmonics_of(wave.wave, most_harmonics);
  std::size_t number = 1;
  for (std::size_t i = 0; i < powers.size(); ++i)
    if (powers[i] > weak_harmonic) number = i + 1;
  return number;
}

std::optional<BesideWaves> obstacles_beside_waves(const StillField& field, const StillForces& whole,
                                                  const std::vector<glm::dvec2>& beyond,
                                                  const std::vector<Feature>& features, const FoundWaves& waves) {
  if (waves.lattice) return std::nullopt;
  const double all = mean_square(beyond), least = std::max(least_force * least_force, left_by_waves * all);
  const double left = mean_square(waves.rest);
  if (features.empty() && left < least) return std::nullopt;
  // A wall is even over small cells. A texture that is no wave is not, and is left at once.
  if (features.empty() && mean_square(cell_means(whole.side, waves.rest)) < even_over_cells * left) return std::nullopt;
  std::optional<bool> alone;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const StillForces quarter = quarter_of(whole, corner);
    std::vector<SlowWave> slow;
    auto forces = left_by_waves_of(quarter, 0, whole, least, slow);
    // A step beside a texture looks like a slow wave in a quarter, too.
    if (!forces && !alone) alone = stand_alone(whole, waves);
    if (!forces && !*alone) {
      const WithoutFine seen = without_fine(quarter);
      forces = left_by_waves_of(seen.means, times_noise_of_fine * seen.noise, whole, least, slow);
    }
    if (!forces) continue;
    const auto obstacles = find_obstacles(whole, *forces);
    if (!obstacles || obstacles->empty() || obstacles->hill) continue;
    BesideWaves found{.obstacles = fitted_beside(*obstacles, slow, whole.places, whole.forces)};
    found.features = features_of(found.obstacles, whole.places);
    found.waves = find_waves(field, whole, found.features);
    if (found.waves.waves.empty() || found.waves.local || mean_square(found.waves.rest) > left_beside_both * all)
      continue;
    return found;
  }
  return std::nullopt;
}

}  // namespace wale
