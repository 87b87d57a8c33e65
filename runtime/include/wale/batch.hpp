#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

/// Independent instances of one program. Each has its own hand and its own states, which it keeps from tick to tick;
/// all read the same grids, which nothing writes. For simulated experiments, grading and other predictions of many
/// hands. Bit-identical to a `tick` with a `Memory` whose grids do not change.
///
/// Instances run in blocks of lanes and are independent: their order and number change no bit. The bank need not
/// outlive the batch. One thread at a time may use a batch. One that was moved from
/// has no hands, and does nothing.
class Batch {
 public:
  /// `instances` hands, none of which has entered. Grids have their present values in `grids` if that is a memory of
  /// the bank's program, otherwise their initial ones. Allocates; copies the registers and the grids once for all
  /// instances.
  Batch(const Bank& bank, std::size_t instances, const Memory* grids = nullptr);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  std::size_t size() const;

  /// All hands enter, as in `Memory::enter`. `hands` is as long as the batch.
  void enter(std::span<const Hand> hands);
  /// One tick of as many instances as there are `hands`, the first ones; as many `forces` (N).
  void tick(std::span<const Hand> hands, std::span<Force> forces);

  /// State number `index` of an instance, 0 .. size() - 1.
  float state(std::size_t index, std::size_t instance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Moves some hands; `first` is the number of the first one. `forces` (N) has the force on each hand in the tick before
/// `tick`, or 0 at tick 0. `hands` has one hand for each force, as the last call left it; at tick 0 all are zero.
/// Called from several threads at once, never for the same hands.
using MoveHands =
    std::function<void(std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands)>;

/// Runs `instances` independent hands through `ticks` ticks in closed loop, on all cores: each block of hands goes
/// through all of its ticks on one thread. Hands enter where the first call of `move` puts them. After the last tick
/// `move` is called once more, with number `ticks`, to receive the forces; the hands are then ignored.
/// Results do not depend on the number of cores or the order of threads. An exception from `move` is thrown again.
/// `grids` is as for a `Batch`. Allocates.
void run_batch(const Bank& bank, std::size_t instances, long ticks, const MoveHands& move,
               const Memory* grids = nullptr);

}  // namespace wale
