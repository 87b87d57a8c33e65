#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace wale {

/// Hands whole values from a control thread to a real-time thread, the newest only, and takes used ones back, so that
/// the real-time thread never allocates or frees. One thread on each side; neither ever waits for the other.
template <class Value>
class Exchange {
 public:
  Exchange() = default;
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;
  /// Call it when both threads are done.
  ~Exchange() {
    delete offered_.load();
    delete held_;
    collect();
  }

  /// Control side: offers a value in place of any that was not taken yet, and frees those given back. Allocates.
  void publish(Value value) {
    delete offered_.exchange(new Entry{std::move(value), nullptr}, std::memory_order_acq_rel);
    collect();
  }

  /// Control side: frees the values that the real-time thread has given back.
  void collect() {
    Entry* entry = returned_.exchange(nullptr, std::memory_order_acquire);
    while (entry != nullptr) delete std::exchange(entry, entry->next);
  }

  /// Real-time side: takes the offered value, if any, and gives back the one held so far. Returns whether it took one.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw. It retries at most once for
  /// each `collect`.
  bool take() noexcept {
    if (offered_.load(std::memory_order_relaxed) == nullptr) return false;
    Entry* taken = offered_.exchange(nullptr, std::memory_order_acquire);
    if (Entry* used = std::exchange(held_, taken)) {
      used->next = returned_.load(std::memory_order_relaxed);
      while (!returned_.compare_exchange_weak(used->next, used, std::memory_order_release)) {
      }
    }
    return true;
  }

  /// Real-time side: the value taken last, or null before the first.
  Value* held() noexcept { return held_ != nullptr ? &held_->value : nullptr; }

 private:
  struct Entry {
    Value value;
    Entry* next;
  };

  std::atomic<Entry*> offered_ = nullptr;
  std::atomic<Entry*> returned_ = nullptr;  // a stack: one side pushes, the other takes it whole
  Entry* held_ = nullptr;                   // the real-time thread's
};

}  // namespace wale
