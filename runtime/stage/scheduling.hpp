#pragma once

#include <string>

namespace wale {

/// Makes the calling thread as punctual as the system permits: SCHED_FIFO, the process's memory locked (what is mapped
/// now), its stack touched. Unlocks the memory when it goes, and says in one line what it got.
class RealTimeClaim {
 public:
  RealTimeClaim();
  ~RealTimeClaim();
  RealTimeClaim(const RealTimeClaim&) = delete;
  RealTimeClaim& operator=(const RealTimeClaim&) = delete;

  const std::string& status() const { return status_; }

 private:
  bool locked_ = false;
  std::string status_;
};

}  // namespace wale
