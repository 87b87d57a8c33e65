#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wale/patch.hpp"
#include "wale/program.hpp"
#include "wale/record.hpp"
#include "wale/run.hpp"

namespace wale {

/// The size of a force over some ticks, N. With two axes it is the force's magnitude. 99 % of the ticks have `p99` or
/// less.
struct ForceSize {
  float p99 = 0, maximum = 0, rms = 0;
};

/// How a record is measured.
struct MeasureOptions {
  double position_step = 0;       ///< m per encoder count
  float predicted_amplitude = 0;  ///< N; less than half of it crosses nothing. 0: the force's own P99
  double settling = 0;            ///< s, left out at the beginning: forces slew in and the hand comes up to speed
  double stuck_seconds = 0.05;    ///< the hand counts as stuck if within this time it moves by no more than
  double stuck_counts = 2;        ///< this many encoder counts on each axis
  bool vibrates = false;          ///< the record is of a pad
  /// Hz, of the actuators on each axis: their forces are what one low-pass leaves of those that they were told. 0: they
  /// follow at once. Their delay takes nothing off.
  glm::dvec2 bandwidth{0};
  std::optional<std::uint32_t> change = {};  ///< only the ticks with this `TickRecord::change` count; empty: all do
};

/// How a pad shook over the ticks within the patch.
struct FeltVibration {
  ForceSize acceleration;         ///< m/s^2, of the amplitude
  float lowest = 0, highest = 0;  ///< Hz, in the ticks in which it shook with half of its P99 or more
  long ticks = 0;                 ///< within the patch
};

/// What a force would be by each of these laws if it obeyed that one alone; nothing where the hand's motion could not
/// show it.
struct FeltResponse {
  std::optional<float> drag;            ///< N: against the motion, at 20 mm/s and above
  std::optional<float> viscosity;       ///< N s/m: against the motion, over its speed
  std::optional<float> stiffness;       ///< N/m: along the axis on which the hand moves more
  std::optional<float> wall_stiffness;  ///< N/m: of a force that pushes one way, where it pushes
  std::optional<float> wall_damping;    ///< N s/m: of such a force, against a hand that moves in
  std::optional<float> mass;            ///< kg: against changes of velocity
  std::optional<float> shaking;         ///< N: the amplitude of a sine with the force's variance
};

/// The figures of a run. A run on a pad has the vibration, and its forces are 0. The actuator's forces are those that
/// come to the handle, as its bandwidth lets them through.
struct Felt {
  long ticks = 0;                                ///< measured: after settling
  long ticks_rubbing = 0;                        ///< of them, those within the patch with the hand not stuck
  ForceSize force;                               ///< the actuator's, over all measured ticks
  ForceSize force_rubbing;                       ///< the actuator's, while rubbing
  std::optional<ForceSize> interaction;          ///< between hand and handle; empty if the device does not measure it
  std::optional<ForceSize> interaction_rubbing;  ///< the same while rubbing
  /// All swings of the force that the device was told along the axis with more force, from the upper quarter of its range to the lower one or
  /// back. The range goes as far as the amplitude to either side, and a force below half of that has no swings.
  long alternations = 0;
  /// The alternations during which the hand keeps its direction: the flanks of a texture. A limit cycle at one place, a
  /// spring and oil have none. They are those of the whole force: where others push besides a texture, they are not the
  /// texture's.
  long crossings = 0;
  double stuck = 0;  ///< fraction of the measured ticks within the patch; 0 when there are none
  FeltResponse response;
  std::optional<FeltVibration> vibration;  ///< of a run on a pad
  double position_rms = 0;                 ///< m about the mean position
  double position_range = 0;               ///< m, the larger of the two axes'
};

Felt measure(const Record& record, const MeasureOptions& options);

/// The level of a percept that the measured force gives, or why it gives none.
struct LevelBack {
  std::size_t percept = 0;        ///< index into the program's percepts
  std::string name;               ///< "roughness"
  float predicted_amplitude = 0;  ///< what the program aims at, in the carrier's unit
  float size = 0;                 ///< of the carrier as measured, in its unit; 0 if it was not
  Result<Prediction> back;        ///< error: `not_measured`
};

/// Reads every percept back through the map that the program carries: a texture from the actuator's P99 while rubbing,
/// other percepts from the response of the force (`Felt::response`), on a pad from the P99 of its acceleration within
/// the patch. A level is an error if there are fewer than `least_crossings` crossings of a texture, if the hand's
/// motion could not show the carrier, or if the carrier is not the only force.
std::vector<LevelBack> levels_back(const Bank& bank, const Felt& felt, long least_crossings = 50);

/// What a hand felt of one patch.
struct FeltPatch {
  Felt felt;
  std::vector<LevelBack> levels;  ///< of all percepts of its program
};

/// Measures what the hand felt of one patch in a run of its stage, and reads its percepts back. Only the ticks on this
/// patch count, and if its program, parameters or size changed during the run, only those after the last change. Of
/// `options` the times and `stuck_counts` count; the rest comes from the stage. From any thread. Errors:
/// - `wrong_moment`: the patch was removed, its stage is gone, the run was one of another stage, or the patch's
///   program, parameters or size have changed since the run;
/// - `malformed_value`: `settling`, `stuck_seconds`, `stuck_counts` or `least_crossings` is negative or not finite;
/// - `not_measured`: the run kept no record, or the hand was not on the patch after `options.settling`.
Result<FeltPatch> measure(const RunResult& run, const Patch& patch, const MeasureOptions& options = {},
                          long least_crossings = 50);

/// The lateral force (N) or a pad's acceleration (m/s^2) that the program aims at, for `MeasureOptions`. It belongs to
/// the first percept that has one; without any it is 0.
float predicted_amplitude(const Bank& bank);

}  // namespace wale
