#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wale::truth {

/// What a reader is asked about a program. All sizes are SI.
enum class Cue {
  amplitude,       ///< N: the 99th percentile of the static relief, at whatever scale
  period,          ///< m: the fundamental of the dominant wave
  orientation,     ///< rad in [0, pi): the direction in which it changes
  roughness,       ///< N: the carrier of roughness, the share of the relief with fundamentals of 0.7 to 10 mm
  bumpiness,       ///< N: the carrier of bumpiness, likewise of 10 to 100 mm
  stiffness,       ///< N/m: of a spring about a place
  wall_stiffness,  ///< N/m
  viscosity,       ///< N s/m
  friction,        ///< N: while it slides
  breakaway,       ///< N: what makes it slide
  mass,            ///< kg
  vibration,       ///< N: amplitude at 10 Hz and above
  vibration_rate,  ///< Hz
  sway,            ///< N: amplitude below 10 Hz
  sway_rate,       ///< Hz
  constant,        ///< N: size of a force that is the same everywhere
  // Where it resists differently with the direction: the smaller principal value, and the direction of the greater.
  stiffness_across,  ///< N/m
  viscosity_across,  ///< N s/m
  friction_across,   ///< N
  mass_across,       ///< kg
  axis,              ///< rad in [0, pi)
  wall_damping,      ///< N s/m: what a wall adds to the drag outside of it
  face,              ///< m from the patch's centre: where a wall begins
  other_vibration,       ///< N: amplitude of what vibrates beside the strongest
  other_vibration_rate,  ///< Hz: of the second strongest
  other_sway,            ///< N: likewise below 10 Hz
  other_sway_rate,       ///< Hz
  one_way_mass,          ///< kg: by how much a mass is more on one way than on the other
  uneven_mass,           ///< kg: by how much it is more in a part of the patch
  // Judged in the classes of which they are known.
  wall_jump,  ///< N: with which a wall begins
  wall_push,  ///< N: with which it pushes at most
};
inline constexpr std::size_t cue_count = 31;

struct CueRule {
  Cue cue;
  const char* name;
  const char* unit;
  double scale;     ///< from SI to `unit`
  double relative;  ///< allowed relative error
  double least;     ///< allowed error, and the largest value that counts as none; SI
};
/// In the order of `Cue`: the bars of the reading.
const std::array<CueRule, cue_count>& cue_rules();

/// Whether a cue changes with another by definition: the carriers of percepts with the relief's amplitude and period.
bool follows(Cue cue, Cue from);

/// What is known of one cue of a program.
struct Expected {
  enum class Kind { none, value, some, open } kind = Kind::none;
  double value = 0;
};
inline Expected valued(double value) { return {Expected::Kind::value, value}; }
inline constexpr Expected some{Expected::Kind::some, 0};  ///< more than the least, without a size
inline constexpr Expected open{Expected::Kind::open, 0};  ///< the definition of the cue leaves it open: not judged

struct WaveTruth {
  double period = 0;       ///< m
  double orientation = 0;  ///< rad
};
/// Whether they count as one: periods within 2 %, directions within 2 degrees.
bool alike(const WaveTruth& a, const WaveTruth& b);

/// A wall: beyond a straight line, or all round.
struct WallTruth {
  double stiffness = 0;  ///< N/m
  double face = 0;       ///< m: along the way into it from the patch's centre; of a round one, the radius
  double inward = 0;     ///< rad: the way into a straight one
  int round = 0;         ///< 1: it lies outside of a circle; -1: it fills the circle
  double x = 0, y = 0;   ///< m: of the circle's centre
  double power = 1;      ///< its push grows with this power of the depth; then the stiffness is that of its deepest place
};
bool alike(const WallTruth& a, const WallTruth& b);

/// A line where the force jumps.
struct StepTruth {
  double place = 0, angle = 0;  ///< m from the patch's centre along the way across it, and that way's angle, rad
  double x = 0, y = 0;          ///< N: by so much the force is larger beyond it
};
bool alike(const StepTruth& a, const StepTruth& b);

/// All that is known of a program. Without a word a cue is none, and a wall's jump and push are not judged.
struct Truth {
  Truth() { (*this)[Cue::wall_jump] = (*this)[Cue::wall_push] = open; }

  std::array<Expected, cue_count> cues;
  /// All walls and steps; not judged if nothing.
  std::optional<std::vector<WallTruth>> walls;
  std::optional<std::vector<StepTruth>> steps;
  /// The waves of the relief; nothing if that is open.
  std::optional<std::vector<WaveTruth>> waves = std::vector<WaveTruth>{};

  Expected& operator[](Cue cue) { return cues[static_cast<std::size_t>(cue)]; }
  const Expected& operator[](Cue cue) const { return cues[static_cast<std::size_t>(cue)]; }
};

/// What a reader says of a program, in the same words.
struct Reading {
  std::array<std::optional<double>, cue_count> cues;
  std::vector<WaveTruth> waves;
  std::vector<WallTruth> walls;
  std::vector<StepTruth> steps;

  std::optional<double>& operator[](Cue cue) { return cues[static_cast<std::size_t>(cue)]; }
  const std::optional<double>& operator[](Cue cue) const { return cues[static_cast<std::size_t>(cue)]; }
};

enum class Verdict { open, right, wrong };

/// Of each cue, then of the waves, the walls and the steps.
inline constexpr std::size_t judged_count = cue_count + 3;
struct Judgement {
  std::array<Verdict, judged_count> verdicts{};
  std::array<std::string, judged_count> faults;  ///< "expected 2.5 mm, read 7.5 mm"; empty where right or open
  std::array<double, judged_count> errors{};     ///< how wrong, to find the worst; 1 is the bar
  /// Whether a cue is read that the program does not have.
  bool invents = false;

  bool right() const;
};
Judgement judge(const Truth& truth, const Reading& reading);
/// "period" or "waves".
const char* judged_name(std::size_t judged);

}  // namespace wale::truth
