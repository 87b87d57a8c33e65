#pragma once

#include "wale/recording.hpp"

namespace wale {

/// Receives every tick of a run, on the real-time thread.
class TickSink {
 public:
  virtual ~TickSink() = default;
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  virtual void append(const RecordedTick& tick) noexcept = 0;
  /// The actuator's output of the last tick is known better now. Real-time as `append`.
  virtual void exerted(Force /*force*/) noexcept {}
};

}  // namespace wale
