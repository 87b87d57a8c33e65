#include "runtime/keeper/process/watch.hpp"

#include <poll.h>
#include <unistd.h>

#include "runtime/keeper/nanoseconds.hpp"

namespace wale::keeper {
namespace {

constexpr int between_looks = 5;  // ms
/// While the device is held, all steps are made again, because a packet that the owner had checked before the latch was
/// set may still come: soon at first, then seldom.
constexpr int soon = 5, rounds_soon = 10, seldom = 100;  // ms

/// What a look at the owner tells.
struct Owner {
  bool is_dead = false, is_over = false;
};

Owner look_at(KeeperBoard& board, int owner, int wake, int milliseconds) {
  pollfd waits[2] = {{owner, POLLIN, 0}, {wake, POLLIN, 0}};
  const int ready = poll(waits, 2, milliseconds);
  if (ready > 0 && waits[1].revents != 0) {
    std::uint64_t calls = 0;
    [[maybe_unused]] const ssize_t got = read(wake, &calls, sizeof calls);
  }
  board.look.store(nanoseconds_of(CLOCK_MONOTONIC), std::memory_order_release);
  return {ready > 0 && waits[0].revents != 0, board.is_over.load(std::memory_order_acquire) != 0};
}

/// Why the device has to be taken now; `open`: it has not.
Latch reason_to_take(const KeeperBoard& board, const Owner& owner) {
  const auto asked = static_cast<Latch>(board.latch.load(std::memory_order_acquire));
  if (asked != Latch::open) return asked;
  if (owner.is_dead) return Latch::owner_died;
  if (board.pushes.load(std::memory_order_seq_cst) == 0) return Latch::open;
  const std::int64_t silent = nanoseconds_of(CLOCK_MONOTONIC) - board.beat.load(std::memory_order_acquire);
  return silent > most_nanoseconds_without_beat ? Latch::no_beat : Latch::open;
}

/// Lets the device go again and again until the owner cannot send anything more, and then once more.
void hold(KeeperBoard& board, DeviceNode& node, int process, int wake) {
  for (int round = 0;; ++round) {
    node.let_go();
    board.times_let_go.fetch_add(1, std::memory_order_release);
    const Owner owner = look_at(board, process, wake, round < rounds_soon ? soon : seldom);
    if (!owner.is_dead && !owner.is_over) continue;
    node.let_go();
    return node.say_farewell();
  }
}

}  // namespace

void watch(KeeperBoard& board, DeviceNode& node, int process, int wake) {
  while (true) {
    const Owner owner = look_at(board, process, wake, between_looks);
    if (owner.is_over && board.latch.load(std::memory_order_acquire) == 0) return;
    const Latch reason = reason_to_take(board, owner);
    if (reason == Latch::open) continue;
    auto open = static_cast<std::uint32_t>(Latch::open);
    board.latch.compare_exchange_strong(open, static_cast<std::uint32_t>(reason), std::memory_order_seq_cst);
    return hold(board, node, process, wake);
  }
}

}  // namespace wale::keeper
