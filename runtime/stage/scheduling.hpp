#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "wale/stage.hpp"

namespace wale {

/// What a thread asked of the system and got: error numbers, 0 for what was granted, nothing for what was not asked.
struct GrantedClaim {
  int priority = 0;  ///< if one was asked
  std::optional<int> priority_error, lock_error, latency_error;

  /// In one line, for a person.
  std::string in_words() const;
};

/// Makes the calling thread as punctual as the options ask and the system permits: SCHED_FIFO, its stack locked, the
/// processors kept out of sleep states that are slow to leave. The stack is touched in any case. The destructor
/// releases stack and processors. Allocates nothing: the thread of the loop must live when there is no memory.
class RealTimeClaim {
 public:
  explicit RealTimeClaim(const StageOptions& options) noexcept;
  ~RealTimeClaim();
  RealTimeClaim(const RealTimeClaim&) = delete;
  RealTimeClaim& operator=(const RealTimeClaim&) = delete;

  const GrantedClaim& granted() const noexcept { return granted_; }

 private:
  int latency_ = -1;  // the open file that keeps the processors awake
  const void* stack_ = nullptr;
  GrantedClaim granted_;
};

/// Gives the calling thread ordinary priority: a thread inherits that of the one that makes it, which may be real-time.
void take_ordinary_priority();

/// Locks the pages of some memory for good. False if the system refuses.
bool lock_pages(const void* memory, std::size_t bytes);

}  // namespace wale
