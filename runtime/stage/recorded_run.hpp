#pragma once

#include <optional>

#include "runtime/record/tick_sink.hpp"
#include "runtime/stage/loop.hpp"

namespace wale {

/// A run that was recorded, played again: its beats in place of a clock's, and someone who sees what becomes of each.
class RecordedRun : public TickSink {
 public:
  /// The next beat to serve, if there is one; what lies on the stage has been changed to what lay there then.
  virtual std::optional<Beat> next() = 0;
};

}  // namespace wale
