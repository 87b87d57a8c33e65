#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "compiler/read/features.hpp"
#include "compiler/read/obstacles.hpp"
#include "compiler/read/period_band.hpp"
#include "compiler/read/waves.hpp"
#include "wale/memory.hpp"

namespace wale {

/// One wave of a relief.
struct ReliefWave {
  double period = 0;       ///< m
  double orientation = 0;  ///< rad from the x axis, in [0, pi): the direction in which it changes
  double share = 0;        ///< 0 .. 1: of the mean square of the force
};

/// A program's static force over the patch without its rim, less its trends: springs, walls and edges.
struct Relief {
  double amplitude = 0;    ///< N: the 99th percentile of its size, as the amplitude of a lateral force is defined
  double maximum = 0;      ///< N: the definition of Minsky 1995, the largest force found
  double rms = 0;          ///< N
  double mean = 0;         ///< N: the mean of its size
  double transitions = 0;  ///< 1/m: sign changes along the direction in which it changes
  /// m: after which it repeats, whatever the waveform: the period of the strongest wave, or the shortest step of a
  /// lattice. If it does not repeat, the size of its grain; 0 without relief, and for a single hill.
  double period = 0;
  double orientation = 0;      ///< rad from the x axis, in [0, pi): the direction in which it changes
  std::optional<double> push;  ///< rad in [0, pi): the axis along which it pushes; nothing if it pushes along several
  double anisotropy = 0;       ///< 0: the same in every direction; 1: in one direction only
  double regularity = 0;       ///< 0 .. 1: the share of its mean square that repeats
  double steepness = 0;        ///< 1/m: the 99th percentile of its change with position, over its amplitude
  double crest = 0;            ///< the maximum of the strongest waveform over its root mean square; 0 without a wave
  /// How suddenly the strongest waveform changes: the largest change within a 16th of a period, against that of a sine
  /// of the same maximum. 1 of a sine, 0.64 of a triangle, 5.1 where it jumps from end to end; 0 without a wave.
  double abruptness = 0;
  /// By how much its pushes are stronger to one side than to the other, in the mean of its waves: the third moment of
  /// the force over the mean square to the power 3/2. A push to the right in a tenth of a period has (2.7, 0).
  glm::dvec2 skew{0};
  /// By how much it rises more steeply than it falls along a wave's direction: the same moment of its rises, of the
  /// force along that direction, and of that across it, to its left. Which way the hand goes changes nothing. A
  /// sawtooth that falls in a jump has about -3.6.
  double steeper_along = 0, steeper_across = 0;
  /// The waves, strongest first. A wave whose parts have a small common multiple is listed by its parts.
  std::vector<ReliefWave> waves;

  /// What the mean square consists of, by the period of the fundamental: harmonics count with their wave, irregular
  /// parts by themselves, and a single hill as a wave as long as half of the patch.
  struct Part {
    double period = 0;  ///< m
    double share = 0;   ///< 0 .. 1
  };
  std::vector<Part> parts;
  double beside_waves = 0;  ///< N: the largest force that the waves leave, if that is in one small place

  /// The size within a band, N: the amplitude times the root of the band's share of the mean square.
  double within(const PeriodBand& band) const;
  /// 0 .. 1: the share of the mean square in waves, if these do not all repeat after one short period. Otherwise 0, and
  /// it is the regularity.
  double repeating = 0;
  /// N: of the waves beside the strongest one, as of the amplitude.
  double beside_strongest() const;
  /// N: the largest force found, if that is much larger than the amplitude: of a feature that fills less than a
  /// hundredth of the patch; or what such a one adds to waves. 0 otherwise.
  double small_feature() const;
  /// Whether it repeats, so that it has a period.
  bool regular() const { return amplitude > 0 && in_waves() >= 0.5; }
  /// 0 .. 1: the share of the mean square in waves, whether they repeat together or not.
  double in_waves() const { return std::max(regularity, repeating); }
  /// Whether it changes mostly in one direction, so that this direction has a meaning.
  bool oriented() const { return amplitude > 0 && anisotropy >= 0.5; }
};

/// The static force in parts.
struct StaticForce {
  double largest = 0;             ///< N: the 99th percentile of the whole force on hands at rest
  LinearForce trend;              ///< the linear part, without the relief's; zero if features take its place
  bool pushes_away = false;       ///< the linear part points outward
  std::vector<Feature> features;  ///< walls, edges, springs that saturate, single hills
  /// Walls and steps that explain all beside the linear part and the relief: then they are the features.
  Obstacles obstacles;
  /// The device's limit, or the author's, cuts trends off. They are told as they are where it does not.
  bool cut_off = false;
  bool part_is_cut = false;  ///< by a limit of a part of the force, beside others that it does not limit
  double cut_at = 0;         ///< N: where a trend grows no more that is cut off; 0 if none is
  double beyond_cut = 0;     ///< N/m: of the force beside a part that is cut; 0 if that does not change evenly
  Relief relief;
};

/// What a field of forces was asked when it was read, and what it told. The reading follows from the answers alone, so
/// another field that gives the same ones reads the same, to the bit.
struct StaticTranscript {
  struct Question {
    std::vector<glm::dvec2> places, forces;  ///< m, N
  };
  PatchSize size{};
  std::vector<Question> questions;
  std::optional<StaticForce> found;  ///< nothing if limits had a part in it
};

/// Runs the program at this bank's parameters, at as many places as its detail needs. Deterministic. An empty
/// `transcript` is written; of one that is full, `found` is given back where this program answers all its questions as
/// they were answered. An analysis takes several times as long as the answers.
StaticForce static_force(const Bank& bank, StaticTranscript* transcript = nullptr);

/// The same of the surface that the program shows, with heights in place of forces: in micrometres, or
/// millionths of a plain number.
Relief picture_relief(const Bank& bank, const Memory* memory = nullptr);

}  // namespace wale
