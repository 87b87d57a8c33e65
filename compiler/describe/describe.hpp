#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/grade/grade.hpp"
#include "compiler/measure/measure.hpp"
#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"
#include "wale/program.hpp"

namespace wale {

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
  bool saturated = false;    ///< the device pushes less than the percept needs; level is what comes out
  bool outside_validity = false;
  bool alone = true;  ///< nothing but this carrier pushes; otherwise a run cannot read the level back
  Evidence slope, anchor, handle, worst;
  std::string map, device, source;
};

/// A program in words and figures: what `wale describe` shows. SI units.
struct Description {
  std::string material;
  DeviceProfile device;
  Layers layers;
  std::vector<DescribedPercept> percepts;
  std::string no_percept;             ///< why none is of a texture, in a line; empty when there is one
  Measured force;                     ///< `max_newton` also of a rehearsal, when the program remembers
  ForceBound bound;                   ///< that no force exceeds, proved, and the largest that a search found
  bool limit_matters = false;         ///< without its last limit the program could ask for more than the device gives
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

/// Describes a program at a bank's parameters. Runs it to measure its force.
Description describe(const Bank& bank);

/// As people read it.
std::string description_text(const Description& description);
/// An object for one, an array for several.
std::string descriptions_json(const std::vector<Description>& descriptions);

/// "measured", "published", …
std::string evidence_word(Evidence evidence);
/// "point", "spring", …
std::string mark_word(MarkKind kind);

}  // namespace wale
