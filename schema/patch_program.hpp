#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "schema/device_profile.hpp"
#include "schema/instruction.hpp"
#include "schema/result.hpp"
#include "schema/shared_heights.hpp"

namespace wale {

/// A quantity that stays adjustable while the program runs. Values are in SI units; `unit` and `unit_in_si` are for
/// showing and typing them: shown = value / unit_in_si.
struct Parameter {
  std::string name;
  std::string unit;  ///< as the author wrote it, "mm"; empty for a plain number
  double unit_in_si = 1;
  float value = 0;                    ///< the default
  float low = 0, high = 0;            ///< hard range, low <= value <= high
  float soft_low = 0, soft_high = 0;  ///< the usual range, for a slider; low <= soft_low <= soft_high <= high
  std::string description;
  std::string si_unit;  ///< the coherent unit of its dimension, "m": what `unit` measures, for those who do not know it

  friend bool operator==(const Parameter&, const Parameter&) = default;
};

/// A pure subprogram whose value's percentile over the patch is a setup register (the `peak` instruction).
///
/// It is run at `points` positions x = (2 u - 1) X, y = (2 v - 1) Y, where X and Y are the values of the two extent
/// registers (constants, inputs or setup) and (u, v) the i-th point of the Kronecker lattice of the plastic number:
/// u = i * 3242174889 mod 2^32, v = i * 2447445414 mod 2^32, both over 2^32. Velocities read as zero.
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
  amplitude = 2,  ///< m/s^2: of a pad's vibration
  frequency = 3,  ///< Hz: of the same
};

/// Where a tick leaves a result. `value` is written by the section's `limit` whose ceiling is the register `ceiling`.
/// A program has either force x and force y, or amplitude and frequency.
struct Output {
  OutputQuantity quantity = OutputQuantity::force;
  std::uint8_t axis = 0;  ///< of a force 0 x, 1 y; of the others 0
  RegisterNumber value = 0;
  RegisterNumber ceiling = 0;

  /// Which of a tick's two numbers it is: 0 force x or amplitude, 1 force y or frequency.
  std::size_t component() const { return quantity == OutputQuantity::frequency ? 1 : axis; }

  friend bool operator==(const Output&, const Output&) = default;
};

/// A quantity that a program remembers from tick to tick: one register, read by tick, frame and picture code as it was
/// when the tick began.
///
/// It begins at `initial` (a register of the `enter` section) when the hand enters the patch, becomes `next` (a
/// register of the tick) at the end of each tick, and is held in low .. high; not-a-number gives the initial value
/// again.
struct State {
  std::string name;
  float low = 0, high = 0;
  RegisterNumber initial = 0, next = 0;
  std::string si_unit;  ///< the coherent unit of its dimension, by which a state of another program is the same one

  friend bool operator==(const State&, const State&) = default;
};

/// A field over the patch that a program remembers: `columns` by `rows` cells, the first at the lower left. Every cell
/// begins at `initial` when the program is placed and is held in low .. high.
struct Grid {
  std::string name;
  std::uint32_t columns = 0, rows = 0;
  float initial = 0, low = 0, high = 0;
  std::string si_unit;  ///< as a state's

  friend bool operator==(const Grid&, const Grid&) = default;
};

/// At the end of a tick the cell nearest to (u, v), in cells from the centre of the first one, becomes `value`; nothing
/// is written when one of the three is not a number. Registers of the tick.
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

/// How many registers a mark of a kind has.
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

/// One shape: what `MarkKind` says of its registers, which the frame section leaves.
struct Mark {
  MarkKind kind = MarkKind::point;
  std::array<RegisterNumber, 5> operands{};  ///< those beyond the kind's own are 0
  std::uint32_t colour = 0;                  ///< 0xRRGGBB

  friend bool operator==(const Mark&, const Mark&) = default;
};

/// How a program looks. `code` runs for each point that is drawn and reads place, patch and states; `frame` runs once a
/// picture and reads what the tick reads.
struct Picture {
  std::vector<Instruction> code;
  RegisterNumber relief = 0;                            ///< the surface's height
  bool relief_is_length = false;                        ///< in m; otherwise a plain number
  std::optional<std::array<RegisterNumber, 3>> colour;  ///< red, green, blue in 0 .. 1, where the author says
  std::vector<Instruction> frame;
  std::vector<Mark> marks;  ///< in the order of drawing

  friend bool operator==(const Picture&, const Picture&) = default;
};

/// How a figure came to be known, best first.
enum class Evidence : std::uint8_t { measured = 1, published = 2, estimated = 3, recalled = 4, transferred = 5 };

/// What reads a percept's carrier from a program, or from the force at the handle. Each looks at something of its own,
/// so that no percept's carrier is taken for another's.
enum class Extractor : std::uint8_t {
  none = 0,            ///< nothing does
  lateral_force = 1,   ///< N: 99th percentile of the static force, its periods within a band
  opposing_force = 2,  ///< N: what opposes a moving hand whatever its speed
  damping = 3,         ///< N s/m: what opposes it in proportion to its speed
  stiffness = 4,       ///< N/m: slope of the static force over distances that no texture has
  wall_stiffness = 5,  ///< N/m: the steepest slope of a force on one side of a place, none on the other
  wall_damping = 6,    ///< N s/m: what opposes a hand as it comes in there
  inertia = 7,         ///< kg: what opposes its acceleration
  vibration = 8,       ///< N: amplitude of the force on a hand at rest
  steepness = 9,       ///< 1/m: the lateral force's steepest change over its amplitude
  periodicity = 10,    ///< share of the lateral force that comes back after a period, 0 .. 1
  acceleration = 11,   ///< m/s^2: amplitude of a pad's vibration under a moving hand
};

/// One percept of the program: what was asked, through which map it is realised, and how to read it back.
///
/// `prediction` is pure code that turns the carrier's size in the `probe` input into magnitude and level.
struct PerceptRecord {
  std::string name;                        ///< "roughness"
  std::string carrier;                     ///< "lateral amplitude"
  std::optional<std::uint16_t> parameter;  ///< the live level, when the percept was asked for
  bool blended = false;                    ///< asked for by a blend's components, whose levels are parameters
  RegisterNumber amplitude = 0;            ///< constant or setup register: the carrier's size, SI
  bool alone = false;                      ///< nothing but this carrier pushes, so total force reads it
  std::vector<Instruction> prediction;
  RegisterNumber magnitude = 0, level = 0;
  float valid_low = 0, valid_high = 0;  ///< of the carrier's size
  float scatter = 0;                    ///< standard deviation of log10 magnitude
  Evidence slope = Evidence::estimated, anchor = Evidence::estimated, handle = Evidence::estimated;
  std::string map, device, source;  ///< the map's name, the device it was measured on, the citation

  std::string unit;  ///< of the carrier's size, SI: "N", "N s/m"
  Extractor extractor = Extractor::none;
  float period_low = 0, period_high = 0;  ///< m: the band that the extractor reads; 0, 0 for any
  float one = 0;                          ///< the carrier's size at level 1
  float near_threshold = 0;               ///< level below which it is near or below threshold
  float spread = 0;                       ///< standard deviation of the observers' own exponents; 0: not known
  std::uint16_t observers = 0;            ///< 0: not known
  /// How small a difference of the carrier's size is noticed, at d' = 1: as a share of it, and no less than `floor`.
  /// 0: not known.
  float weber = 0, floor = 0;
  Evidence weber_evidence = Evidence::estimated;
  std::string weber_source;
  std::string realisation;  ///< the device's own force for it, as written; empty where the author's physics carries it

  friend bool operator==(const PerceptRecord&, const PerceptRecord&) = default;
};

/// What becomes on a device of something that the author asked for or wrote.
enum class Fate : std::uint8_t {
  kept = 1,          ///< it is there as it was meant
  approximated = 2,  ///< something else stands for it, or a figure from another handle
  saturated = 3,     ///< less of it than asked for, since the device gives no more
  lost = 4,          ///< it is not there
};

/// The fate of one percept, or of one thing in the physics.
struct FateRecord {
  std::string name;      ///< "roughness"; "lateral amplitude", "place of features"
  bool percept = false;  ///< otherwise physics
  Fate fate = Fate::kept;
  float asked = 0, given = 0;  ///< levels of a percept; given 0 where it is lost; both 0 for physics
  std::string reason;          ///< how it is realised, or why it is not there; empty where nothing need be said

  friend bool operator==(const FateRecord&, const FateRecord&) = default;
};

/// The layers as their author wrote them: kept for people and catalogues, never executed.
struct Layers {
  std::vector<std::pair<std::string, std::vector<std::string>>> representative;  ///< ("called", {"corduroy", ...})
  std::string perceptual;                                                        ///< source text
  std::string physical;                                                          ///< source text
  std::string documentation;                                                     ///< the comment above the material

  friend bool operator==(const Layers&, const Layers&) = default;
};

/// The sections of code, in the order in which the format lists their places. There is one of each, but as many peaks
/// and predictions as the program has peaks and percepts.
enum class CodeSection : std::uint8_t { setup, peak, enter, tick, picture, frame, prediction };

/// A line of Wale.
struct SourceLine {
  std::string file;        ///< the name under which it was imported, "fabric.denim", else its own without its folder
  std::uint32_t line = 0;  ///< from 1

  friend bool operator==(const SourceLine&, const SourceLine&) = default;
};

/// Which lines of Wale the instructions come from: kept for listings and for what is said of a program, never executed.
///
/// What a function of another file does is placed where the material's own file calls it.
struct SourcePlaces {
  /// So many instructions in a row come from one line.
  struct Run {
    std::uint32_t instructions = 0;
    std::uint16_t file = 0;  ///< of `files`
    std::uint32_t line = 0;  ///< from 1

    friend bool operator==(const Run&, const Run&) = default;
  };
  std::vector<std::string> files;  ///< as `SourceLine::file`
  /// Setup, each peak, enter, tick, picture, frame, each percept's prediction: runs that cover the section's code.
  std::vector<std::vector<Run>> sections;

  friend bool operator==(const SourcePlaces&, const SourcePlaces&) = default;
};

/// A program may give no more than this by itself, W.
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
  std::vector<Instruction> enter;  ///< what the states begin with: reads what the tick reads, besides states and grids
  std::vector<Grid> grids;
  std::vector<Instruction> tick;
  std::vector<Output> outputs;
  std::vector<GridWrite> writes;  ///< in the order in which they happen
  Picture picture;
  std::vector<HeightTable> tables;
  float patch_width = 0, patch_height = 0, patch_rim = 0;  ///< m; default size of the patch
  float active_watt = 0;  ///< W, 0 .. most_active_watt: what the author lets the program give to the hand by itself
  DeviceProfile device;
  std::vector<PerceptRecord> percepts;
  std::vector<FateRecord> fates;  ///< of what was asked for, in that order, then of the physics; never executed
  Layers layers;
  SourcePlaces places;  ///< empty where nobody recorded them

  /// Whether it vibrates a pad instead of pushing: what the two numbers of a tick are.
  bool vibrates() const { return device.shaker.has_value(); }
  /// The code of a section; peaks and predictions have the `index` of their peak or percept, the others 0.
  const std::vector<Instruction>& code(CodeSection section, std::size_t index = 0) const;
  /// The line that an instruction comes from, where it is known; also when code has been changed since, if there is
  /// such an instruction.
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

/// The canonical bytes of a `.wpp` file (schema/PATCH_PROGRAM.md): the same program gives the same bytes everywhere.
std::vector<std::byte> write_patch_program(const PatchProgram& program);

/// Reads a `.wpp` file's bytes. Checks structure, sizes and checksum, not what the code does: that is `verify`'s.
/// Never reads outside `bytes`, never allocates more than a small multiple of their size, whatever they hold.
Result<PatchProgram> read_patch_program(std::span<const std::byte> bytes);

/// The code of a section or subprogram costs the sum over its instructions, in units of one addition.
long cost_of(std::span<const Instruction> code);

}  // namespace wale
