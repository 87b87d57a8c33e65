#pragma once

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/expression/checked_experiment.hpp"
#include "compiler/expression/parameter_names.hpp"
#include "compiler/expression/value.hpp"

namespace wale {

/// A component's contribution to the level of a blend: its level, weighted by its share.
struct LevelShare {
  std::string component;
  double level = 0;  ///< the level that the component asks for
  TermId share = 0;  ///< a plain number at rate setup; the shares of a percept sum to 1, or to less if a component does
                     ///< not ask for it
};

/// A percept that a material asks for. They are in the order of the author's text: the first matters most.
struct AskedPercept {
  std::string name;
  double level = 0;
  double tolerance = 0;  ///< in both directions
  Span span;
  std::optional<Evidence> evidence{};  ///< how well the author knows the level; empty if not stated
  std::string by{};               ///< the map that the author chose; empty if none
  std::optional<Span> by_span{};  ///< of that name
  std::optional<Span> made_at{};  ///< the `between` that computed the level; diagnostics of the level point there
  bool essential = false;         ///< a device that cannot render it is refused
  /// The blend states no level of its own, so its level is the mean of its components' levels by weight; `level` is
  /// that mean at the default weights.
  bool blended = false;
  std::vector<LevelShare> shares{};  ///< of a blended percept

  /// Where the author asked for the level.
  Span place() const { return made_at.value_or(span); }
};

/// One number that is kept from tick to tick; a vector needs two.
struct CheckedState {
  std::string name;
  double low = 0, high = 0;  ///< SI
  TermId initial = 0;        ///< when the hand enters
  TermId next = 0;           ///< after the tick
  std::string si_unit;       ///< unit of its dimension
  Span span;
};

/// The new value of the cell nearest to (u, v), which are in cells from the centre of the first one.
struct CheckedWrite {
  TermId u = 0, v = 0, value = 0;
};

/// A field over the patch that is kept from tick to tick.
struct CheckedMemory {
  std::string name;
  Dimension dimension;
  double initial = 0, low = 0, high = 0;  ///< SI
  double cell = 0;                        ///< width of a cell, m
  std::optional<CheckedWrite> next;       ///< its update under the hand
  std::string si_unit;                    ///< unit of its dimension
  Span span;
};

/// A shape in the picture.
struct CheckedMark {
  MarkKind kind = MarkKind::point;
  std::vector<TermId> operands;
  std::uint32_t colour = 0;
};

/// A spatial period in the material, to compare with the resolution of the device's encoder.
struct CheckedPeriod {
  TermId length = 0;
  Span span;
};

/// A frequency at which something in the material goes by itself, to compare with the device's ticks.
struct CheckedRate {
  TermId frequency = 0;
  Span span;
};

/// A value that goes through cycles with the place: an angle, or the place in a noise.
struct CheckedCycle {
  TermId value = 0;
  bool turns = false;  ///< an angle, whose cycle is 2 pi; otherwise it is 1
  Span span;
};

/// What a root or a logarithm is taken of.
struct CheckedOperand {
  TermId value = 0;
  const char* words = "";
  Span span;
};

/// A material whose every expression has a meaning and a dimension. Vectors are pairs of terms, quantities in SI.
/// A `force` statement of a material.
struct WrittenForce {
  std::array<TermId, 2> force{};
  Span span;
  bool signed_by_author = false;  ///< it begins with a plus, or is a minus before a library's force
};

struct CheckedMaterial {
  std::string name;
  Span span;
  Terms terms;
  std::vector<HeightTable> tables;
  std::vector<Parameter> parameters;
  ParameterNames parameter_names;
  std::vector<Span> parameter_spans;  ///< the declaration of each
  std::vector<AskedPercept> percepts;
  std::vector<Carrier> carriers;
  std::vector<Span> open_spans;           ///< for each open quantity, the call that leaves it open
  std::set<std::uint32_t> blended_opens;  ///< open quantities that one open quantity of a blend replaces
  std::vector<CheckedState> states;
  std::vector<CheckedMemory> memories;
  std::vector<CheckedPeriod> periods;
  std::vector<CheckedRate> rates;
  std::vector<CheckedCycle> cycles;
  std::vector<CheckedOperand> operands;
  std::optional<std::array<TermId, 2>> force;
  std::optional<TermId> relief;  ///< the look of the surface, if there is one
  bool relief_is_length = false;
  std::optional<std::array<TermId, 3>> colour;  ///< red, green and blue in 0 .. 1, if the author gives a colour
  std::vector<CheckedMark> marks;
  Span force_span;
  std::vector<WrittenForce> forces;            ///< those of its own whose sum, with those of a blend, is `force`
  std::vector<Span> scaled_textures;           ///< where a constant factor changes an open texture
  std::optional<std::array<double, 2>> patch;  ///< width and height in m, if the material has a `patch`
  Span patch_span;
  double active_watt = 0;  ///< power that the author allows it to give, W; 0 without `active`
  Span active_span;
  Layers layers;
  std::vector<Diagnostic>
      doubts;  ///< of a value or an argument that was hardly meant, as reported: W0308, W0312, W0313
};

/// The outline of a workspace's patch. Lengths are in m, from the patch's centre; x goes to the right and y up.
struct RectangleOutline {};
struct EllipseOutline {};
struct PolygonOutline {
  std::vector<std::array<double, 2>> corners;  ///< in order, either way round; no edge crosses another
};
struct MaskOutline {
  std::string file;
  std::string colour =
      {};  ///< "#c04020": the one that it has in a picture of several; otherwise it is where it is light
  std::size_t columns = 0, rows = 0;
  double column = 0, row = 0;  ///< m, of one sample
  std::vector<bool> inside;    ///< row by row from the top, `columns` in each
};
using Outline = std::variant<RectangleOutline, EllipseOutline, PolygonOutline, MaskOutline>;

/// A range of a slider that a person has marked: from here to here it still felt like `says`.
struct SliderMark {
  std::string slider;               ///< a parameter or a percept of the material
  bool is_percept = false;          ///< its range is one of levels
  std::optional<double> low, high;  ///< SI; at least one of them
  std::string unit;                 ///< in which its ends are written
  std::string says;                 ///< may be empty
  Span span;
};

/// m; the rim of a patch that does not give its own. Neighbours fade into one another over no more than this.
inline constexpr double usual_rim = 1e-3;

/// A patch of a workspace.
struct CheckedPatch {
  std::string name;
  Span span;       ///< of its name and material
  Span name_span;  ///< of its name, or of the colour in a picture
  /// Shared by all patches of the same words, and named as the first of them.
  std::shared_ptr<const CheckedMaterial> material;
  std::optional<std::array<double, 2>> size;  ///< m, width and height, if the workspace gives one
  Span size_span;                             ///< of what gives the size
  std::string made_of;          ///< the material as written, "denim(roughness: 0.3)"
  std::array<double, 2> at{};   ///< m from the workspace's centre, of the patch's centre
  std::optional<Span> at_span;  ///< of the setting, if it is written
  Outline outline;
  std::optional<double> rim;  ///< m; the device's if none is given
  std::vector<SliderMark> marks;
  Span statement;     ///< all that is written of it: `patch board = oak { … }`, or a colour of a picture
  Span made_of_span;  ///< of `made_of`
  std::vector<std::pair<std::string, Span>> settings;  ///< those in its braces, in the order written
};

/// The patches of a workspace, the last in front.
struct CheckedWorkspace {
  std::string name;
  std::string documentation;
  Span span;       ///< of the name
  Span statement;  ///< of the whole declaration
  std::vector<CheckedPatch> patches;
};

/// A name of something that another declaration uses, with its place.
struct NamedThing {
  std::string name;
  Span span;
};

/// `movie demo { frames kitchen, workshop }`: workspaces that are stepped through.
struct CheckedMovie {
  NamedThing named;
  Span statement;
  std::string documentation;
  std::vector<NamedThing> frames;  ///< workspaces of the file
};

/// `keys sorting { of kitchen; area 80 mm, 80 mm }`: each patch of a workspace is chosen by a key with the mouse, and
/// felt in one area. Lengths are in m.
struct CheckedKeys {
  NamedThing named;
  Span statement;
  std::string documentation;
  NamedThing workspace;
  std::array<double, 2> area{};     ///< width and height of the area in which a chosen patch is felt
  std::array<double, 2> at{};       ///< its centre, from the workspace's centre
  std::optional<double> key;        ///< side of a key
  bool numbered_at_random = false;  ///< three digits on each, new before each sort; otherwise the patch's name
};

/// `groups sorted { of kitchen; group board, cloth, "rough" }`: how somebody sorted the patches of a workspace.
struct CheckedGroups {
  struct Group {
    std::vector<NamedThing> patches;
    std::string says;  ///< may be empty
    Span span;
  };
  NamedThing named;
  Span statement;
  std::string documentation;
  NamedThing workspace;
  std::vector<Group> groups;
};

/// A checked file with all modules that it refers to. The modules are kept because declarations point into them.
struct CheckedModule {
  ModuleSet modules;
  std::vector<CheckedMaterial> materials;  ///< those of the file itself, in the order written
  std::vector<CheckedWorkspace> workspaces;
  std::vector<CheckedMovie> movies;
  std::vector<CheckedKeys> keys;
  std::vector<CheckedGroups> groups;
  std::vector<CheckedExperiment> experiments;

  const Declarations& declarations() const { return modules.declarations(); }
  /// The material with that name, or with an empty name the first one of the file; null if there is none.
  const CheckedMaterial* material(const std::string& name) const;
  /// The workspace with that name; null if there is none.
  const CheckedWorkspace* workspace(const std::string& name) const;
  /// The experiment with that name, or with an empty name the first one of the file; null if there is none.
  const CheckedExperiment* experiment(const std::string& name) const;
};

}  // namespace wale
