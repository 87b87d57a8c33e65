#pragma once

#include <atomic>
#include <cstdint>

#include "runtime/keeper/let_go_plan.hpp"

namespace wale {

/// Why a keeper took a device.
enum class Latch : std::uint32_t {
  open,        ///< it did not
  no_beat,     ///< the loop did not tick for `most_nanoseconds_without_beat` while the device pushed
  owner_died,  ///< the process is gone
  asked        ///< the process is crashing and has asked for it
};

/// The loop may be silent so long while the device pushes: then the keeper takes it. ns of CLOCK_MONOTONIC.
inline constexpr std::int64_t most_nanoseconds_without_beat = 100'000'000;
/// A keeper that has not looked for so long counts as dead: it may be stopped. It looks each 5 ms; a second lets a
/// keeper without real-time priority wait for a busy processor.
inline constexpr std::int64_t most_nanoseconds_without_look = 1'000'000'000;

/// Memory that the owner of one device and its keeper share. The owner's threads and the keeper each write their own
/// numbers; nobody waits for anybody. All of it is lock-free.
struct KeeperBoard {
  static constexpr std::uint32_t current_version = 1;

  std::uint32_t version = current_version;

  // The owner's.
  std::atomic<std::int64_t> beat{0};      ///< ns of CLOCK_MONOTONIC, when the loop last ticked
  std::atomic<std::uint32_t> pushes{0};   ///< 1: the device may be pushing, so that the beat matters
  std::atomic<std::uint32_t> is_over{0};  ///< 1: the owner sends nothing more, and has let the device go if it could
  // Both may set it, once, from `open`.
  std::atomic<std::uint32_t> latch{0};  ///< a `Latch`
  // The keeper's.
  std::atomic<std::int64_t> look{0};           ///< ns, when the keeper last looked; 0: it has not begun
  std::atomic<std::uint32_t> times_let_go{0};  ///< how often it has made all steps since the latch was set

  LetGoPlan plan;
};

static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace wale
