#pragma once

#include <string>

namespace wale {

/// The loop's priority under SCHED_FIFO: above the interrupt threads of a PREEMPT_RT kernel (50), below its watchdogs
/// and migration threads (99). Threads that serve a device should have one just below it.
inline constexpr int loop_priority = 80;

/// Makes the calling thread as punctual as the system permits: SCHED_FIFO, all memory that the process has mapped now
/// locked, the stack touched, the processors kept out of sleep states that are slow to leave. The destructor releases
/// memory and processors. `status` says in one line what the system granted.
class RealTimeClaim {
 public:
  RealTimeClaim();
  ~RealTimeClaim();
  RealTimeClaim(const RealTimeClaim&) = delete;
  RealTimeClaim& operator=(const RealTimeClaim&) = delete;

  const std::string& status() const { return status_; }

 private:
  bool locked_ = false;
  int latency_ = -1;  // the open file that keeps the processors awake
  std::string status_;
};

}  // namespace wale
