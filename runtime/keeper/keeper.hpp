#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/keeper/keeper_board.hpp"
#include "runtime/keeper/let_go_plan.hpp"
#include "wale/result.hpp"

namespace wale {

/// ns that the computer has been asleep since it was started. Real-time.
std::int64_t nanoseconds_asleep() noexcept;

struct KeeperOptions {
  std::string program = {};  ///< the program `wale-keeper`; empty: it is found beside the executable
  std::int64_t (*asleep)() noexcept = nanoseconds_asleep;
};

/// The keeper of one open device: a process of its own that lets the device go when this process dies, hangs or is
/// stopped. While the device pushes, the loop has to `beat`; after 100 ms without a beat, or when this process is dead,
/// the keeper sets a latch, takes the device, lets it go, and holds it until this object is gone or the process is
/// dead. Whoever sends packets looks at it before each one. Without a keeper nothing may push.
class Keeper {
 public:
  /// Starts one for a device that is set up and does not push yet. `descriptor` is that of its node; the keeper gets a
  /// copy. Waits until the keeper watches: a few milliseconds. Error: `no_keeper`.
  static Result<std::unique_ptr<Keeper>> start(const LetGoPlan& plan, int descriptor, const KeeperOptions& options);
  /// Call it when no thread sends packets to the device any more. Ends the keeper, and waits for that, a second at
  /// most.
  ~Keeper();
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  /// The loop ticks. Real-time: reads the clock without a system call, and stores a number. From one thread.
  void beat() noexcept;

  enum class Verdict : std::uint8_t {
    good,     ///< packets may go
    late,     ///< the loop has not ticked for 100 ms: only packets that do not push may go
    stalled,  ///< the loop ticks again after a second in which the device pushed and nobody took it, since the keeper
              ///< was stopped too: as `late`, and the device has to be set up again
    slept,    ///< the computer was asleep since the start: as `stalled`
    gone,     ///< the keeper has died or does not look: as `stalled`
    latched,  ///< the keeper has the device: no packet may go, of whatever kind
  };
  /// For the threads that send packets, before each. Allocates nothing, takes no lock, does not throw; asks the kernel
  /// once whether the keeper lives.
  Verdict look() const noexcept;

  /// A packet that makes the device push is about to be sent; and: the device has taken one after which it pushes
  /// nothing, and no other is on its way. Real-time: a store.
  void note_push() noexcept { board_->pushes.store(1, std::memory_order_seq_cst); }
  void note_slack() noexcept { board_->pushes.store(0, std::memory_order_release); }

  /// Why the device had to be given up, for a person; a literal. Empty for `good` and `late`.
  std::string_view why(Verdict verdict) const noexcept;

  pid_t process() const noexcept { return process_; }

 private:
  Keeper(KeeperBoard* board, int wake, const KeeperOptions& options) noexcept;
  bool lives() const noexcept;
  bool was_asleep() const noexcept;

  KeeperBoard* board_;
  int wake_;        // an eventfd that the keeper waits for
  int pidfd_ = -1;  // of the keeper
  pid_t process_ = 0;
  std::int64_t (*asleep_)() noexcept;
  std::int64_t asleep_before_;  // ns, when this began
  std::atomic<bool> stalled_{false};
};

/// Lets all devices of this process go that have a keeper, and waits until that is done, 200 ms at most. Nothing of
/// this process pushes afterwards. For handlers of signals, before the process ends: async-signal-safe. The library
/// installs no handler itself.
void let_all_devices_go() noexcept;

}  // namespace wale
