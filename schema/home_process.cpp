#include "schema/home_process.hpp"

#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <new>
#include <utility>

namespace wale {
namespace {

/// How many calls of `fork` lie between the first process and this one.
std::atomic<unsigned> forks = 0;

/// Never destroyed: it is used while the process ends.
std::mutex& across_fork() {
  static auto* const mutex = new std::mutex;
  return *mutex;
}

/// From now on each `fork` is noticed.
void notice_forks() {
  [[maybe_unused]] static const int noticed = [] {
    across_fork();
    return pthread_atfork([] { across_fork().lock(); }, [] { across_fork().unlock(); },
                          [] {
                            ++forks;
                            across_fork().unlock();
                          });
  }();
}

/// What is abandoned stays reachable, so that checkers of memory do not call it lost.
std::atomic<LeftBehind*> all_left = nullptr;

struct SharedLeft final : LeftBehind {
  explicit SharedLeft(std::shared_ptr<void> its) : thing(std::move(its)) {}
  std::shared_ptr<void> thing;
};

}  // namespace

HomeProcess::HomeProcess() {
  notice_forks();
  number_ = forks;
}

bool HomeProcess::is_here() const noexcept { return number_ == forks.load(std::memory_order_relaxed); }

void abandon(LeftBehind* left) noexcept {
  left->next = all_left;
  while (!all_left.compare_exchange_weak(left->next, left)) {
  }
}

void abandon(std::shared_ptr<void> left) noexcept {
  if (auto* const kept = new (std::nothrow) SharedLeft(std::move(left))) return abandon(kept);
  alignas(std::shared_ptr<void>) std::byte for_ever[sizeof left];
  new (for_ever) std::shared_ptr<void>(std::move(left));  // one owner more, who never lets go
}

std::mutex& mutex_across_fork() {
  notice_forks();
  return across_fork();
}

}  // namespace wale
