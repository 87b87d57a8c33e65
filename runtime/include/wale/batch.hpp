#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

/// Independent instances of one program: each has its own hand and its own states, which it keeps from tick to tick,
/// and all read the same grids, to which nothing is written. For simulated experiments, grading and whoever else needs
/// the future of many hands; bit-identical to a `tick` with a `Memory` whose grids stay as they are.
///
/// Instances run in blocks of lanes and do not know of one another: their order and number change no bit. The bank may
/// be let go. One thread at a time may use a batch.
class Batch {
 public:
  /// `instances` hands, none of which has entered. Grids are those of `grids` as they are now, if it is of the bank's
  /// program, else as at the beginning. Allocates; copies the registers and the grids once for all instances.
  Batch(const Bank& bank, std::size_t instances, const Memory* grids = nullptr);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  std::size_t size() const;

  /// All hands come in: what `Memory::enter` does, for each. `hands` is as long as the batch.
  void enter(std::span<const Hand> hands);
  /// One tick of each instance. `hands` and `forces` (N) are as long as the batch.
  void tick(std::span<const Hand> hands, std::span<Force> forces);

  /// State number `index` of an instance, 0 .. size() - 1.
  float state(std::size_t index, std::size_t instance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Moves some hands on: `first` is the number of the first of them, `forces` (N) is what each felt in the tick before
/// `tick`, or 0 when that is the first, number 0. `hands` has one for each of `forces`, as it was left the last time,
/// at first all zero. Called from several threads at once, never for the same hands.
using MoveHands =
    std::function<void(std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands)>;

/// Runs `instances` independent hands through `ticks` ticks in closed loop, on all cores: each block of hands goes
/// through all of its ticks on one thread. Hands enter where the first call of `move` puts them. After the last tick
/// `move` is called once more, with number `ticks`, for the forces; where it puts the hands then is of no concern.
/// Results depend neither on the number of cores nor on who runs first. What `move` throws is thrown again. `grids` as
/// for a `Batch`. Allocates.
void run_batch(const Bank& bank, std::size_t instances, long ticks, const MoveHands& move,
               const Memory* grids = nullptr);

}  // namespace wale
