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

#include "wale/device.hpp"
#include "wale/program.hpp"
#include "wale/record.hpp"

namespace wale {

/// The latest state of a run, for a live display.
struct Progress {
  double time = 0;  ///< s since the run began
  long ticks_run = 0, ticks_missed = 0;
  glm::vec2 position{0}, velocity{0};  ///< m, m/s
  Force force{0};                      ///< N, the actuator's
  bool inside = false;                 ///< the hand is within the patch
};

/// A recording to make of a run.
struct RecordTo {
  std::string file;  ///< must not exist yet; usually NAME.wrec
  std::string hand;  ///< what moves the handle, kept in the recording: "simulated, lateral"
};

class RecordedRun;

struct RunOptions {
  double seconds = 0;             ///< how long; positive, may be fractional
  double most_newton = HUGE_VAL;  ///< the largest force that the user allows; positive
  bool virtual_time = false;      ///< as fast as possible on the calling thread; every run gives the same bits
  /// Called about ten times a second, never on the real-time thread. In virtual time it is called between two ticks,
  /// ten times per second of the run; a change that it makes to the stage takes effect at the next tick.
  std::function<void(const Progress&)> progress = {};
  /// Ends the run when it becomes true; a signal handler may set it.
  const std::atomic<bool>* stop = nullptr;
  /// Records every tick and every change of the stage in a file, for `Recording` and `replay`. The file is complete up to
  /// the last tick even if the process is killed.
  std::optional<RecordTo> record_to = {};
  /// s: how much of the run's end `RunResult::record` keeps. With a finite value the run may be infinitely long.
  double kept_seconds = HUGE_VAL;
  /// Gives the beats instead of a clock; only `replay` sets it.
  RecordedRun* recorded = nullptr;
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
    record,   ///< stores the record and the progress
    steps
  };
  Times whole;
  std::array<Times, steps> of;
};

/// "sample", "find", …
std::string_view name_of(TickCosts::Step step);

/// On how many ticks each guard changed the force, and how often the program's memory was restored.
struct GuardCounts {
  long not_a_number = 0;  ///< zero, because the program's force was not a number
  long device_limit = 0;  ///< clamped to the device's peak force on an axis
  long user_limit = 0;    ///< clamped to the user's limit
  long heat = 0;          ///< reduced, because a motor was already hot
  long energy = 0;     ///< reduced, because the program gave more energy than it declares or than the device allows
  long passivity = 0;  ///< damped, because the sampled loop gained energy
  long slew = 0;       ///< slowed after a start, an entry, a leaving or a change of bank
  long overrun = 0;    ///< no force, because no tick had run for more than 20 ms
  long stale = 0;      ///< no force, because the position was an old one
  long lost = 0;       ///< no force, because the device was gone
  long restored = 0;   ///< times that a state was not a number and got its initial value again
};

struct RunResult {
  long ticks_run = 0;
  long ticks_missed = 0;  ///< periods without a tick; they are skipped and not made up for
  Lateness lateness;
  std::optional<TickCosts> costs;  ///< nothing in virtual time
  GuardCounts guards;
  std::string scheduling;  ///< one line: the priority that the loop got, and whether memory and processors were held
  Record record;
  std::optional<Error> record_problem;  ///< why the recording ended before the run; empty if it did not
};

/// Patches on a device's workspace, and the loop that lets the hand feel the front-most one under it.
///
/// `place`, `add`, `move`, `replace` and `set` may be called from any thread, also during a run: the thread that called
/// `run` then computes setup and peaks, and the real-time thread gets the finished result.
class Stage {
 public:
  /// The device must outlive the stage.
  explicit Stage(Device& device);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Removes all patches and adds one, with its centre at `position` (m from the workspace's centre), its parameters at
  /// their defaults and a new memory. It has the program's own size unless one is given. It is patch number 0, in layer
  /// 0. Setting a parameter later does not change the memory; each run begins with a new memory.
  void place(const Program& program, glm::vec2 position = glm::vec2(0.0f));
  void place(const Program& program, glm::vec2 position, PatchSize size);

  /// Puts one more patch on the stage and returns its number, one more than the last one's. Where patches overlap, the
  /// hand feels the one with the greatest `layer`, and among equals the one that was added last. The hand enters a
  /// patch anew each time it comes to it, also from another patch. Finding the patch takes as long among a hundred
  /// thousand patches as among ten.
  std::size_t add(const Program& program, glm::vec2 position, PatchSize size, float layer = 0);

  /// Replaces the program of a patch. The patch keeps its place and layer; where it had its program's own size, it gets
  /// the new program's. A parameter that is not at its default keeps its value if the new program has one of the same
  /// name and unit (clamped to the new range). A state keeps its value if the new program has one of the same name and
  /// unit and the hand stays on the patch. Grids keep their cells if all have the same names, units, sizes and bounds.
  /// Takes effect at the first tick after it is ready; then the force slews. Error: `malformed_value` without such a
  /// patch.
  Result<> replace(std::size_t patch, const Program& program);

  /// Moves a patch's centre to `position` (m from the workspace's centre). Takes effect at the first tick after it is
  /// ready; then the force slews if it has changed. A patch's first move in a run takes as long to be ready as adding
  /// one, some 0.1 s among a hundred thousand; later moves take time in proportion to the number of patches that have
  /// ever been moved in the run. If the hand is still on the moved patch, it does not enter anew and the memory goes
  /// on; the energy that moving gives to the hand counts as the program's own. Error: `malformed_value` without such a
  /// patch, or if the position is not finite.
  Result<> move(std::size_t patch, glm::vec2 position);

  /// Sets a parameter of patch 0 or of another patch, in SI units. Errors: `malformed_value` without such a patch, or
  /// if the value is not a number in the parameter's range; `unknown_name` without such a parameter.
  Result<> set(std::string_view parameter, float value);
  Result<> set(std::size_t patch, std::string_view parameter, float value);

  /// A bank of a patch with its present parameters, for `predict` and `levels_back`. Runs setup and peaks. Gives
  /// nothing if there is no such patch.
  std::optional<Bank> bank(std::size_t patch = 0) const;

  /// Runs for `options.seconds`. Afterwards the device exerts no force, also after an error. Errors:
  /// - `malformed_value`: the time is not positive, the record would keep more than 2^24 ticks, or the largest force is
  ///   not positive;
  /// - `wrong_moment`: nothing is placed, or another run is under way on this stage;
  /// - `unusable_device`: the device's profile lacks a figure that a loop needs;
  /// - `other_device`: a program pushes but the device only vibrates, or the other way round;
  /// - `unwritable_file`: the recording cannot be made;
  /// - `short_of_resources`: the system gives no thread.
  Result<RunResult> run(const RunOptions& options);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wale
