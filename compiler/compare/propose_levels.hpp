#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/declarations/declarations.hpp"

namespace wale {

/// A level that a person can tell from its neighbours.
struct ProposedLevel {
  double level = 0;                         ///< of the scale, whatever end it was asked for from
  double size = 0;                          ///< of the carrier, in the proposal's unit
  double apart = 0;                         ///< from the level before, in just noticeable differences; 0 for the first
  const Threshold* threshold = nullptr;     ///< by which; null for the first
  Evidence evidence = Evidence::estimated;  ///< of the threshold on this device
};

/// Levels of a percept that are evenly far apart in just noticeable differences at d' = 1, from the least to the
/// greatest that a device renders within what its map was measured for.
struct LevelProposal {
  std::string asked;    ///< the name that was asked for: the scale's, or its antonym's
  std::string percept;  ///< the scale's
  bool reversed = false;
  std::string device, carrier, unit;
  const Map* map = nullptr;
  Evidence map_evidence = Evidence::estimated;  ///< the worst of its grades on this device
  std::vector<ProposedLevel> levels;            ///< two or more, rising on the scale
  std::size_t most = 0;                         ///< as many would be as far apart as was asked for at least
  int digits = 2;                               ///< behind the point: as few as keep them that far apart
};

/// `steps` levels, or without a number as many as are `apart` just noticeable differences from each other, which
/// neighbours are at least in any case. What is said instead, says why there are none: nothing has that name, nobody
/// knows how little of it is noticed, or so many would be too close.
std::variant<LevelProposal, std::string> propose_levels(const std::string& percept, const std::string& device,
                                                        std::optional<std::size_t> steps, double apart,
                                                        const Declarations& declarations);

/// `levels roughness { level_1 0.1; level_2 0.24 }`: the proposal as a line of Wale.
std::string levels_line(const LevelProposal& proposal);
std::string proposal_text(const LevelProposal& proposal);
std::string proposal_json(const LevelProposal& proposal);

}  // namespace wale
