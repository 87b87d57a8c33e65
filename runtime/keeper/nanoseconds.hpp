#pragma once

#include <time.h>

#include <cstdint>

namespace wale {

/// A clock's time in ns. May be called in a signal handler.
inline std::int64_t nanoseconds_of(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace wale
