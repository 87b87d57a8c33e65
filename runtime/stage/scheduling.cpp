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

RealTimeClaim::RealTimeClaim(const StageOptions& options) {
  const auto say = [this](const std::string& what) { status_ += (status_.empty() ? "" : ", ") + what; };
  if (options.priority) {
    sched_param wanted{};
    wanted.sched_priority = *options.priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    say(error == 0 ? "SCHED_FIFO priority " + std::to_string(*options.priority)
                   : "ordinary priority (SCHED_FIFO: " + reason(error) + ")");
  } else {
    say("ordinary priority");
  }
  touch_stack();
  if (options.lock_memory) {
    stack_ = static_cast<const std::byte*>(__builtin_frame_address(0)) - stack_bytes;
    const bool locked = lock_pages(stack_, stack_bytes);
    say(locked ? "memory locked" : "memory not locked (" + reason(errno) + ")");
    if (!locked) stack_ = nullptr;
  }
  if (options.low_latency) {
    latency_ = hold_latency();
    say(latency_ >= 0 ? "processors kept awake" : "processors may sleep (" + reason(errno) + ")");
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
