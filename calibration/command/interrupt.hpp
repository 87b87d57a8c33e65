#pragma once

#include <atomic>

namespace wale::command {

/// Makes Ctrl-C and the signal TERM set the flag that this returns, instead of ending the process. They also end a
/// question to the person, because reading does not resume after a signal.
const std::atomic<bool>& stop_on_signals();

}  // namespace wale::command
