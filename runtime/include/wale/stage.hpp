#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "wale/device.hpp"
#include "wale/patch.hpp"
#include "wale/program.hpp"
#include "wale/run.hpp"

namespace wale {

class Loop;

/// A priority for a loop under SCHED_FIFO: above the interrupt threads of a PREEMPT_RT kernel (50), below its watchdogs
/// and migration threads (99).
inline constexpr int usual_priority = 80;

/// A recording to make of a run.
struct RecordTo {
  std::string file;  ///< must not exist yet nor be empty; usually NAME.wrec; counts from the current folder when the stage is made
  /// What moves the handle, kept in the recording: "simulated, lateral"; one line of UTF-8, or empty. Otherwise the
  /// run gives `invalid_encoding` or `malformed_value`.
  std::string hand;
};

/// What a stage does to its process and to the system. With the defaults it does nothing but make threads: one that
/// serves the ticks, one that prepares banks, one that hands over changes (`run` uses its caller's), and one that
/// writes a recording if there is one.
struct StageOptions {
  /// SCHED_FIFO with this priority, 1 .. 99, for the thread that serves the ticks. Otherwise it has the priority of the
  /// thread that calls `run` or `start`. If the system refuses, the run goes on without; `RunResult::scheduling` says
  /// so.
  std::optional<int> priority = {};
  /// Locks the pages that the loop itself uses (`mlock`): its stack, its own state, banks and memories of patches.
  /// Pages of the heap stay locked when the run has ended, since others may share them; never locks or unlocks anything
  /// else.
  bool lock_memory = false;
  /// Keeps processors out of sleep states that take long to leave, during a run (`/dev/cpu_dma_latency`, for the whole
  /// system; needs permission, and costs power).
  bool low_latency = false;
  double max_force = HUGE_VAL;  ///< N, the largest force that the user allows (on a pad m/s^2); positive
  /// Records the run in this file, tick by tick as it happens. Until the run ends the file is read-only (0444), and one
  /// whose process was killed stays so. It must not exist yet, so a stage that records has one
  /// run: another one is refused while the file is there.
  std::optional<RecordTo> record = {};
};

/// Several changes that are felt at one tick, all or none. One thread at a time may use an edit; it may outlive its
/// stage. An edit that is destroyed without `commit` changes nothing. One that was moved from gives `wrong_moment`.
///
/// Where memory ends within a call (it throws std::bad_alloc), that call has done nothing and `commit` gives
/// `short_of_resources`. Where it ends within `commit`, nothing has changed, and the same edit may be committed again.
class StageEdit {
 public:
  StageEdit(StageEdit&&) noexcept;
  StageEdit& operator=(StageEdit&&) noexcept;
  ~StageEdit();

  /// As `Stage::add`. The handle names the patch from `commit` on; within this edit it may be used at once. An error
  /// comes from `commit` too.
  Result<Patch> add(const Program& program, const PatchOptions& options = {});
  /// As the calls of `Patch` of the same names. The error comes from `commit`.
  void set(const Patch& patch, std::string_view parameter, double value);
  void move(const Patch& patch, glm::vec2 to);
  void resize(const Patch& patch, PatchSize size);
  void replace(const Patch& patch, const Program& program);
  void enable(const Patch& patch, bool enabled = true);
  void bring(const Patch& patch, const BringOptions& to);
  void remove(const Patch& patch);
  /// Makes the next `commit` fail with this error, unless an earlier call of the edit has failed. For whoever finds out
  /// by himself that a change cannot be made, such as a binding that checks its arguments. If it is the code of no error,
  /// or has no sentence (which only `short_of_resources` may lack), the commit gives `malformed_value` instead.
  void fail(Error error);

  /// Makes all changes. They are felt together, as soon as all banks are ready; until then these patches stay as they
  /// are. A later edit of one of them waits until then as a whole; a newer one replaces what it changes too. Errors:
  /// those of the changes, of the first that has one; then nothing has changed, and patches added in the edit do not
  /// exist. Afterwards the edit is empty and may be used again.
  Result<> commit();

 private:
  friend class Stage;
  struct Parts;
  explicit StageEdit(std::weak_ptr<StageState> stage);
  std::unique_ptr<Parts> parts_;
};

/// Patches on a device's workspace, and the loop that lets the hand feel the front-most one under it.
///
/// All calls except the constructors, the destructor and assignment are safe from any thread. Only `now` is for a
/// real-time thread too. Calls of a stage that was moved from give `wrong_moment`, or nothing where they give no error.
///
/// The same holds in a child of `fork` for a stage that its parent has made, and for its patches, edits and loops: the
/// threads that serve it, and its device, are the parent's. Their destructors do nothing in the child and return at
/// once. The child may make stages of its own, on devices that it opens itself.
class Stage {
 public:
  /// Takes the device. Without one, nothing fits on the stage and it cannot run.
  explicit Stage(std::unique_ptr<Device> device, StageOptions options = {});
  /// The device must outlive the stage, and a run of it. Several stages may be made on one device, and one of them runs
  /// at a time.
  explicit Stage(Device& device, StageOptions options = {});
  /// Without a device, for a `Loop` of one's own.
  explicit Stage(const DeviceProfile& profile, StageOptions options = {});
  /// Ends a run that is under way and waits for its end, also for one that another thread has called. (Within
  /// `progress` of a run on this thread it does not wait; then the run ends when `progress` returns.)
  ~Stage();
  Stage(Stage&&) noexcept;
  Stage& operator=(Stage&&) noexcept;

  /// Puts a patch on the stage, in front of all others of its layer, with its parameters at their defaults and a new
  /// memory. Each run begins with new memories. The hand enters a patch anew each time it comes to it, also from
  /// another patch. Finding the patch takes as long among a hundred thousand patches as among ten. Errors:
  /// `malformed_value` for an option out of its range; `other_device` for a program that was built for another device,
  /// or that pushes where the device only vibrates, or the other way round; `other_figures` if its forces, places or
  /// times would mean something else by the figures of this device (schema/PATCH_PROGRAM.md lists them).
  Result<Patch> add(const Program& program, const PatchOptions& options = {});

  /// Begins an edit.
  StageEdit edit();

  /// How many patches there are.
  std::size_t size() const;

  /// Runs for `options.seconds` on threads of its own, or in virtual time on the calling one; returns at the end. Then
  /// the device exerts no force, also after an error. In real time a run begins when all patches are ready, or after 30
  /// ms; the rest follow. Errors:
  /// - `malformed_value`: the time is not positive, the record would keep more than 2^24 ticks, the largest force is
  ///   not positive, or the priority is not in 1 .. 99;
  /// - `wrong_moment`: nothing is on the stage, it has no device, or another run is under way on it, or one that
  ///   `start` began waits for its `stop`, or another stage runs on its device, or the device was opened by the parent
  ///   of this process;
  /// - `unusable_device`: the device's profile lacks a figure that a loop needs, or one is out of its range;
  ///   `place.name` is it. It needs a rate and a peak; with a position also workspace, counts, speed limit. One that
  ///   pushes needs a slew: without it the force could jump by its whole range under a hand. (A pad may be without:
  ///   then its amplitude is not slowed. To slow nothing on purpose, declare a slew of 1e9 N/s.)
  /// - `unwritable_file`: the recording cannot be made;
  /// - `short_of_resources`: the system gives no thread.
  Result<RunResult> run(const RunOptions& options);

  /// Begins an endless run in real time and returns. Unlike `run` it may begin without a patch, and keeps no record.
  /// Errors as for `run`.
  Result<> start();
  /// Ends the run that `start` began, waits for its end and gives its figures. The device then exerts no force. Errors:
  /// - `wrong_moment`: `start` has begun no run since the last `stop`;
  /// - `short_of_resources`: the run failed, since the system gave its loop no thread.
  Result<RunResult> stop();
  /// Whether a run is under way.
  bool is_running() const;

  /// The state after the latest tick of the present run or the last one. Never waits for another thread. Real-time:
  /// allocates nothing, takes no lock, makes no system call, does not throw.
  Now now() const noexcept;

  /// What `poll` calls for each contact; an empty function ends it. Contacts are noted only while there is one.
  void on_contact(std::function<void(const ContactEvent&)> receive);
  /// Calls the receiver for all contacts since the last poll, in their order, on the calling thread. Two threads that
  /// poll take turns; a `poll` within a receiver does nothing and returns 0. Returns how many contacts were dropped
  /// because `most_contacts_waiting` were waiting. What a receiver throws comes out of `poll`; the contact that it was
  /// called for is gone, and the others wait for the next `poll`.
  std::size_t poll();

 private:
  friend class Loop;
  std::shared_ptr<StageState> state_;
};

}  // namespace wale
