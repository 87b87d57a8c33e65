#include "runtime/keeper/keeper.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <new>
#include <system_error>
#include <utility>
#include <vector>

#include "runtime/keeper/nanoseconds.hpp"
#include "runtime/keeper/start_keeper.hpp"

namespace wale {
namespace {

void sleep_a_millisecond() noexcept {
  const timespec millisecond{0, 1'000'000};
  nanosleep(&millisecond, nullptr);
}

/// A keeper that a signal handler can reach.
struct Reachable {
  std::atomic<KeeperBoard*> board{nullptr};
  std::atomic<int> wake{-1};
};
constexpr std::size_t most_devices = 32;  // that a crash lets go at once; a keeper notices a dead owner by itself too
std::array<Reachable, most_devices> reachable;

void make_reachable(KeeperBoard* board, int wake) noexcept {
  for (Reachable& each : reachable) {
    KeeperBoard* none = nullptr;
    if (!each.board.compare_exchange_strong(none, board)) continue;
    each.wake.store(wake);
    return;
  }
}

void make_unreachable(const KeeperBoard* board) noexcept {
  for (Reachable& each : reachable) {
    if (each.board.load() != board) continue;
    each.wake.store(-1);
    each.board.store(nullptr);
  }
}

Error no_keeper(const char* what, int error) {
  return {Code::no_keeper,
          std::string("the keeper cannot be started: ") + what + ": " + std::generic_category().message(error)};
}

/// Descriptors of a start, closed at its end.
class Descriptors {
 public:
  Descriptors() = default;
  ~Descriptors() {
    for (const int each : all_) close(each);
  }
  Descriptors(const Descriptors&) = delete;
  Descriptors& operator=(const Descriptors&) = delete;
  int keep(int descriptor) {
    if (descriptor >= 0) all_.push_back(descriptor);
    return descriptor;
  }

 private:
  std::vector<int> all_;
};

int memory_for(KeeperBoard*& board) noexcept {
  const int memory = memfd_create("wale-keeper", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (memory < 0 || ftruncate(memory, sizeof(KeeperBoard)) != 0) return memory;
  fcntl(memory, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL);  // nobody can make it fault
  void* mapped = mmap(nullptr, sizeof(KeeperBoard), PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
  if (mapped != MAP_FAILED) board = new (mapped) KeeperBoard;
  return memory;
}

int pidfd_of(pid_t process) noexcept { return static_cast<int>(syscall(SYS_pidfd_open, process, 0)); }

bool is_ended(int pidfd) noexcept {
  pollfd ended{pidfd, POLLIN, 0};
  return pidfd < 0 || poll(&ended, 1, 0) != 0;
}

}  // namespace

// CLOCK_MONOTONIC stands still while the computer sleeps, CLOCK_BOOTTIME does not. Read in this order, an interruption
// in between makes the sleep shorter, and never makes one up.
std::int64_t nanoseconds_asleep() noexcept {
  const std::int64_t with_sleep = nanoseconds_of(CLOCK_BOOTTIME);
  return with_sleep - nanoseconds_of(CLOCK_MONOTONIC);
}

Result<std::unique_ptr<Keeper>> Keeper::start(const LetGoPlan& plan, int descriptor, const KeeperOptions& options) {
  auto program = find_keeper(options.program);
  if (!program) return std::move(program).error();
  Descriptors mine;
  KeeperBoard* board = nullptr;
  const int memory = mine.keep(memory_for(board));
  if (board == nullptr) return no_keeper("no shared memory", errno);
  const int wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  std::unique_ptr<Keeper> keeper(new Keeper(board, wake, options));
  board->plan = plan;
  const int self = mine.keep(pidfd_of(getpid()));
  if (wake < 0 || self < 0) return no_keeper(wake < 0 ? "no event" : "Linux 5.3 is needed", errno);

  // As numbers from 3 on: the keeper closes the standard ones.
  std::vector<int> handed;
  for (const int each : {memory, self, wake, descriptor}) {
    if (each >= 0) handed.push_back(mine.keep(fcntl(each, F_DUPFD_CLOEXEC, 3)));
  }
  std::vector<std::string> words;
  for (const int each : handed) words.push_back(std::to_string(each));
  auto process = start_keeper(*program, words, handed);
  if (!process) return std::move(process).error();
  keeper->process_ = *process;
  keeper->pidfd_ = pidfd_of(*process);
  constexpr int most_milliseconds = 10'000;  // a busy machine may take its time
  for (int waited = 0; board->look.load(std::memory_order_acquire) == 0; ++waited) {
    if (is_ended(keeper->pidfd_) || waited == most_milliseconds) {
      return Error{Code::no_keeper, "the keeper ended before it began", {}, {.name = *program}};
    }
    sleep_a_millisecond();
  }
  keeper->beat();
  make_reachable(board, wake);
  return keeper;
}

Keeper::Keeper(KeeperBoard* board, int wake, const KeeperOptions& options) noexcept
    : board_(board), wake_(wake), asleep_(options.asleep), asleep_before_(asleep_()) {}

Keeper::~Keeper() {
  make_unreachable(board_);
  board_->is_over.store(1, std::memory_order_release);
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(wake_, &one, sizeof one);
  if (pidfd_ >= 0) {
    pollfd ended{pidfd_, POLLIN, 0};
    constexpr int patience = 1000;  // ms; afterwards it goes by itself
    while (poll(&ended, 1, patience) < 0 && errno == EINTR) {
    }
    close(pidfd_);
  }
  if (wake_ >= 0) close(wake_);
  munmap(board_, sizeof(KeeperBoard));
}

void Keeper::beat() noexcept {
  const std::int64_t now = nanoseconds_of(CLOCK_MONOTONIC), before = board_->beat.load(std::memory_order_relaxed);
  // A keeper that is stopped and continued with its owner may look again only after this beat, and find nothing wrong.
  // In less time a busy machine may have held up both.
  const bool pushed = board_->pushes.load(std::memory_order_relaxed) != 0;
  if (pushed && now - before > most_nanoseconds_without_look) stalled_.store(true, std::memory_order_relaxed);
  board_->beat.store(now, std::memory_order_release);
}

bool Keeper::lives() const noexcept {
  const std::int64_t unseen = nanoseconds_of(CLOCK_MONOTONIC) - board_->look.load(std::memory_order_acquire);
  return unseen <= most_nanoseconds_without_look && !is_ended(pidfd_);
}

bool Keeper::was_asleep() const noexcept {
  constexpr std::int64_t least = 50'000'000;  // ns; the two readings at the start may have been that far apart
  return asleep_() - asleep_before_ > least;
}

Keeper::Verdict Keeper::look() const noexcept {
  if (board_->latch.load(std::memory_order_acquire) != 0) return Verdict::latched;
  if (was_asleep()) return Verdict::slept;
  if (!lives()) return Verdict::gone;
  const std::int64_t silent = nanoseconds_of(CLOCK_MONOTONIC) - board_->beat.load(std::memory_order_acquire);
  if (stalled_.load(std::memory_order_relaxed)) return Verdict::stalled;
  return silent > most_nanoseconds_without_beat ? Verdict::late : Verdict::good;
}

std::string_view Keeper::why(Verdict verdict) const noexcept {
  switch (verdict) {
    case Verdict::stalled: return "the loop did not tick for a second";
    case Verdict::slept: return "the computer was asleep";
    case Verdict::gone: return "its keeper has ended, and nothing may push without one";
    case Verdict::latched:
      return static_cast<Latch>(board_->latch.load(std::memory_order_relaxed)) == Latch::no_beat
                 ? "its keeper let it go, because the loop did not tick for 100 ms"
                 : "its keeper let it go";
    case Verdict::good:
    case Verdict::late: break;
  }
  return {};
}

void let_all_devices_go() noexcept {
  for (const Reachable& each : reachable) {
    KeeperBoard* const board = each.board.load();
    if (board == nullptr) continue;
    auto open = static_cast<std::uint32_t>(Latch::open);
    board->latch.compare_exchange_strong(open, static_cast<std::uint32_t>(Latch::asked));
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(each.wake.load(), &one, sizeof one);
  }
  const auto is_done = [] {
    for (const Reachable& each : reachable) {
      const KeeperBoard* const board = each.board.load();
      if (board != nullptr && board->times_let_go.load() == 0) return false;
    }
    return true;
  };
  constexpr int most_milliseconds = 200;
  for (int waited = 0; waited < most_milliseconds && !is_done(); ++waited) sleep_a_millisecond();
}

}  // namespace wale
