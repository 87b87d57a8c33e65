#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/expression/checked_experiment.hpp"

namespace wale {

/// Random numbers that each are a function of a seed, a purpose and a number, so that a session that goes on draws the
/// same ones. The same on every machine.
class Draws {
 public:
  Draws(std::uint32_t seed, std::uint32_t purpose);

  /// Uniform in 0 .. 2^64 - 1.
  std::uint64_t bits(std::uint64_t number) const;
  /// Uniform in [0, 1).
  double uniform(std::uint64_t number) const;
  /// Normal with mean 0 and standard deviation 1.
  double normal(std::uint64_t number) const;
  /// 0 .. `count` - 1 in a random order.
  std::vector<std::size_t> order(std::size_t count, std::uint64_t number) const;

 private:
  std::uint64_t key_;
};

/// What numbers are drawn for. They are stored in no file, but logs hold what came of them: do not renumber.
enum class Drawn : std::uint32_t { practice = 1, block, interval, catch_trial, track, start, labels, observer };

/// A stimulus or a standard of an experiment in one interval of a trial.
struct Presented {
  bool is_standard = false;
  std::size_t index = 0;  ///< in `CheckedExperiment::stimuli` or `standards`
  friend bool operator==(const Presented&, const Presented&) = default;
};

/// One trial.
struct Trial {
  std::uint32_t number = 0;  ///< from 1; practice comes first
  std::uint32_t block = 0;   ///< from 1; 0: practice
  std::size_t stimulus = 0;  ///< that it is about
  std::vector<Presented> intervals;
  int target = 0;  ///< of two intervals that with the stimulus, 1 or 2; in one, 1 if it is the stimulus, else 0; of a
                   ///< pair 1 if they differ
  friend bool operator==(const Trial&, const Trial&) = default;
};

/// The trial of that number about a stimulus: its intervals in an order that the seed gives.
Trial trial_about(const CheckedExperiment& experiment, std::uint32_t seed, std::size_t stimulus, std::uint32_t number,
                  std::uint32_t block);

/// The trials of practice, and of all blocks unless an adaptive method chooses these. None for sorting.
std::vector<Trial> trial_order(const CheckedExperiment& experiment, std::uint32_t seed);

/// The stimuli that differ in nothing but the factor along which the experiment moves, from its lowest level to its
/// highest; all other stimuli apart. In the order in which the first of each is written.
std::vector<std::vector<std::size_t>> tracks_of(const CheckedExperiment& experiment);

/// Whether the trials after practice are chosen by the answers.
bool is_adaptive(const CheckedExperiment& experiment);

}  // namespace wale
