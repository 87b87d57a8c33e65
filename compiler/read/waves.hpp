#pragma once

#include <optional>
#include <vector>

#include "compiler/read/features.hpp"
#include "compiler/read/fold.hpp"
#include "compiler/read/still_forces.hpp"

namespace wale {

/// A wave of a static force and where it was found.
struct FoundWave {
  FoldedWave wave;
  double power = 0;  ///< N^2: its mean square, over the patch or, for a local wave, where it was found
  /// The waves of which it is the sum if these share a short period: their numbers of periods in it. A wave that
  /// wavers, or comes and goes, and is the same again after this wave's period, has its own number of periods alone.
  /// Otherwise 1.
  std::vector<std::size_t> parts = {1};

  /// Periods over a metre: of the wave that is felt, which may waver.
  glm::dvec2 felt() const { return (parts.size() == 1 ? static_cast<double>(parts.front()) : 1.0) * wave.waves; }
};

/// A wave of which another one is the sum.
struct WavePart {
  std::size_t number = 1;  ///< of its periods in one of the sum's
  double share = 1;        ///< 0 .. 1: of the sum's mean square
};

/// The waves of which a wave is the sum, each with its harmonics; itself if it is no sum. A fine wave on a coarse one,
/// of which a whole number fits, looks like a harmonic: but nothing lies between it and what the coarse one has.
std::vector<WavePart> parts_of(const FoundWave& wave);

/// The first harmonic that two waves along one direction share: its number in either; 0 if they share none.
struct SharedHarmonic {
  std::size_t of_one = 0, of_other = 0;
};
/// `size` is the patch's, m.
SharedHarmonic shared_harmonic(const FoundWave& one, const FoundWave& other, glm::dvec2 size);
/// Whether a shared harmonic that `one` holds stands alone there, and has others beside it in `other`.
bool belongs_to_other(const FoundWave& one, const FoundWave& other, SharedHarmonic shared);
/// Takes a harmonic and its multiples off a wave.
void take_harmonic_off(FoldedWave& wave, std::size_t number);

/// Two directions in which a force repeats that is no sum of waves.
struct Lattice {
  glm::dvec2 one{0}, other{0};  ///< periods over a metre
  double share = 0;             ///< 0 .. 1: of the mean square, all that repeats

  double period() const;  ///< m: the shortest step after which it repeats
};

/// The repeating part of a static force: up to three waves of any waveform and period, or a lattice.
struct FoundWaves {
  std::vector<FoundWave> waves;  ///< strongest first
  std::optional<Lattice> lattice;
  /// The waves only hold in a part of the patch: they bend, or lie in a corner. Then `rest` contains them.
  bool local = false;
  double share = 0;              ///< 0 .. 1: the share of the mean square that repeats, where it was found
  std::vector<glm::dvec2> rest;  ///< N, at the places of the whole: what neither a wave nor the trend explains
  LinearForce trend;             ///< of the whole, beside the waves

  /// N, at the places of the whole: `rest` and the trend, all that is no wave.
  std::vector<glm::dvec2> without_waves(const std::vector<glm::dvec2>& places) const;
  /// m: after which the strongest wave and those along its direction repeat together, if that is a small multiple of
  /// their periods; otherwise the strongest wave's period.
  double period(glm::dvec2 size) const;
};

/// Finds the waves of the force in the patch without its rim, sampled as `whole`, beside the features that are known.
/// Finer windows are sampled where the whole has waves that are too fine for it. `known` (periods over a metre) is a wave
/// that is known to be there, with too few periods to be seen by its repeating.
FoundWaves find_waves(const StillField& field, const StillForces& whole, const std::vector<Feature>& features = {},
                      const std::optional<glm::dvec2>& known = std::nullopt);

/// Where the forces of a window change most.
glm::dvec2 busiest_place(const StillForces& window, const std::vector<glm::dvec2>& forces);

}  // namespace wale
