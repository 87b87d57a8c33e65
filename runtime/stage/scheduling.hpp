#pragma once

#include <cstddef>
#include <string>

#include "wale/stage.hpp"

namespace wale {

/// Makes the calling thread as punctual as the options ask and the system permits: SCHED_FIFO, its stack locked, the
/// processors kept out of sleep states that are slow to leave. The stack is touched in any case. The destructor
/// releases stack and processors. `status` says in one line what the system granted.
class RealTimeClaim {
 public:
  explicit RealTimeClaim(const StageOptions& options);
  ~RealTimeClaim();
  RealTimeClaim(const RealTimeClaim&) = delete;
  RealTimeClaim& operator=(const RealTimeClaim&) = delete;

  const std::string& status() const { return status_; }

 private:
  int latency_ = -1;  // the open file that keeps the processors awake
  const void* stack_ = nullptr;
  std::string status_;
};

/// Gives the calling thread ordinary priority: a thread inherits that of the one that makes it, which may be real-time.
void take_ordinary_priority();

/// Locks the pages of some memory for good. False if the system refuses.
bool lock_pages(const void* memory, std::size_t bytes);

}  // namespace wale
