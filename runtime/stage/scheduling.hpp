#pragma once

#include <string>

namespace wale {

/// SCHED_FIFO, of the loop: above the interrupt threads of a PREEMPT_RT kernel (50), below its watchdogs and migration
/// threads (99). The threads that serve a device are best just below it.
inline constexpr int loop_priority = 80;

/// Makes the calling thread as punctual as the system permits: SCHED_FIFO, the process's memory locked (what is mapped
/// now), its stack touched, the processors kept from sleeping so deeply that they wake late. Gives back memory and
/// processors when it goes, and says in one line what it got.
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
