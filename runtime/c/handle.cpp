#include "runtime/c/handle.hpp"

#include <mutex>
#include <unordered_set>

#include "schema/home_process.hpp"

namespace wale::c {
namespace {

/// Never destroyed: handles may be freed while the process ends.
struct LiveHandles {
  std::mutex& mutex = mutex_across_fork();
  std::unordered_set<const void*> all;
};

LiveHandles& live_handles() {
  static auto* const live = new LiveHandles;
  return *live;
}

}  // namespace

void note_handle(const void* handle) {
  LiveHandles& live = live_handles();
  const std::lock_guard lock(live.mutex);
  live.all.insert(handle);
}

bool forget_handle(const void* handle) noexcept {
  if (handle == nullptr) return false;
  LiveHandles& live = live_handles();
  const std::lock_guard lock(live.mutex);
  return live.all.erase(handle) == 1;
}

}  // namespace wale::c

size_t wale_handles(void) {
  auto& live = wale::c::live_handles();
  const std::lock_guard lock(live.mutex);
  return live.all.size();
}
