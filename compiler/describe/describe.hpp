#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/describe/fates_at.hpp"
#include "compiler/extract/texture.hpp"
#include "compiler/grade/grade.hpp"
#include "compiler/measure/measure.hpp"
#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"
#include "wale/program.hpp"

namespace wale {

struct Declarations;

/// What one percept of a program is predicted to feel like, at given parameters.
struct DescribedPercept {
  std::string name;
  std::string carrier;
  std::optional<double> asked;  ///< the level asked for, when the author asked
  double amplitude = 0;         ///< the carrier's size, in `unit`
  std::string unit;             ///< of the carrier's size, SI: "N", "N s/m"
  std::string realisation;      ///< the device's own force for it, as written; empty where the author's carries it
  double level = 0, magnitude = 0;
  double low = 0, high = 0;  ///< level within which 95 % of such means lie, by the map's scatter
  /// The same for single people, whose exponents differ by more than the mean's; equal to the above where nobody
  /// published how much.
  double individual_low = 0, individual_high = 0;
  bool near_threshold = false;  ///< near or below what is felt at all
  bool blended = false;         ///< mixed of what the components of a blend ask for
  bool extracted = false;       ///< read from the program's force, not from what its author said
  bool saturated = false;       ///< the device pushes less than the percept needs; level is what comes out
  bool outside_validity = false;
  bool alone = true;  ///< nothing but this carrier pushes; otherwise a run cannot read the level back
  Evidence slope, anchor, handle, worst;
  std::string map, device, source;
};

/// The texture of a program's force, and what people would call it by the `rule`s that classify one.
struct DescribedTexture {
  TextureForce force;  ///< amplitude 0: there is none
  std::string kind;    ///< as the rules know it: "grating", "perlin", "spring", "viscous", "nothing", …
  std::string texture_class, size_class;  ///< "flat texture", "moguls"; empty without a texture or without a rule
  std::string confidence;                 ///< how sure people are that it is one: "high", "low", or the stimulus rated
  std::optional<double> confidence_mean, confidence_spread;  ///< of ratings 0 .. 1, where they were printed
  std::string source;                                        ///< of the confidence
};

/// A program in words and figures: what `wale describe` shows. SI units.
struct Description {
  std::string material;
  DeviceProfile device;
  Layers layers;
  std::vector<DescribedPercept> percepts;
  std::optional<DescribedTexture> texture;  ///< where the declarations were given
  std::string no_percept;                   ///< why none is of a texture, in a line; empty when there is one
  std::vector<DescribedFate> fates;         ///< what the device makes of what was asked for and written
  std::optional<MeasuredShaking>
      shaking;                        ///< of a program that vibrates; then force, bound, grade and texture are empty
  Measured force;                     ///< `max_newton` also of a rehearsal, when the program remembers
  ForceBound bound;                   ///< that no force exceeds, proved, and the largest that a search found
  bool limit_matters = false;         ///< without its last limit the program could ask for more than the device gives
  Interval asked;                     ///< of both components before that limit, N, as far as it is proved
  Grade grade;                        ///< how stable the loop is
  std::vector<Parameter> parameters;  ///< with the values described
  std::vector<State> states;          ///< a vector is two of them, "p.x" and "p.y"
  std::vector<Grid> memories;
  bool shows_relief = false, shows_colour = false;
  std::vector<Mark> marks;
  PatchSize patch;
  struct Code {
    std::size_t setup = 0, peaks = 0, enter = 0, tick = 0, picture = 0, frame = 0;  ///< instructions
    /// In units of one addition; peaks over all points, the picture's for one point.
    long setup_cost = 0, peak_cost = 0, enter_cost = 0, tick_cost = 0, picture_cost = 0, frame_cost = 0;
  } code;
  std::size_t bytes = 0;  ///< of the `.wpp` file
};

/// Describes a program at a bank's parameters. Runs it to measure its force. With the declarations of maps and rules
/// also what its force alone tells: percepts that its author did not speak of, and its texture.
Description describe(const Bank& bank, const Declarations* declarations = nullptr);

/// As people read it.
std::string description_text(const Description& description);
/// An object for one, an array for several.
std::string descriptions_json(const std::vector<Description>& descriptions);

/// "kept", "approximated", "saturated", "lost".
std::string fate_word(Fate fate);
/// "measured", "published", …
std::string evidence_word(Evidence evidence);
/// "point", "spring", …
std::string mark_word(MarkKind kind);

}  // namespace wale
