#pragma once

#include <atomic>

namespace wale::command {

/// Makes Ctrl-C and the signal TERM set the flag that this returns, instead of ending the process. They end a question
/// too, since reading is not taken up again after a signal.
const std::atomic<bool>& stop_on_signals();

}  // namespace wale::command
