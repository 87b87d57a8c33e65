#pragma once

#include <memory>

#include "wale/device.hpp"
#include "wale/run.hpp"

namespace wale {

class Stage;

/// A run of a stage whose ticks the program serves itself, on a thread of its own and by its own clock, with its own
/// reading and its own command. The filters, all guards and the passivity observer are in it.
///
///     Stage stage(profile);
///     Result<Loop> loop = Loop::begin(stage);
///     for (;;) { wait_for_the_period(); send(loop->step(read())); }
class Loop {
 public:
  /// Begins a run of the stage; its own device, if it has one, is not used. A thread of the loop hands over changes of
  /// the patches, and one prepares banks. Errors as for `Stage::start`.
  static Result<Loop> begin(Stage& stage);
  /// Ends the run; in a child of `fork` nothing, since the run is the parent's.
  ~Loop();
  Loop(Loop&&) noexcept;
  Loop& operator=(Loop&&) noexcept;

  /// Serves one tick: the force (N; of a pad its amplitude and frequency) to command for this reading. `periods` have
  /// passed since the last step, 1 unless some were missed; less counts as 1, more than 2^31 - 1 as so many. Where
  /// `periods` says that more than 20 ms were missed, the force is 0 once and slews back. Readings that make no sense
  /// count as for `Device::sample`. A loop that was moved from gives 0, and so does one in a child of `fork`, whose
  /// parent has made it. One thread at a time.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force step(const Reading& reading, long periods = 1) noexcept;
  /// The force that the actuator really exerts since the last step, where the device tells it, also for `now` and the
  /// recording; otherwise the commanded one counts, also for one that is not finite. Real-time as `step`.
  void exerted(Force force) noexcept;

 private:
  struct Parts;
  explicit Loop(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace wale
