#include "calibration/command/interrupt.hpp"

#include <csignal>

namespace wale::command {
namespace {

std::atomic<bool> is_interrupted{false};  // set by a signal handler
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { is_interrupted = true; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return is_interrupted;
}

}  // namespace wale::command
