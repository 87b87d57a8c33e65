#pragma once

#include <atomic>
#include <memory>
#include <mutex>

namespace wale {

/// The process in which a thing with threads was made. After `fork` the child has a copy of the thing and none of its
/// threads, and the locks are as these threads left them: the child neither uses nor destroys the copy.
class HomeProcess {
 public:
  HomeProcess();
  /// Whether this is that process. Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  bool is_here() const noexcept;

 private:
  unsigned number_;
};

/// What one process may leave to another.
struct LeftBehind {
  LeftBehind* next = nullptr;  ///< of `abandon`
};

/// Keeps what another process has left until this one ends, and never destroys it. The first allocates nothing.
void abandon(LeftBehind* left) noexcept;
void abandon(std::shared_ptr<void> left) noexcept;

/// A value of which each process has its own: in a child of `fork` it begins anew, in whatever state the parent's
/// threads had left it. Safe from any thread.
template <class Value>
class PerProcess {
 public:
  PerProcess() = default;
  PerProcess(const PerProcess&) = delete;
  PerProcess& operator=(const PerProcess&) = delete;
  ~PerProcess() {
    Held* const held = held_.load();
    if (held != nullptr && !held->home.is_here())
      abandon(held);
    else
      delete held;
  }

  /// This process's.
  Value& operator*() {
    Held* known = held_.load();
    if (known != nullptr && known->home.is_here()) return known->value;
    auto fresh = std::make_unique<Held>();
    if (!held_.compare_exchange_strong(known, fresh.get())) return known->value;  // another thread was faster
    if (known != nullptr) abandon(known);
    return fresh.release()->value;
  }

 private:
  struct Held final : LeftBehind {
    HomeProcess home;
    Value value;
  };
  std::atomic<Held*> held_ = nullptr;  // a lock might be held for ever in a child
};

/// For tables of the whole process that are locked for a moment: `fork` waits for it, so it is free in the child.
std::mutex& mutex_across_fork();

}  // namespace wale
