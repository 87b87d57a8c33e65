#pragma once

#include <atomic>

namespace wale::command {

/// Prepares this process for every end that can be caught, for a verb that drives a device:
/// - Ctrl-C, TERM, HUP and all other signals that ask a process to end set the flag that this returns: the verb lets
/// the
///   device go, completes the recording, gives the terminal back, and ends by `status_after_signals`. A question ends
///   too, since reading is not taken up again after a signal. Where a second one comes after a second or later, the
///   process counts as hanging, and ends at once as after a crash. A signal that was ignored from the beginning, as by
///   `nohup`, stays ignored.
/// - After a crash (SEGV, BUS, FPE, ILL, ABRT, SYS, TRAP), in whichever thread, and after `std::terminate`, the keepers
///   let all devices go, the terminal is given back, one line says why, and the process ends by the same signal.
/// - Ctrl-Z (TSTP) lets devices go and gives the terminal back until the process continues.
/// May be called more than once.
const std::atomic<bool>& stop_on_signals();

/// Sets that flag, for a thread that cannot go on.
void ask_to_stop() noexcept;

/// The exit status of a verb that would have ended with `status`. Where a signal ended it, this says so in one line
/// and, unless that was Ctrl-C, ends the process by that signal, so that a shell sees 128 and its number. Ctrl-C is how
/// a person ends a run: its status stays. Call it when the device has been let go and all is written.
int status_after_signals(int status);

}  // namespace wale::command
