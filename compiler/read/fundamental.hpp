#pragma once

#include <cstddef>
#include <vector>

#include "compiler/read/fold.hpp"

namespace wale {

inline constexpr std::size_t most_waves_found = 3;
inline constexpr std::size_t parts_of_a_wave = 32;  // of the shortest wave that a fold should show
inline constexpr double strong_part = 0.02;         // of a wave's mean square, in one of its harmonics
inline constexpr double out_of_place = 0.25;        // periods over a window: no longer the same wave
inline constexpr double weak_part = 0.004;          // of a wave's mean square: a harmonic that counts as there

/// How many periods of `other` one period of `wave` holds, if that is a whole number over a window of `size` (m):
/// negative if the two are counted the other way round; 0 if it is none.
int whole_periods(glm::dvec2 wave, glm::dvec2 other, glm::dvec2 size);

/// The longest line in a direction across a window.
double length_along(glm::dvec2 size, glm::dvec2 direction);

/// As many bins as are wanted, unless the places are too few for them.
std::size_t most_bins(std::size_t wanted, std::size_t places);

/// The mean squares of a profile's harmonics, from the first on, as shares of all.
std::vector<double> harmonics_of(const FoldedWave& wave, std::size_t most);

/// The number of a fine wave among the harmonics of a coarse one, by their powers (shares of all, from the first on):
/// nothing lies between it and the harmonics that the coarse wave has. 0 if there is none.
std::size_t fine_wave(const std::vector<double>& powers);

/// Whether a long period only says how often a much shorter wave wavers, or comes and goes: all its harmonics (their
/// powers, from the first on) stand close about that of the carrier and its multiples. Then this is how many periods of
/// the harmonic `strongest` the carrier has; 0 if it is no such wave.
std::size_t carrier_of(const std::vector<double>& powers, std::size_t strongest);

/// A wave in a window: what `multiple` times the period of a peak explains.
struct Fundamental {
  glm::dvec2 waves{0};
  std::size_t multiple = 1;
  double explained = 0;
  /// The waves of which it is the sum, if they share a short period: their numbers of periods in it. Otherwise 1 alone.
  std::vector<std::size_t> parts = {1};
};

/// The fundamental of the wave whose strongest harmonic is at a peak: the shortest multiple of its period that explains
/// nearly as much as any. Where several waves share a long period, it is that of the peak's own wave.
/// `may_lie_beside`: the peak may lie beside the wave; otherwise it is what was found of it there.
Fundamental fundamental_of(const StillForces& thin, glm::dvec2 peak, bool may_lie_beside = true);

}  // namespace wale
