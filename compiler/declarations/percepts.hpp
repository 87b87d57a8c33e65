#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/dimension.hpp"
#include "compiler/graph/term.hpp"
#include "compiler/parse/syntax_tree.hpp"
#include "schema/patch_program.hpp"

namespace wale {

struct Declarations;

/// From one size to another; SI units.
struct SizeRange {
  double low = 0, high = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return value >= low && value <= high; }
};

/// A percept's scale: level 0 is none of it, level 1 the magnitude of a carrier of size `one` by any map tied to it,
/// linear in perceived magnitude in between.
struct Percept {
  std::string name;
  std::vector<std::string> words;  ///< that people use for much of it
  std::string antonym;  ///< the same scale the other way round, level for 1 - level; empty where there is none
  std::vector<std::string> antonym_words;

  std::string carrier;  ///< "lateral amplitude": the argument `amplitude` of the function `lateral`; empty: read only
  Dimension carrier_dimension;
  bool has_reference = false;    ///< there is a level 1; otherwise two of them have an order and no levels
  double one = 0;                ///< the carrier's size at level 1, SI
  std::string reference_device;  ///< on which the reference stimulus was felt, or is defined
  double near_threshold = 0;     ///< level below which the percept is near or below threshold

  Extractor extractor = Extractor::none;
  SizeRange period;   ///< m: the periods that the extractor reads
  std::string cue;    ///< the threshold by which two carriers are told apart; empty where there is none
  double exerts = 1;  ///< the force of a carrier of size 1, for the device's limit: N over the carrier's unit
  std::string documentation;
  Span span;

  /// The argument of the carrier, "amplitude"; empty for a percept that is only read.
  std::string argument() const {
    return carrier.substr(carrier.find(' ') == std::string::npos ? carrier.size() : carrier.find(' ') + 1);
  }
};

/// What a name in a `perceptual` block means: a scale, or its view from the other end.
struct PerceptName {
  const Percept* percept = nullptr;
  bool reversed = false;  ///< an antonym: its level 0.8 is the scale's 0.2
};

/// A map's law may speak of the carrier of another percept; that one is solved first.
struct Coupling {
  std::string percept;
  std::string argument;  ///< its carrier's, as the law names it
};

/// Which side of a quadratic's vertex is meant, where both could be.
enum class Branch { only, rising, falling };

/// A psychophysical map: an equation between a percept's magnitude and a carrier's size, and what is known of it.
struct Map {
  std::string name;  ///< "minsky1995.figure19", by which it is chosen; may be empty
  std::string percept;
  std::string from;        ///< the quantity's name in the law, "amplitude"
  Dimension dimension;     ///< of that quantity
  bool of_carrier = true;  ///< it is the carrier's argument; otherwise something that is only told, as a groove's width
  Terms terms;             ///< of the law, in `magnitude` and `carrier` (number 0: `from`, 1 …: `couples` in order)
  TermId left = 0, right = 0;
  std::vector<std::array<double, 2>> table;  ///< instead of a law: size in SI and magnitude, both greater than zero,
                                             ///< the sizes rising; straight lines in logarithms between them
  std::vector<Coupling> couples;
  Branch branch = Branch::only;
  /// Of a quantity that stands for the carrier on another kind of device: its size at level 1, SI. Where it is not
  /// there the percept's own holds.
  std::optional<double> one;
  double valid_low = 0, valid_high = 0;  ///< of the quantity, SI
  struct Condition {
    std::string quantity;
    SizeRange range;
    Dimension dimension;
  };
  std::vector<Condition> conditions;  ///< what else held while it was measured: "period", 0.7 mm .. 10 mm
  double scatter = 0;                 ///< standard deviation of log10 magnitude about the average observer's
  bool scatter_assumed = false;       ///< nobody published it
  double spread = 0;                  ///< standard deviation of the observers' own exponents; 0: not known
  int observers = 0;                  ///< 0: not known
  Evidence slope = Evidence::estimated, anchor = Evidence::estimated, handle = Evidence::estimated;
  bool tied = true;  ///< to the percept's reference stimulus; otherwise it orders and cannot set levels
  std::string device;
  std::string source;
  std::vector<std::string> validity;  ///< the conditions as written, "period 0.7 mm .. 10 mm"
  Span span;
  bool exported = false;

  /// Whether somebody remembered a figure of it and nobody has looked it up.
  bool recalled() const {
    return slope == Evidence::recalled || anchor == Evidence::recalled || handle == Evidence::recalled;
  }
};

/// How a threshold was found: what its criterion, a share of correct answers, says of d'.
enum class Task {
  forced_choice,  ///< which of two; d' = sqrt(2) z(p)
  adjustment,     ///< one made equal to the other; the same
  yes_no,         ///< whether there is a difference; d' = 2 z(p) for an observer without a bias
};

/// How small a difference of a cue is noticed.
struct Threshold {
  std::string cue;       ///< "stiffness"
  Dimension dimension;   ///< of the cue's size
  double published = 0;  ///< Weber fraction as published, at `criterion`
  Task task = Task::forced_choice;
  double criterion = 0;  ///< share of correct answers
  bool criterion_assumed = false;
  double weber = 0;  ///< Weber fraction at d' = 1
  double floor = 0;  ///< least difference at d' = 1 near the absolute threshold, SI; 0: not known
  bool floor_assumed = false;
  SizeRange valid;    ///< sizes of the cue that were compared, SI
  int observers = 0;  ///< 0: not known
  Evidence evidence = Evidence::estimated, handle = Evidence::estimated;
  std::string device;  ///< or handle, on which it was measured
  std::string source;
  std::string name;  ///< may be empty
  Span span;
  bool exported = false;

  /// Whether somebody remembered it and nobody has looked it up.
  bool recalled() const { return evidence == Evidence::recalled || handle == Evidence::recalled; }
  /// How far apart two sizes are, in just noticeable differences at d' = 1: ln(ratio) / ln(1 + w), but the difference
  /// over the floor where that is less. Sizes are SI and not below 0. `Discrimination` says which publication counts.
  double distance(double a, double b) const;
};

/// A classification read off a stimulus: the first case that holds.
struct Rule {
  struct Case {
    std::string label;  ///< "moguls"
    std::string kind;   ///< "perlin": what kind of surface it speaks of; empty for any
    std::vector<Map::Condition> conditions;
    std::optional<double> confidence, spread;  ///< mean and standard deviation of ratings, 0 .. 1
    Span span;
  };
  std::string name;
  std::vector<Case> cases;
  Evidence evidence = Evidence::estimated;
  std::string device;
  std::string source;
  Span span;
  bool exported = false;

  /// The first case all of whose conditions hold for the given sizes (SI, by the quantity's name; one that is missing
  /// holds for no condition), or null.
  const Case* first(const std::map<std::string, double>& sizes, const std::string& kind) const;
};

/// What stands for a percept where the physics is left open, and through which map: a force, or how a pad shakes.
struct Realisation {
  const SyntaxTree* tree = nullptr;
  ExprId force = 0;            ///< of a pad the amplitude of its shaking, an acceleration
  std::optional<ExprId> rate;  ///< of a pad: how often a second
  double period = 0;           ///< of a pad, m: what `period` is where the material tells none
  const Declarations* home = nullptr;
  std::string by;          ///< the map's name; empty where there is only one to choose
  double active_watt = 0;  ///< that it gives to the hand by itself
  std::string owner;       ///< the device or class that says so
};

/// Devices alike in what they can do, and how each percept is rendered on them.
struct DeviceClass {
  std::string name;
  std::map<std::string, Realisation> realise;  ///< by percept
  std::string documentation;
  Span span;
};

/// The carrier's name on a pad, "roughness shaking": what its realisations and maps call `shaking`.
inline std::string shaking_carrier(const std::string& percept) { return percept + " shaking"; }

/// How much of a normal distribution lies below z, turned round: z of the share p in (0, 1).
double normal_quantile(double p);
/// d' of a share of correct answers.
double sensitivity(Task task, double criterion);

}  // namespace wale
