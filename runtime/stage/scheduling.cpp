#include "runtime/stage/scheduling.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

namespace wale {
namespace {

constexpr std::size_t stack_bytes = 64 * 1024;

void touch_stack() {
  [[maybe_unused]] volatile std::byte stack[stack_bytes];
  for (std::size_t i = 0; i < stack_bytes; i += 1024) stack[i] = std::byte{0};
}

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

RealTimeClaim::RealTimeClaim() {
  sched_param wanted{};
  wanted.sched_priority = loop_priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  status_ = error == 0 ? "SCHED_FIFO priority " + std::to_string(loop_priority)
                       : "ordinary priority (SCHED_FIFO: " + reason(error) + ")";

  // Not MCL_FUTURE: under a small limit it would make later allocations of the control thread fail.
  locked_ = mlockall(MCL_CURRENT) == 0;
  status_ += locked_ ? ", memory locked" : ", memory not locked (" + reason(errno) + ")";
  touch_stack();
}

RealTimeClaim::~RealTimeClaim() {
  if (locked_) munlockall();
}

}  // namespace wale
