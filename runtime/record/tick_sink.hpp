#pragma once

#include "wale/recording.hpp"

namespace wale {

/// Receives every tick of a run, on the real-time thread.
class TickSink {
 public:
  virtual ~TickSink() = default;
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  virtual void append(const RecordedTick& tick) noexcept = 0;
};

}  // namespace wale
