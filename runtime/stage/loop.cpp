#include "runtime/stage/loop.hpp"

#include <time.h>

#include <cerrno>

namespace wale {
namespace {

constexpr std::int64_t second = 1'000'000'000;

}  // namespace

std::int64_t MonotonicClock::now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * second + time.tv_nsec;
}

void MonotonicClock::sleep_until(std::int64_t when) noexcept {
  const timespec time{static_cast<time_t>(when / second), static_cast<long>(when % second)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace wale
