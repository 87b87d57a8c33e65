#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/describe/fates_at.hpp"
#include "compiler/describe/held_figures.hpp"
#include "compiler/describe/level_intervals.hpp"
#include "compiler/evidence/percept_reading.hpp"
#include "compiler/grade/grade.hpp"
#include "compiler/measure/cut_force.hpp"
#include "compiler/measure/measure.hpp"
#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"
#include "compiler/read/coming_force.hpp"
#include "compiler/read/motion.hpp"
#include "compiler/read/other_force.hpp"
#include "compiler/read/relief.hpp"
#include "compiler/read/wall.hpp"
#include "wale/program.hpp"

namespace wale {

/// One percept of a program at given parameters: what is asked for, what the finished program reads, and on what
/// evidence. The three are never mixed.
struct DescribedPercept {
  std::string name;
  std::string carrier;

  std::optional<double> asked;  ///< the level asked for; empty if the author did not ask for one
  std::optional<Evidence> claimed;  ///< how well the author knows that level; empty if not stated, or at another level
  double aimed = 0;             ///< the carrier's size that it was solved for, in `unit`
  bool blended = false;         ///< a blend asks for it: mixed from the levels of its components
  bool solved = false;          ///< its size was found from the level; otherwise the author wrote it
  std::string realisation;      ///< the device's own force for it, as written; empty if the author wrote the force

  double amplitude = 0;             ///< the carrier's size that is read from the finished program, in `unit`
  std::string unit;                 ///< of the carrier's size, SI: "N", "N s/m"
  bool readable = true;             ///< otherwise it is the size aimed at, as far as the device gives it
  bool effective = false;           ///< of a texture that the author gave no such size: the force has it as a whole
  bool changed = false;             ///< a limit, a factor or a condition changes its force after it was solved
  bool unknown = false;             ///< `outside` says why no map tells the level of what it pushes
  double level = 0, magnitude = 0;  ///< of that size, by the map
  LawUncertainty uncertainty;       ///< of the map
  LevelIntervals intervals;         ///< of the level, by that uncertainty
  bool near_threshold = false;      ///< near or below the threshold of feeling
  bool extracted = false;           ///< the program has no record of it: only its force tells
  bool saturated = false;           ///< the device pushes less than the percept needs
  bool alone = true;                ///< no other force pushes; otherwise a run cannot read the level back
  /// What it reads where its level is at the least, in the middle and at the most: of a level that is a parameter.
  struct Setting {
    double asked = 0, reads = 0;  ///< `reads` is not a number where it is unknown
  };
  std::vector<Setting> settings;
  /// Where another parameter ends, and people would notice that the level there is another than the one asked for.
  struct End {
    std::size_t parameter = 0;
    float value = 0;
    double reads = 0;  ///< not a number where it is unknown
  };
  std::vector<End> ends;
  std::string parameter;  ///< the name of that parameter

  /// The worst of slope, anchor, handle and domain.
  Evidence evidence() const;
  Evidence slope = Evidence::estimated, anchor = Evidence::estimated, handle = Evidence::estimated;
  std::optional<Evidence> domain;     ///< empty if the map does not state its stimuli
  std::string domain_why;             ///< how the stimulus differs from those of the map
  std::vector<OutsideRange> outside;  ///< what was not measured
  bool outside_validity() const { return !outside.empty(); }
  std::vector<std::string> assumed;  ///< figures of the map that are assumed: "scatter", "spread", "amplitude", …
  std::string map, device, source;
};

/// The texture of a program's force, and its name by the `rule`s that classify textures.
struct DescribedTexture {
  Relief force;      ///< with amplitude 0 there is no relief
  std::string kind;  ///< in the words of the rules: "grating", "perlin", "spring", "viscous", "nothing", …
  /// what its strongest wave counts as, by its period: "roughness", "bumpiness"; empty without one, and if it
  /// is too fine for any
  std::string counts_as;
  /// What the hand meets of the strongest wave, if that is too fine for the device's encoder.
  std::optional<ReliefWave> encoder_pattern;
  /// m: by which it is named: that of its strongest wave, where it repeats after a multiple that itself is no wave.
  double named_by = 0;
  std::string texture_class, size_class;  ///< "flat texture", "moguls"; empty without a texture or a rule
  std::string felt_as;                    ///< of the size class: "separate features"; empty for a texture like others
  /// how sure people are that it is a texture: "high", "low", or the stimulus that they rated
  std::string confidence;
  std::optional<double> confidence_mean, confidence_spread;  ///< of ratings 0 .. 1, if they were published
  std::string source;                                        ///< of the confidence
};

/// A program in words and figures: what `wale describe` shows. SI units.
struct Description {
  std::string material;
  DeviceProfile device;
  Layers layers;
  std::vector<DescribedPercept> percepts;
  std::optional<DescribedTexture> texture;  ///< if declarations were given
  struct Wall {
    WallFace face;
    WallDepth depth;
  };
  std::optional<Wall> wall;       ///< the stiffest, if a reading found one
  std::vector<Wall> more_walls;   ///< beside it, the stiffest first
  std::vector<StaticStep> steps;  ///< lines where the force jumps, the largest first
  /// What resists differently along its axis and across it: "stiffness", N/m.
  struct Directed {
    const char* name;
    const char* unit;
    Principal size;
  };
  std::vector<Directed> directed;
  Swing sway;                        ///< slower than 10 Hz, which no percept tells; of amplitude 0 if there is none
  std::vector<SwingPart> vibration_parts;       ///< of a vibration that is the sum of several
  Mass mass;                                    ///< what of it differs with the way, and from place to place
  std::optional<SwingCourse> vibration_course;  ///< of a vibration that dies away or grows
  Swing noise;                       ///< what changes with time without a rate; of amplitude 0 if nothing does
  OpposingForce motion;              ///< what resists a moving hand
  double spring_force = 0;           ///< N: at which a spring's force grows no more; 0 if nothing limits it
  double spring_beyond = 0;          ///< N/m: of another spring that goes on beyond; then the force is a part's
  double small_feature = 0;          ///< N: the largest force of what fills less than a hundredth of the patch
  glm::dvec2 constant_push{0};       ///< N: everywhere alike; beside a spring, in the patch's middle
  std::optional<glm::dvec2> rest;    ///< m: where a spring pulls to, if that is beside the patch's middle and on it
  std::vector<HeldFigure> held;      ///< what holding the button changes
  Swing uneven;                      ///< what swings and differs from place to place, with its least size there
  OtherForce other;                  ///< what no cue explains
  ComingForce coming;                ///< when what comes or goes with time does so
  double swirl = 0;                  ///< N/m: turns a resting hand about, counterclockwise; 0 if nothing does
  std::optional<double> travel;      ///< rad in [0, 2 pi): towards where a pattern that time changes goes
  double aside = 0;                  ///< N: on a hand at 0.2 m/s, square to its way
  double unread = 0;                 ///< N: on a hand at rest or on its way, with no other cause here
  std::string no_percept;            ///< why there is no percept, in a line; empty if there is one
  std::string no_texture;            ///< why there is no texture, in a line; empty if there is one
  std::vector<DescribedFate> fates;  ///< fate of each percept and of the physics on the device
  std::optional<MeasuredShaking>
      shaking;                        ///< of a program that vibrates; its force, bound, grade and texture are empty
  Measured force;                     ///< `max_newton` includes a rehearsal if the program has memory
  ForceBound bound;                   ///< the proved bound of the force, and the largest force that a search found
  bool limit_matters = false;         ///< without its last limit the program could ask for more than the device gives
  Interval asked;                     ///< of both components before that limit, N, as far as proved
  Grade grade;                        ///< how stable the loop is
  std::vector<Parameter> parameters;  ///< with the values that are described
  /// For each parameter, where the device's limit cuts the force; empty if the limit does not matter.
  std::vector<std::vector<CutRange>> cuts;
  std::size_t not_searched = 0;  ///< so many parameters more were not searched for where they change something
  std::vector<State> states;  ///< a vector is two states, "p.x" and "p.y"
  std::vector<Grid> memories;
  bool shows_relief = false, shows_colour = false;
  std::vector<Mark> marks;
  PatchSize patch;
  struct Code {
    std::size_t setup = 0, peaks = 0, enter = 0, tick = 0, picture = 0, frame = 0;  ///< instructions
    /// In units of one addition: peaks over all points, the picture for one point.
    long setup_cost = 0, peak_cost = 0, enter_cost = 0, tick_cost = 0, picture_cost = 0, frame_cost = 0;
  } code;
  std::size_t bytes = 0;       ///< of the `.wpp` file
  std::size_t coarseness = 1;  ///< of how many places one was sampled
};

/// Whether percepts and a texture that the author did not ask for are read from the force, which takes longer; as the
/// parameters are, or also what other settings of them would change, which takes longest.
enum class Texture { extracted, as_set, left_out };

/// Describes a program at a bank's parameters. Runs it to measure its force, with the declared hands `normal` and
/// `showing`.
Description describe(const Bank& bank, const Declarations& declarations, Texture texture = Texture::extracted);

/// The description as text for people.
std::string description_text(const Description& description);
/// "95 % of the means of groups: at least 0.19 .. 0.47 (scatter assumed)": where the means of other people lie, with the
/// marks of what is assumed.
std::string means_words(const DescribedPercept& percept);
/// The same, and where single people lie: "95 % of the means of 15 people: 0.44 .. 0.82; of single people: 0.20 .. 1.77
/// (spread and noise assumed)".
std::string people_words(const DescribedPercept& percept);
/// JSON: an object for one description, an array for several.
std::string descriptions_json(const std::vector<Description>& descriptions);

/// "kept", "approximated", "saturated", "lost".
std::string fate_word(Fate fate);
/// "measured", "published", …
std::string evidence_word(Evidence evidence);
/// "point", "spring", …
std::string mark_word(MarkKind kind);

}  // namespace wale
