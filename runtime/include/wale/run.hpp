#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "wale/device.hpp"
#include "wale/patch.hpp"
#include "wale/record.hpp"

namespace wale {

/// On how many ticks each guard changed the force, and how often the program's memory was restored. What Wale compiles
/// keeps to its device by itself: it cuts its force to the peak, which `fates` of its description tell, and gives none
/// where that is not a number. So the first two count for other programs.
struct GuardCounts {
  long not_a_number = 0;  ///< zero, because the program's force was not a number
  long device_limit = 0;  ///< clamped to the device's peak force on an axis
  long user_limit = 0;    ///< clamped to the user's limit
  long heat = 0;          ///< reduced, because a motor was already hot
  long energy = 0;        ///< reduced, because the program gave more energy than it declares or than the device allows
  long passivity = 0;     ///< damped, because the sampled loop gained energy
  long slew = 0;          ///< slowed after a start, an entry, a leaving or a change of bank
  long overrun = 0;       ///< no force, because no tick had run for more than 20 ms
  long stale = 0;         ///< no force, because the position was an old one
  long lost = 0;          ///< no force, because the device was gone
  long restored = 0;      ///< times that a state was not a number and got its initial value again
};

/// The state of a run after its latest tick.
struct Now {
  double time = 0;  ///< s since the run began
  long ticks_run = 0, ticks_missed = 0;
  double lateness = 0;                 ///< s, how long after its deadline the tick began
  glm::vec2 position{0}, velocity{0};  ///< of the hand, m from the workspace's centre, m/s
  /// N, the actuator's at that tick; of a pad its vibration, m/s^2 and Hz. After the run the device exerts none,
  /// whatever its last tick had. After a run that failed (no memory, or `progress` threw) it is 0.
  Force force{0};
  bool inside = false;  ///< the hand is on a patch; after the run: was on one at its last tick; false if it failed
  std::optional<Patch> patch = {};     ///< the one that it is on
  long revision = 0;                   ///< how often changes had been handed over to the loop
  GuardCounts guards;                  ///< since the run began
};

/// The hand of a run as `show` of wale/picture.hpp takes it, on a patch that lies as `placement` says: its `position`
/// counts from the patch's centre, its `workspace` from the workspace's, and on a patch with a shape it has its distance
/// to the edge. What a run does not tell is missing: raw velocities are the filtered ones, and accelerations are 0.
Hand hand_on(const Now& now, const Placement& placement);

enum class ContactKind {
  enter,    ///< the hand comes onto a patch
  leave,    ///< it leaves the patch, or the patch is taken away from under it; the end of a run is no leaving
  press,    ///< the device's button goes down on a patch
  release,  ///< it goes up on a patch
};

/// A moment at which a hand and a patch begin or end to touch, or the button changes.
struct ContactEvent {
  ContactKind kind = ContactKind::enter;
  Patch patch;
  double time = 0;                     ///< s since the run began
  glm::vec2 position{0}, velocity{0};  ///< of the hand, m from the workspace's centre, m/s
  Force force{0};                      ///< N, the actuator's from this tick on
};

/// So many contacts wait for `Stage::poll` at most; later ones are dropped and counted.
inline constexpr std::size_t most_contacts_waiting = 1024;

struct RunOptions {
  double seconds = 0;         ///< how long; positive, may be fractional; as many as `kept_seconds` lets be kept
  bool virtual_time = false;  ///< as fast as possible on the calling thread; the same bits on each new device
  /// Called about ten times a second, never on the real-time thread; changes of the stage are not handed over while it
  /// runs, so it should return soon. In virtual time it is called between two ticks, ten times per second of the run; a
  /// change that it makes to the stage takes effect at the next tick. What it throws ends the run: the device exerts no
  /// force, the recording is whole up to there, and `run` throws it on. (C and Python have no progress: they ask
  /// `Stage::now` from another thread.)
  std::function<void(const Now&)> progress = {};
  /// Ends the run when it becomes true; a signal handler may set it.
  const std::atomic<bool>* stop = nullptr;
  /// s: how much of the run's end `RunResult::record` keeps, 2^24 ticks at most (4.6 hours at 1000 Hz). With less than
  /// that the run may be infinitely long.
  double kept_seconds = HUGE_VAL;
};

/// Statistics of a duration over the ticks of a run, in s. The percentiles come from a fixed histogram and are accurate
/// to 3 %.
struct Times {
  double p50 = 0, p99 = 0, maximum = 0;
};

/// How long after their deadlines ticks began.
using Lateness = Times;

/// How long ticks took, as a whole and step by step.
struct TickCosts {
  enum Step : std::size_t {
    sample,   ///< reads the handle's position from the device
    find,     ///< filters its motion and finds the patch under it
    program,  ///< runs the patch's program
    guard,    ///< applies all guards
    command,  ///< sends the force to the device
    record,   ///< stores the record and the state for others
    steps
  };
  Times whole;
  std::array<Times, steps> of;
};

/// "sample", "find", …
std::string_view name_of(TickCosts::Step step);

struct PatchesInRun;

struct RunResult {
  long ticks_run = 0;
  long ticks_missed = 0;  ///< periods without a tick; they are skipped and not made up for
  Lateness lateness;
  std::optional<TickCosts> costs;  ///< nothing in virtual time
  GuardCounts guards;
  std::string scheduling;               ///< one line: what the loop asked of the system, and what it got
  Record record;                        ///< of `run`; empty after `start`, which keeps none
  std::optional<Error> record_problem;  ///< why the recording ended before the run; empty if it did not
  /// What the run's last patches were, for `measure` of wale/felt.hpp.
  std::shared_ptr<const PatchesInRun> patches;
};

}  // namespace wale
