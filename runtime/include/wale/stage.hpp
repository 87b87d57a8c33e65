#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "wale/device.hpp"
#include "wale/program.hpp"
#include "wale/record.hpp"

namespace wale {

/// The latest of a run under way, for a live line.
struct Progress {
  double time = 0;  ///< s since the run began
  long ticks_run = 0, ticks_missed = 0;
  glm::vec2 position{0}, velocity{0};  ///< m, m/s
  Force force{0};                      ///< N, the actuator's
  bool inside = false;                 ///< the hand is within the patch
};

/// A recording to make of a run.
struct RecordTo {
  std::string file;  ///< that does not exist yet, by custom NAME.wrec
  std::string hand;  ///< what moves the handle, to say so: "simulated, lateral"
};

class RecordedRun;

struct RunOptions {
  double seconds = 0;             ///< how long; positive, may be fractional
  double most_newton = HUGE_VAL;  ///< the largest force that the user allows; positive
  bool virtual_time = false;      ///< as fast as possible on the calling thread, the same bit for bit each time
  /// About ten times a second, never on the real-time thread. In virtual time ten times per second of the run, between
  /// two ticks; what it does to the stage holds from the next tick on.
  std::function<void(const Progress&)> progress = {};
  /// Ends the run when it becomes true; a signal handler may set it.
  const std::atomic<bool>* stop = nullptr;
  /// Records every tick, and all that is done to the stage meanwhile, in a file, for `Recording` and `replay`. It is
  /// whole up to the last tick even if the process is killed.
  std::optional<RecordTo> record_to = {};
  /// s: of the run's end, that `RunResult::record` keeps. With less than everything a run may last as long as it likes,
  /// an infinite time too.
  double kept_seconds = HUGE_VAL;
  /// Whose beats are served instead of a clock's; `replay`'s own.
  RecordedRun* recorded = nullptr;
};

/// The times of one thing over the ticks of a run, in s. The percentiles come from a fixed histogram and are right
/// within 3 %.
struct Times {
  double p50 = 0, p99 = 0, maximum = 0;
};

/// How late ticks began, after their deadlines.
using Lateness = Times;

/// How long ticks took, as a whole and step by step.
struct TickCosts {
  enum Step : std::size_t {
    sample,   ///< the device: where the handle is
    find,     ///< its motion filtered, the patch under it found
    program,  ///< the patch's program
    guard,    ///< all guards
    command,  ///< the device: the force
    record,   ///< what is kept and shown
    steps
  };
  Times whole;
  std::array<Times, steps> of;
};

/// "sample", "find", …
std::string_view name_of(TickCosts::Step step);

/// On how many ticks each guard changed the force, and what the program's own memory had to mend.
struct GuardCounts {
  long not_a_number = 0;  ///< the program's force was none, so zero
  long device_limit = 0;  ///< beyond the device's peak force on an axis
  long user_limit = 0;    ///< beyond what the user allows
  long heat = 0;          ///< more than a motor bears that was hot already
  long energy = 0;     ///< held back, because the program gave more energy than it says, or more than the device gives
  long passivity = 0;  ///< damped, because the sampled loop gained energy
  long slew = 0;       ///< held back after a start, an entry, a leaving or a change of bank
  long overrun = 0;    ///< no force, after more than 20 ms in which nobody served the loop
  long stale = 0;      ///< no force, the position being an old one
  long lost = 0;       ///< no force, the device being gone
  long restored = 0;   ///< times that a state was not a number, so its initial value
};

struct RunResult {
  long ticks_run = 0;
  long ticks_missed = 0;  ///< periods that nobody served; they are skipped, never caught up
  Lateness lateness;
  std::optional<TickCosts> costs;  ///< nothing in virtual time
  GuardCounts guards;
  std::string scheduling;  ///< one line: what priority, memory locking and wakefulness of processors the loop got
  Record record;
  std::string record_problem;  ///< why there is less in the file than was run; empty where there is not
};

/// Patches on a device's workspace, and the loop that makes the one in front under the hand felt.
///
/// `place`, `add`, `move`, `replace` and `set` may be called from any thread, also during a run: setup and peaks are
/// computed on the thread that called `run`, and the result reaches the real-time thread whole.
class Stage {
 public:
  /// The device outlives the stage.
  explicit Stage(Device& device);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Puts a patch with its centre at `position` (m from the workspace's centre), in place of all before, its
  /// parameters at their defaults and its memory new. Its own size unless one is given. Parameters that are set later
  /// leave the memory as it is; each run begins with a new one. It is patch number 0, in layer 0.
  void place(const Program& program, glm::vec2 position = glm::vec2(0.0f));
  void place(const Program& program, glm::vec2 position, PatchSize size);

  /// Puts one more patch on the stage and gives its number, one more than the last one's. Where patches lie over one
  /// another the hand feels the one with the greatest `layer`, and among equals the one that came last; it enters a
  /// patch anew when it comes to it, also from another one. Finding it takes as long among a hundred thousand as among
  /// ten.
  std::size_t add(const Program& program, glm::vec2 position, PatchSize size, float layer = 0);

  /// Puts another program in the place of a patch's: same place, same layer, its own size where the patch had its own.
  /// Parameters that are not at their defaults keep their values where they have the same name and unit (held in their
  /// new ranges), states where they
  /// have the same name and unit and the hand stays on the patch, and memories where all have the same names, units,
  /// sizes and bounds.
  /// Takes effect within one tick of being ready, and slews. Refused when there is no such patch.
  std::optional<Refusal> replace(std::size_t patch, const Program& program);

  /// Moves a patch's centre to `position` (m from the workspace's centre). Takes effect within one tick of being ready,
  /// and slews where that changes what is felt. A patch's first move in a run takes as long to be ready as adding one
  /// does, some 0.1 s among a hundred thousand; from then on it takes as long as there are patches that were moved,
  /// however many stay. A hand at rest on a patch that is moved stays on it and keeps its memory; the energy that
  /// moving gives to it counts as the program's own. Refused when there is no such patch or the position is no number.
  std::optional<Refusal> move(std::size_t patch, glm::vec2 position);

  /// Sets a parameter of a patch, by its number or that of patch 0, in SI units. Refused when there is no patch or no
  /// such parameter, or when the value is not a number in its range.
  std::optional<Refusal> set(std::string_view parameter, float value);
  std::optional<Refusal> set(std::size_t patch, std::string_view parameter, float value);

  /// A patch at its present parameters: what `measure` and `predict` ask. Runs setup and peaks. There is no such patch:
  /// nothing.
  std::optional<Bank> bank(std::size_t patch = 0) const;

  /// Runs for `options.seconds` and leaves the device without force, whatever ends the run. Refused when the time is
  /// not positive or more of it is to be kept than a record holds (2^24 ticks), when the largest force is not positive,
  /// when nothing is placed, when the device's profile lacks what a loop needs, when a program pushes and the device
  /// only vibrates or the other way round, when it cannot be recorded, or while another run is under way.
  std::variant<RunResult, Refusal> run(const RunOptions& options);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wale
