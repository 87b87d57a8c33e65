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
#include "wale/patch_program.hpp"

namespace wale {

struct Declarations;

/// A range of sizes; SI units.
struct SizeRange {
  double low = 0, high = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return value >= low && value <= high; }
};

/// A condition under which something was measured, or under which a case of a rule holds: "period", 0.7 mm .. 10 mm.
struct Condition {
  std::string quantity;
  SizeRange range;  ///< SI
  Dimension dimension;
  std::string written;  ///< the range as written, "0.7 mm .. 10 mm", "below 350 Hz"
  std::string unit;     ///< of its last number as written, "mm"; empty for a plain number
  double unit_in_si = 1;
  bool assumed = false;  ///< the range is assumed, not published
};

/// The sizes of what is felt by the names that conditions use, SI: "amplitude", "period", "rate", "speed".
using Sizes = std::map<std::string, double>;

/// A percept and its scale. Level 0 is none of it; level 1 is the magnitude of a carrier of size `one`, by any map that
/// is tied to it. Levels are linear in perceived magnitude.
struct Percept {
  std::string name;
  std::vector<std::string> words;  ///< words that people use for much of it
  std::string antonym;             ///< the reversed scale, with 1 - level; empty if there is none
  std::vector<std::string> antonym_words;

  std::string
      carrier;  ///< "lateral amplitude": the argument `amplitude` of the function `lateral`; empty if it is only read
  Dimension carrier_dimension;
  bool has_reference = false;    ///< there is a level 1; otherwise there are no levels, only an order
  double one = 0;                ///< the carrier's size at level 1, SI
  std::string reference_device;  ///< the device on which the reference stimulus was felt, or is defined
  bool absent_is_unknown = false;  ///< it belongs to a part of a thing, such as a wall, and without one nothing is known
                                   ///< of it; otherwise what has no carrier of it has the level 0
  double near_threshold = 0;     ///< level below which the percept is near or below threshold

  Extractor extractor = Extractor::none;
  SizeRange period;  ///< the periods that the extractor reads, m
  /// The least differences of a relief's share in `period` from 1 that count, of a relief that repeats and of one that
  /// does not.
  double least_share = 0, least_irregular_share = 0;
  std::string cue;    ///< the cue whose threshold tells two carriers apart; empty if there is none
  double exerts = 1;  ///< the force of a carrier of size 1, in N over the carrier's unit
  std::string documentation;
  Span span;

  /// The argument of the carrier, "amplitude"; empty for a percept that is only read.
  std::string argument() const {
    return carrier.substr(carrier.find(' ') == std::string::npos ? carrier.size() : carrier.find(' ') + 1);
  }
};

/// The meaning of a name in a `perceptual` block: a percept's scale, or the reversed scale.
struct PerceptName {
  const Percept* percept = nullptr;
  bool reversed = false;  ///< the name is an antonym: its level 0.8 is 0.2 on the scale
};

/// A map's law may contain the carrier of another percept, which is then solved first.
struct Coupling {
  std::string percept;
  std::string argument;  ///< its carrier's argument, the name in the law
};

/// The side of a quadratic's vertex on which the law is inverted; `only` if there is no choice.
enum class Branch { only, rising, falling };

/// A psychophysical map: an equation between a percept's magnitude and a carrier's size, with its evidence.
struct Map {
  std::string name;  ///< "minsky1995.figure19", to choose it by; may be empty
  std::string percept;
  std::string from;        ///< the quantity's name in the law, "amplitude"
  Dimension dimension;     ///< dimension of that quantity
  bool of_carrier = true;  ///< it is the carrier's argument; otherwise another quantity, such as a groove's width
  Terms terms;  ///< of the law, with `magnitude` and `carrier` terms (number 0 is `from`, 1 … are `couples` in order)
  TermId left = 0, right = 0;
  std::vector<std::array<double, 2>> table;  ///< instead of a law: size in SI and magnitude, both greater than zero,
                                             ///< the sizes rising; straight lines in logarithms between them
  std::vector<Coupling> couples;
  Branch branch = Branch::only;
  /// For a quantity that replaces the carrier on another kind of device: its size at level 1, SI. Otherwise nothing,
  /// and the percept's own size applies.
  std::optional<double> one;
  double valid_low = 0, valid_high = 0;  ///< range of the quantity, SI
  bool valid_assumed = false;            ///< that range is assumed, not published
  std::vector<Condition> conditions;     ///< other conditions of the measurement: "period", 0.7 mm .. 10 mm
  LawUncertainty uncertainty;
  StimulusDomain domain;  ///< the stimuli that it was measured with
  Evidence slope = Evidence::estimated, anchor = Evidence::estimated, handle = Evidence::estimated;
  bool tied = true;  ///< tied to the percept's reference stimulus; otherwise it can order stimuli but not set levels
  std::string device;
  std::string source;
  std::vector<std::string> quotes;    ///< the passages of the source that hold its figures
  std::vector<std::string> validity;  ///< the conditions as written, "period 0.7 mm .. 10 mm"
  Span span;
  bool exported = false;

  /// Whether one of its figures comes from answers that no person gave on a real device.
  bool simulated() const {
    return slope == Evidence::simulated || anchor == Evidence::simulated || handle == Evidence::simulated;
  }
  /// Whether one of its figures was recalled and not looked up.
  bool recalled() const {
    return slope == Evidence::recalled || anchor == Evidence::recalled || handle == Evidence::recalled;
  }
};

/// The task by which a threshold was measured. It relates the criterion, a share p of correct answers, to d'.
enum class Task {
  forced_choice,   ///< choose one of two; d' = sqrt(2) z(p)
  adjustment,      ///< make one equal to the other; d' = sqrt(2) z(p)
  yes_no,          ///< say whether there is a difference; d' = 2 z(p) for an unbiased observer
  one_interval,    ///< feel one of two and say which it is; d' = 2 z(p) for an unbiased observer
  identification,  ///< feel one of many and say which it is; gives `Threshold::recognised` and no d'
};

/// The smallest noticeable difference of a cue.
struct Threshold {
  std::string cue;       ///< "stiffness"
  Dimension dimension;   ///< dimension of the cue's size
  double published = 0;  ///< Weber fraction as published, at `criterion`
  Task task = Task::forced_choice;
  bool task_assumed = false;
  double criterion = 0;  ///< share of correct answers
  bool criterion_assumed = false;
  double weber = 0;  ///< Weber fraction at d' = 1
  double floor = 0;  ///< smallest difference at d' = 1 near the absolute threshold, SI; 0 if unknown
  bool floor_assumed = false;
  /// Of sizes felt one at a time, without another to compare with: how many people name correctly (absolute
  /// identification). Such a record has no fraction and tells no two sizes apart; 0 in all others.
  double recognised = 0;
  std::optional<Condition> valid;     ///< the sizes of the cue that were compared; empty if unknown
  std::vector<Condition> conditions;  ///< other conditions of the measurement: "speed", 25 mm/s .. 160 mm/s
  int observers = 0;                  ///< 0: not known
  Evidence evidence = Evidence::estimated, handle = Evidence::estimated;
  std::string device;  ///< the device or handle on which it was measured
  std::string source;
  std::vector<std::string> quotes;  ///< the passages of the source that hold its figures
  std::string name;                 ///< may be empty
  Span span;
  bool exported = false;

  /// Whether it comes from answers that no person gave on a real device.
  bool simulated() const { return evidence == Evidence::simulated || handle == Evidence::simulated; }
  /// Whether it was recalled and not looked up.
  bool recalled() const { return evidence == Evidence::recalled || handle == Evidence::recalled; }
  /// The distance of two sizes (SI, not negative) in just noticeable differences at d' = 1: ln(ratio) / ln(1 + w), or
  /// the difference divided by the floor if that is less. `Discrimination` chooses the publication that applies.
  double distance(double a, double b) const;
  /// Whether such sizes were compared (SI, signs do not count); 0 stands for a stimulus without the cue and counts as
  /// compared. True if the range is unknown.
  bool compared(double a, double b) const;
  /// The conditions of the measurement that two sizes of the cue, or one of two stimuli, do not meet, as written:
  /// "amplitude 2.5 N .. 10 N". Beyond them the threshold is extrapolated. A condition on a quantity that `of_a` or
  /// `of_b` lacks is not judged for that stimulus.
  std::vector<std::string> unmet(double a, double b, const Sizes& of_a, const Sizes& of_b) const;
};

/// What the cases of a rule are classes of.
enum class Classified {
  none,        ///< for the reader: nothing that is printed
  surface,     ///< a relief that repeats or does not, by its kind: "grating", "perlin"
  texture,     ///< a texture that repeats, by what people call it
  size,        ///< the elements of such a texture, by how they are felt
  confidence,  ///< a surface, by how sure people are that it is a texture
  layout,      ///< what lies side by side, by what makes it hard to tell
};

/// A classification of stimuli: the first case whose conditions hold.
struct Rule {
  struct Case {
    std::string label;  ///< "moguls"
    std::string says;   ///< "something between a texture and single features": what is printed; may be empty
    std::string kind;   ///< "perlin": the kind of surface that it is for; empty for any
    std::vector<Condition> conditions;
    std::optional<double> confidence, spread;  ///< mean and standard deviation of ratings, 0 .. 1
    Span span;
  };
  std::string name;
  Classified classified = Classified::none;
  std::vector<Case> cases;
  Evidence evidence = Evidence::estimated;
  std::string device;
  std::string source;
  std::vector<std::string> quotes;  ///< the passages of the source that hold its figures
  Span span;
  bool exported = false;

  /// The first case whose conditions all hold for the given sizes, or null. Sizes are SI, by the quantity's name; a
  /// condition on a missing size does not hold.
  const Case* first(const Sizes& sizes, const std::string& kind) const;
};

/// A device's rule for a percept of a material without physics: a force, or the shaking of a pad, and the map to use.
struct Realisation {
  const SyntaxTree* tree = nullptr;
  ExprId force = 0;            ///< for a pad: the amplitude of its shaking, an acceleration
  std::optional<ExprId> rate;  ///< for a pad: the frequency of its shaking
  double period = 0;           ///< for a pad: `period` if the material has none, m
  const Declarations* home = nullptr;
  std::string by;          ///< the map's name; empty if the rule names none
  double active_watt = 0;  ///< power that it gives to the hand by itself, W
  std::string owner;       ///< the device or class that declares the rule
};

/// A class of devices with the same abilities, and how each percept is rendered on them.
struct DeviceClass {
  std::string name;
  std::map<std::string, Realisation> realise;  ///< by percept
  std::string documentation;
  Span span;
};

/// The carrier's name on a pad, "roughness shaking"; realisations and maps call it `shaking`.
inline std::string shaking_carrier(const std::string& percept) { return percept + " shaking"; }

/// The inverse of the normal distribution: the z below which the share p lies, p in (0, 1).
double normal_quantile(double p);
/// d' for a share of correct answers, `criterion` in (0, 1).
double sensitivity(Task task, double criterion);

}  // namespace wale
