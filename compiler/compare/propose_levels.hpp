#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "wale/result.hpp"

namespace wale {

/// A level that people can tell from its neighbours.
struct ProposedLevel {
  double level = 0;                         ///< on the percept's scale, also if its antonym was asked for
  double size = 0;                          ///< of the carrier, in the proposal's unit
  double apart = 0;                         ///< from the level before, in just noticeable differences; 0 for the first
  const Threshold* threshold = nullptr;     ///< that gives `apart`; null for the first
  Evidence evidence = Evidence::estimated;  ///< of the threshold on this device
  const Threshold* floor = nullptr;         ///< whose smallest difference gives `apart`; null if the fraction does
  double least = 0;                         ///< SI: that difference
  std::vector<std::string> outside;         ///< the conditions of its measurement that are not met, as written
};

/// Levels of a percept at equal distances, counted in just noticeable differences at d' = 1. They go from the least to
/// the greatest level that a device renders within the range in which its map was measured.
struct LevelProposal {
  std::string asked;    ///< the name that was asked for: the scale's, or its antonym's
  std::string percept;  ///< the scale's
  bool reversed = false;
  std::string device, carrier, unit;
  const Map* map = nullptr;
  Evidence map_evidence = Evidence::estimated;  ///< the worst of its grades on this device
  std::vector<ProposedLevel> levels;            ///< two or more, rising on the scale

  /// The number of levels that people recognise alone, a whole number of 2 at least; `most` if it is unknown.
  std::size_t recognised() const;
  std::size_t most = 0;  ///< the largest number of levels one just noticeable difference apart: told apart side by side
  double apart = 1;      ///< just noticeable differences: the least distance that was asked for
  std::size_t fit = 0;   ///< the largest number of levels at that distance
  /// The percept of the walls in which this one is felt, which has to be asked for too; empty for one that is felt
  /// alone.
  std::string beside{};
  /// How many people recognise when each is felt alone; null if nobody has published it for this cue.
  const Threshold* recognition = nullptr;
  Evidence recognition_evidence = Evidence::estimated;  ///< the worst of its grades on this device
  int digits = 2;                                       ///< after the decimal point: the fewest that keep this distance
};

/// Proposes `steps` levels, 2 or more; without a number, as many as fit. Neighbours are at least `apart` just
/// noticeable differences from each other, more than 0.
///
/// Errors: `Code::unknown_name` and `unknown_device`; `malformed_value` for `steps` and `apart`; `percept_unrealised`
/// for a device that cannot render the percept; `no_map`, `several_maps` and `untied_map`; `no_threshold`; and
/// `close_levels` if so many levels would be closer than `apart`.
Result<LevelProposal> propose_levels(const std::string& percept, const std::string& device,
                                     std::optional<std::size_t> steps, double apart, const Declarations& declarations);

/// The same with as many levels as people recognise when each is felt alone, if that is known and they fit.
Result<LevelProposal> propose_recognised_levels(const std::string& percept, const std::string& device, double apart,
                                                const Declarations& declarations);

/// `levels roughness { level_1 0.1; level_2 0.24 }`: the proposal as a line of Wale. The names of an antonym's levels
/// rise with the antonym; the numbers are those of the scale.
std::string levels_line(const LevelProposal& proposal);
std::string proposal_text(const LevelProposal& proposal);
std::string proposal_json(const LevelProposal& proposal);

}  // namespace wale
