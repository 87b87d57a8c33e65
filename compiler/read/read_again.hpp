#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "compiler/read/read.hpp"
#include "compiler/read/slow_change.hpp"

namespace wale {

class KeptReadings;

/// What was measured of a program, before anything was made out of it: nearly all of the time that a reading takes.
struct ReadFirst {
  /// How much more the force pushes a hand at first, N.
  struct AtFirst {
    glm::dvec2 force{0};
    double uncertain = 0;  ///< so much at most: as it differs from place to place
    SlowChange slow;       ///< what comes or goes later
    /// N: where the swing differs from place to place, the means over time at some places; otherwise none.
    std::vector<glm::dvec2> means{};
  };

  std::optional<StaticForce> still;    ///< of hands at rest; nothing if it was not measured
  std::optional<ForceReading> moving;  ///< of hands that move, without `still`; nothing if it was not measured
  AtFirst at_first;                    ///< with `moving`
  /// If not null: what was measured of equal programs before is taken from there, and what is measured goes there.
  KeptReadings* kept = nullptr;
};

/// `read`, for a bank that may have been read before: what `first` has is not measured again, and it gets what is. The
/// reading is the same, to the bit. `first` is of a program with the same code and figures, at the same parameters, on a
/// patch of the same size; fates and texts may differ.
ForceReading read_again(const Bank& bank, const Declarations& declarations, ReadParts wanted, ReadFirst& first);

/// The reading of the relief alone, as of `read_again`, which may be asked for all else afterwards: `first` gets what is
/// measured, and `transcript` too. Nothing if what moving hands feel decides how much of the relief counts.
std::optional<ForceReading> read_relief(const Bank& bank, ReadFirst& first, StaticTranscript& transcript);

}  // namespace wale
