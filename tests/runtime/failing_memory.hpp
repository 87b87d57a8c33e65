#pragma once

#include <atomic>

/// Lets allocations of this process fail: real_time.cpp replaces the functions that allocate.
namespace wale::failing_memory {

/// So many more of all threads succeed, and then none does; below 0 all do.
inline std::atomic<long> left = -1;

/// Whether the functions of C that allocate are replaced: not where a sanitizer does so.
constexpr bool is_wired() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

/// For the functions that allocate. False if this one fails.
inline bool take_one() noexcept {
  if (left.load(std::memory_order_relaxed) < 0) return true;
  long now = left.load();
  while (now > 0 && !left.compare_exchange_weak(now, now - 1)) {
  }
  return now != 0;
}

}  // namespace wale::failing_memory
