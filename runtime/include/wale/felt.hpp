#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "wale/program.hpp"
#include "wale/record.hpp"

namespace wale {

/// The size of a force over some ticks, N: of its magnitude, when it has two axes. 99 % of the ticks are at most at
/// `p99`.
struct ForceSize {
  float p99 = 0, maximum = 0, rms = 0;
};

/// How a record is read.
struct MeasureOptions {
  double position_step = 0;       ///< m per encoder count
  float predicted_amplitude = 0;  ///< N; crossings swing through half of it. 0: half the force's own P99
  double settling = 0;            ///< s at the beginning that do not count: the slew-in and the hand's own start
  double stuck_seconds = 0.05;    ///< the hand is stuck where it moves at most
  double stuck_counts = 2;        ///< this many encoder counts, on either axis, within that time
  bool vibrates = false;          ///< the record is of a pad
};

/// How a pad shook over the ticks within the patch.
struct FeltVibration {
  ForceSize acceleration;         ///< m/s^2, of the amplitude
  float lowest = 0, highest = 0;  ///< Hz, in the ticks in which it shook with half of its P99 or more
  long ticks = 0;                 ///< within the patch
};

/// What a run felt like, in figures. Of a pad there is the vibration, and the forces are 0.
struct Felt {
  long ticks = 0;                                ///< measured: after settling
  long ticks_rubbing = 0;                        ///< of them, those within the patch with the hand not stuck
  ForceSize force;                               ///< the actuator's, over all measured ticks
  ForceSize force_rubbing;                       ///< the actuator's, while rubbing
  std::optional<ForceSize> interaction;          ///< between hand and handle; nothing where the device cannot tell
  std::optional<ForceSize> interaction_rubbing;  ///< the same while rubbing
  /// Swings of the force from beyond half the amplitude on one side to beyond it on the other, along the axis that has
  /// more force: all of them.
  long alternations = 0;
  /// Those made while moving on in one direction, so that a limit cycle on the spot, a spring or oil count nothing:
  /// flanks of a texture.
  long crossings = 0;
  double stuck = 0;                        ///< fraction of the measured ticks within the patch; 0 when there are none
  std::optional<FeltVibration> vibration;  ///< of a run on a pad
  double position_rms = 0;                 ///< m about the mean position
  double position_range = 0;               ///< m, the larger of the two axes'
};

Felt measure(const Record& record, const MeasureOptions& options);

/// What the measured force says about a percept of the program, or why it says nothing.
struct LevelBack {
  std::size_t percept = 0;        ///< index into the program's percepts
  std::string name;               ///< "roughness"
  float predicted_amplitude = 0;  ///< what the program aims at, in the carrier's unit
  std::variant<Prediction, Refusal> back;
};

/// Reads every percept back from the actuator's P99 while rubbing, through the map that the program carries. Refused
/// for less than `least_crossings` crossings, for a percept that a static lateral force does not carry, and for one
/// whose carrier does not push alone. Of a pad from the P99 of its acceleration within the patch.
std::vector<LevelBack> levels_back(const Bank& bank, const Felt& felt, long least_crossings = 50);

/// The lateral force that the program aims at, for `MeasureOptions`, or a pad's acceleration: of its first percept that
/// has one, else 0.
float predicted_amplitude(const Bank& bank);

}  // namespace wale
