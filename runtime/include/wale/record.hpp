#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <iosfwd>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// One tick of a run.
struct TickRecord {
  double time = 0;            ///< s since the run began
  glm::vec2 position{0};      ///< m from the workspace's centre, by the encoder
  glm::vec2 velocity{0};      ///< m/s, filtered
  /// N, told to the actuator from this tick on (clamped, in its steps, held): its delay and bandwidth are not in it. Of a
  /// pad its vibration, m/s^2 and Hz.
  Force force{0};
  Force interaction{0};       ///< N from hand to handle over the period before; not-a-number where unknown
  float lateness = 0;         ///< s, how long after its deadline the tick began
  std::uint32_t skipped = 0;  ///< periods that were not served just before this tick
  bool inside = false;        ///< the hand was within a patch
  std::uint32_t change = 0;   ///< another number after each change of that patch's program, parameters or size
  std::uint64_t patch = 0;    ///< `Patch::id` of that patch; 0: the hand was on none
};

/// A run, tick by tick.
struct Record {
  double seconds_per_tick = 0;
  bool vibrates = false;  ///< the device is a pad
  std::vector<TickRecord> ticks;
};

/// Writes one line per tick under a header with units. Numbers have the fewest digits that read back as the same
/// numbers. Unknown values are empty.
void write_csv(std::ostream& out, const Record& record);

}  // namespace wale
