#pragma once

#include <optional>

#include "runtime/record/tick_sink.hpp"
#include "runtime/stage/loop.hpp"

namespace wale {

/// A recorded run to replay: it gives the beats in place of a clock, and receives the tick that each beat gives.
class RecordedRun : public TickSink {
 public:
  /// The next beat to serve, if there is one. Before it returns, it makes the changes of the stage up to that beat.
  virtual std::optional<Beat> next() = 0;
};

}  // namespace wale
