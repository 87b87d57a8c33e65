#include "runtime/stage/scheduling.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <system_error>

namespace wale {
namespace {

constexpr std::size_t stack_bytes = 64 * 1024;

void touch_stack() {
  [[maybe_unused]] volatile std::byte stack[stack_bytes];
  for (std::size_t i = 0; i < stack_bytes; i += 1024) stack[i] = std::byte{0};
}

std::string reason(int error) { return std::generic_category().message(error); }

/// Asks the kernel to keep processors out of sleep states that take longer than 0 us to leave, as long as the returned
/// descriptor stays open (Linux, Documentation/power/pm_qos_interface.rst). Below 0, with the reason in `errno`, when
/// the kernel refuses.
int hold_latency() {
  const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  if (file < 0) return file;
  const std::int32_t microseconds = 0;
  if (write(file, &microseconds, sizeof microseconds) == sizeof microseconds) return file;
  const int error = errno;
  close(file);
  errno = error;
  return -1;
}

}  // namespace

std::string GrantedClaim::in_words() const {
  std::string words = "ordinary priority";
  if (priority_error == 0) words = "SCHED_FIFO priority " + std::to_string(priority);
  if (priority_error.value_or(0) != 0) words += " (SCHED_FIFO: " + reason(*priority_error) + ")";
  if (lock_error) words += *lock_error == 0 ? ", memory locked" : ", memory not locked (" + reason(*lock_error) + ")";
  if (latency_error)
    words += *latency_error == 0 ? ", processors kept awake" : ", processors may sleep (" + reason(*latency_error) + ")";
  return words;
}

RealTimeClaim::RealTimeClaim(const StageOptions& options) noexcept {
  if (options.priority) {
    sched_param wanted{};
    granted_.priority = wanted.sched_priority = *options.priority;
    granted_.priority_error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  }
  touch_stack();
  if (options.lock_memory) {
    stack_ = static_cast<const std::byte*>(__builtin_frame_address(0)) - stack_bytes;
    granted_.lock_error = lock_pages(stack_, stack_bytes) ? 0 : errno;
    if (granted_.lock_error != 0) stack_ = nullptr;
  }
  if (options.low_latency) {
    latency_ = hold_latency();
    granted_.latency_error = latency_ >= 0 ? 0 : errno;
  }
}

RealTimeClaim::~RealTimeClaim() {
  if (latency_ >= 0) close(latency_);
  if (stack_ != nullptr) munlock(stack_, stack_bytes);
}

void take_ordinary_priority() {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);  // always permitted
}

bool lock_pages(const void* memory, std::size_t bytes) { return bytes == 0 || mlock(memory, bytes) == 0; }

}  // namespace wale
