#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "wale/device_profile.hpp"
#include "wale/instruction.hpp"
#include "wale/result.hpp"
#include "wale/shared_heights.hpp"

namespace wale {

/// A quantity that can be changed while the program runs. Values are in SI units; `unit` and `unit_in_si` are for
/// display and input: shown = value / unit_in_si.
struct Parameter {
  std::string name;
  std::string unit;  ///< as the author wrote it, "mm"; empty for a plain number
  double unit_in_si = 1;
  float value = 0;                    ///< the default
  float low = 0, high = 0;            ///< hard range, low <= value <= high
  float soft_low = 0, soft_high = 0;  ///< the usual range, for a slider; low <= soft_low <= soft_high <= high
  std::string description;
  std::string si_unit;  ///< the coherent unit of its dimension, "m", for readers that do not know `unit`

  friend bool operator==(const Parameter&, const Parameter&) = default;
};

/// A pure subprogram. The `peak` instruction writes a percentile of its value over the patch to a setup register.
///
/// It runs at `points` positions x = (2 u - 1) X, y = (2 v - 1) Y. X and Y are the values of the two extent registers
/// (constants, inputs or setup); (u, v) is the i-th point of the Kronecker lattice of the plastic number:
/// u = i * 3242174889 mod 2^32, v = i * 2447445414 mod 2^32, both divided by 2^32. Velocities read as zero.
struct Peak {
  std::vector<Instruction> code;
  RegisterNumber value = 0;
  RegisterNumber half_width = 0, half_height = 0;
  std::uint32_t points = 0;
  float percentile = 0;  ///< in (0, 1]; 0.99 takes the value that 1 % of the points exceed

  friend bool operator==(const Peak&, const Peak&) = default;
};

/// A sampled height map, row-major from the top left; code 0 is the lowest and 65535 the highest.
struct HeightTable {
  std::uint32_t width = 0, height = 0;
  SharedHeights heights;

  friend bool operator==(const HeightTable&, const HeightTable&) = default;
};

enum class OutputQuantity : std::uint8_t {
  force = 1,      ///< N along `axis`
  amplitude = 2,  ///< m/s^2, of a pad's vibration
  frequency = 3,  ///< Hz, of a pad's vibration
};

/// A result of a tick. The tick's last write to the register `value` is a `limit` to the register `ceiling`.
/// A program has either force x and force y, or amplitude and frequency.
struct Output {
  OutputQuantity quantity = OutputQuantity::force;
  std::uint8_t axis = 0;  ///< of a force: 0 x, 1 y; otherwise 0
  RegisterNumber value = 0;
  RegisterNumber ceiling = 0;

  /// Its index in a tick's two numbers: 0 force x or amplitude, 1 force y or frequency.
  std::size_t component() const { return quantity == OutputQuantity::frequency ? 1 : axis; }

  friend bool operator==(const Output&, const Output&) = default;
};

/// A quantity that a program remembers from tick to tick, in one register. Tick, frame and picture code read its value
/// from the beginning of the tick.
///
/// When the hand enters the patch it becomes `initial` (a register of the `enter` section), and at the end of each tick
/// `next` (a register of the tick), clamped to low .. high. If `next` is not a number, it becomes the initial value
/// again.
struct State {
  std::string name;
  float low = 0, high = 0;
  RegisterNumber initial = 0, next = 0;
  std::string si_unit;  ///< the coherent unit of its dimension; a replacing program keeps states by name and unit

  friend bool operator==(const State&, const State&) = default;
};

/// A field over the patch that a program remembers: `columns` by `rows` cells, the first at the lower left. Every cell
/// begins at `initial` when the program is placed; writes are clamped to low .. high.
struct Grid {
  std::string name;
  std::uint32_t columns = 0, rows = 0;
  float initial = 0, low = 0, high = 0;
  std::string si_unit;  ///< as for a state

  friend bool operator==(const Grid&, const Grid&) = default;
};

/// At the end of a tick the cell nearest to (u, v), in cells from the centre of the first one, becomes `value`, unless
/// one of the three is not a number. All three are registers of the tick.
struct GridWrite {
  std::uint16_t grid = 0;
  RegisterNumber u = 0, v = 0, value = 0;

  friend bool operator==(const GridWrite&, const GridWrite&) = default;
};

/// Shapes that a picture shows besides its surface. Places and lengths in m, angles in rad, on the patch.
enum class MarkKind : std::uint8_t {
  point = 1,       ///< place x y, diameter
  circle = 2,      ///< place x y, radius
  box = 3,         ///< place x y, width, height, angle
  line = 4,        ///< from x y, to x y
  spring = 5,      ///< from x y, to x y, width
  trajectory = 6,  ///< place x y, seconds for which its path stays visible
};

/// How many registers a mark of this kind has; 0 for an unknown kind.
constexpr std::size_t mark_operands(MarkKind kind) {
  switch (kind) {
    case MarkKind::point:
    case MarkKind::circle:
    case MarkKind::trajectory: return 3;
    case MarkKind::line: return 4;
    case MarkKind::box:
    case MarkKind::spring: return 5;
  }
  return 0;
}

/// One shape. The frame section writes its registers; `MarkKind` gives their meaning.
struct Mark {
  MarkKind kind = MarkKind::point;
  std::array<RegisterNumber, 5> operands{};  ///< those that the kind does not use are 0
  std::uint32_t colour = 0;                  ///< 0xRRGGBB

  friend bool operator==(const Mark&, const Mark&) = default;
};

/// How a program looks. `code` runs for each drawn point and reads place, patch, states and grids; `frame` runs once a
/// picture and may read the same inputs as the tick.
struct Picture {
  std::vector<Instruction> code;
  RegisterNumber relief = 0;                            ///< the surface's height
  bool relief_is_length = false;                        ///< in m; otherwise a plain number
  std::optional<std::array<RegisterNumber, 3>> colour;  ///< red, green, blue in 0 .. 1, if the author declares them
  std::vector<Instruction> frame;
  std::vector<Mark> marks;  ///< in the order of drawing

  friend bool operator==(const Picture&, const Picture&) = default;
};

/// How a figure came to be known, best first. `extrapolated`: from a stimulus outside what was measured. `simulated`: from
/// answers that no person gave, or that were given without a real device.
enum class Evidence : std::uint8_t {
  measured = 1,
  published = 2,
  estimated = 3,
  recalled = 4,
  transferred = 5,
  extrapolated = 6,
  simulated = 7
};

/// How a percept's carrier is read from a program, or from the force at the handle. Each extractor reads a different
/// feature, so that one percept's carrier is not taken for another's.
enum class Extractor : std::uint8_t {
  none = 0,            ///< the carrier cannot be read
  lateral_force = 1,   ///< N: 99th percentile of the static force, its periods within a band
  opposing_force = 2,  ///< N: the force against a moving hand that does not depend on its speed
  damping = 3,         ///< N s/m: the force against a moving hand in proportion to its speed
  stiffness = 4,       ///< N/m: slope of the static force over distances longer than any texture's period
  wall_stiffness = 5,  ///< N/m: the steepest slope of a force that exists on one side of a place only
  wall_damping = 6,    ///< N s/m: the force against a hand that moves into that side, in proportion to its speed
  inertia = 7,         ///< kg: the force against acceleration, in proportion to it
  vibration = 8,       ///< N: amplitude of the force on a hand at rest
  steepness = 9,       ///< 1/m: the lateral force's steepest change over its amplitude
  periodicity = 10,    ///< share of the lateral force that repeats after a period, 0 .. 1
  acceleration = 11,   ///< m/s^2: amplitude of a pad's vibration under a moving hand
};

/// How uncertain a psychophysical law is: what the intervals of its levels are made of. In log10 of magnitude; 0: not
/// known.
struct LawUncertainty {
  float scatter = 0;            ///< standard deviation of a group's means about the law
  float slope_error = 0;        ///< standard error of the law's exponent, by that scatter
  float spread = 0;             ///< standard deviation of the observers' own exponents
  float noise = 0;              ///< standard deviation of one person's judgements about that person's own law
  std::uint16_t observers = 0;  ///< whose means these were
  std::uint16_t stimuli = 0;    ///< to whose means the law was fitted
  bool scatter_assumed = false, spread_assumed = false, noise_assumed = false;

  friend bool operator==(const LawUncertainty&, const LawUncertainty&) = default;
};

/// A range of a quantity in which a map was measured, besides that of its carrier's size.
struct MeasuredRange {
  std::string quantity;     ///< "period", "rate"
  float low = 0, high = 0;  ///< SI; the largest finite number where it has no end
  std::string unit;         ///< as its author wrote it, "mm"; empty for a plain number
  double unit_in_si = 1;
  bool assumed = false;  ///< not published

  friend bool operator==(const MeasuredRange&, const MeasuredRange&) = default;
};

/// The kinds of surfaces, one bit each.
enum class SurfaceProfile : std::uint8_t {
  grating = 1,     ///< it repeats
  noise = 2,       ///< it does not
  photograph = 4,  ///< sampled from a picture or another table
  bump = 8,        ///< single features
};

/// The stimuli with which a map was measured.
struct StimulusDomain {
  bool stated = false;          ///< otherwise nothing is known of them
  std::uint8_t profiles = 0;    ///< bits of `SurfaceProfile`; 0 for stimuli that are no surfaces
  std::uint8_t dimensions = 0;  ///< 1: the same along lines; 2; 0: of both kinds, or no surfaces
  bool alone = false;           ///< nothing else pushed
  /// Of the waveform of a grating: its largest force over its effective one. 0, 0: any.
  float crest_low = 0, crest_high = 0;
  bool crest_assumed = false;  ///< those bounds are not published

  friend bool operator==(const StimulusDomain&, const StimulusDomain&) = default;
};

/// What a percept's figures were measured with, and how far they were not measured.
struct Basis {
  /// The carrier's size over its force's amplitude: below 1 if a part counts for another percept, above 1 in sums.
  float share = 1;
  float tolerance = 0;   ///< of the level, in both directions, as its author wrote it
  bool summand = false;  ///< its force is a term of the total force, unchanged
  bool valid_assumed = false;
  std::vector<MeasuredRange> ranges;
  StimulusDomain domain;

  friend bool operator==(const Basis&, const Basis&) = default;
};

/// One percept of the program: the level asked for, the map that realises it, and how to read it back.
///
/// `prediction` is pure code that computes magnitude and level from the carrier's size, which is the `probe` input.
struct PerceptRecord {
  std::string name;                        ///< "roughness"
  std::string carrier;                     ///< "lateral amplitude"
  std::optional<std::uint16_t> parameter;  ///< the parameter that is its level, if the author asked for the percept
  bool blended = false;                    ///< the components of a blend asked for it, and their levels are parameters
  RegisterNumber amplitude = 0;            ///< constant or setup register: the carrier's size, SI
  bool alone = false;                      ///< this carrier is the only force, so the total force measures it
  std::vector<Instruction> prediction;
  RegisterNumber magnitude = 0, level = 0;
  float valid_low = 0, valid_high = 0;  ///< of the carrier's size
  LawUncertainty uncertainty;           ///< of the map's law
  Evidence slope = Evidence::estimated, anchor = Evidence::estimated, handle = Evidence::estimated;
  std::string map, device, source;  ///< the map's name, the device it was measured on, the citation

  std::string unit;  ///< of the carrier's size, SI: "N", "N s/m"
  Extractor extractor = Extractor::none;
  float period_low = 0, period_high = 0;  ///< m: the band that the extractor reads; 0, 0 for any
  float one = 0;                          ///< the carrier's size at level 1
  float near_threshold = 0;               ///< below this level it is near or below the threshold of perception
  /// The smallest difference of the carrier's size that people notice, at d' = 1: this share of the size, and at least
  /// `floor` (in `unit`). 0: not known.
  float weber = 0, floor = 0;
  Evidence weber_evidence = Evidence::estimated;
  std::string weber_source;
  std::string realisation;  ///< the device's own force for it, in Wale; empty if the author's physics carries it
  Basis basis;

  friend bool operator==(const PerceptRecord&, const PerceptRecord&) = default;
};

/// How well a device renders something that the author asked for or wrote.
enum class Fate : std::uint8_t {
  kept = 1,          ///< as it was meant
  approximated = 2,  ///< by a substitute, or with a figure from another handle
  saturated = 3,     ///< weaker than asked for, because the device gives no more
  lost = 4,          ///< not at all
};

/// The fate of one percept, or of one thing in the physics.
struct FateRecord {
  std::string name;      ///< "roughness"; "lateral amplitude", "place of features"
  bool percept = false;  ///< otherwise physics
  Fate fate = Fate::kept;
  float asked = 0, given = 0;  ///< levels of a percept, 0 .. 1; given is 0 if it is lost; both are 0 for physics
  std::string reason;          ///< how it is realised, or why it is lost; empty if it is kept and needs no remark

  friend bool operator==(const FateRecord&, const FateRecord&) = default;
};

/// How well the author of a material knows a level that he asks for.
struct LevelClaim {
  std::string percept;  ///< "roughness"
  Evidence evidence = Evidence::estimated;

  friend bool operator==(const LevelClaim&, const LevelClaim&) = default;
};

/// The layers as their author wrote them: kept for people and catalogues, never executed.
struct Layers {
  std::vector<std::pair<std::string, std::vector<std::string>>> representative;  ///< ("called", {"corduroy", ...})
  std::string perceptual;                                                        ///< source text
  std::string physical;                                                          ///< source text
  std::string documentation;                                                     ///< the comment above the material

  friend bool operator==(const Layers&, const Layers&) = default;
};

/// The sections of code, in the order in which the format lists their places. There is one of each, except that each
/// peak and each percept has its own `peak` or `prediction`.
enum class CodeSection : std::uint8_t { setup, peak, enter, tick, picture, frame, prediction };

/// A line of Wale.
struct SourceLine {
  std::string file;        ///< the name under which it was imported, "fabric.denim", else its file name without folder
  std::uint32_t line = 0;  ///< from 1

  friend bool operator==(const SourceLine&, const SourceLine&) = default;
};

/// The lines of Wale that the instructions come from: for listings and messages, never executed.
///
/// Code of a function in another file has the line where the material's own file calls it.
struct SourcePlaces {
  /// Consecutive instructions that come from one line.
  struct Run {
    std::uint32_t instructions = 0;
    std::uint16_t file = 0;  ///< index into `files`
    std::uint32_t line = 0;  ///< from 1

    friend bool operator==(const Run&, const Run&) = default;
  };
  std::vector<std::string> files;  ///< as `SourceLine::file`
  /// Setup, each peak, enter, tick, picture, frame, each percept's prediction: runs that cover the section's code.
  std::vector<std::vector<Run>> sections;

  friend bool operator==(const SourcePlaces&, const SourcePlaces&) = default;
};

/// W, the greatest power that a program may declare to give by itself.
inline constexpr float most_active_watt = 100;

/// A compiled material: everything a `.wpp` file holds. Plain data; `verify` says whether it may be run.
///
/// Registers lie in this order: 32 inputs, constants, parameters, `setup_registers` results of setup, states, then
/// `temporaries` that each run of a section may use from scratch.
struct PatchProgram {
  std::string material;
  std::vector<float> constants;
  std::vector<Parameter> parameters;
  std::uint16_t setup_registers = 0;
  std::uint16_t temporaries = 0;
  std::vector<Instruction> setup;
  std::vector<Peak> peaks;
  std::vector<State> states;
  std::vector<Instruction> enter;  ///< computes the states' first values; may read the tick's inputs
  std::vector<Grid> grids;
  std::vector<Instruction> tick;
  std::vector<Output> outputs;
  std::vector<GridWrite> writes;  ///< in the order in which they happen
  Picture picture;
  std::vector<HeightTable> tables;
  float patch_width = 0, patch_height = 0, patch_rim = 0;  ///< m; default size of the patch
  float active_watt = 0;  ///< W, 0 .. most_active_watt: the power that the author lets the program give by itself
  DeviceProfile device;
  std::vector<PerceptRecord> percepts;
  std::vector<FateRecord> fates;  ///< of the percepts in the order asked for, then of the physics; never executed
  std::vector<LevelClaim> claims;  ///< of some of the percepts asked for, in that order; never executed
  Layers layers;
  SourcePlaces places;  ///< empty if the compiler did not record them

  /// Whether it vibrates a pad instead of pushing, so that a tick gives an amplitude and a frequency.
  bool vibrates() const { return device.shaker.has_value(); }
  /// The code of a section. `index` is the number of the peak or percept; it is 0 for all other sections.
  const std::vector<Instruction>& code(CodeSection section, std::size_t index = 0) const;
  /// The line that an instruction comes from, if it is known. The numbers may be beyond the code that `places` covers:
  /// then nothing.
  std::optional<SourceLine> place_of(CodeSection section, std::size_t index, std::size_t instruction) const;

  RegisterNumber first_parameter() const { return static_cast<RegisterNumber>(first_constant + constants.size()); }
  RegisterNumber first_setup() const { return static_cast<RegisterNumber>(first_parameter() + parameters.size()); }
  RegisterNumber first_state() const { return static_cast<RegisterNumber>(first_setup() + setup_registers); }
  RegisterNumber first_temporary() const { return static_cast<RegisterNumber>(first_state() + states.size()); }
  std::size_t register_count() const {
    return first_constant + constants.size() + parameters.size() + setup_registers + states.size() + temporaries;
  }

  friend bool operator==(const PatchProgram&, const PatchProgram&) = default;
};

/// The canonical bytes of a `.wpp` file (schema/PATCH_PROGRAM.md). Equal programs give equal bytes on every machine.
std::vector<std::byte> write_patch_program(const PatchProgram& program);

/// Reads a `.wpp` file's bytes and checks structure, sizes and checksum; `verify` checks the code. Never reads outside
/// `bytes`, and allocates at most a small multiple of their size. Errors: `damaged_file`, `newer_file`.
Result<PatchProgram> read_patch_program(std::span<const std::byte> bytes);

/// The cost of a section or subprogram, in units of one addition: the sum over its instructions.
long cost_of(std::span<const Instruction> code);

}  // namespace wale
