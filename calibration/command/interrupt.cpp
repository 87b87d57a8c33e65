#include "calibration/command/interrupt.hpp"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <vector>

#include "runtime/device/pointer/terminal.hpp"
#include "runtime/keeper/keeper.hpp"
#include "runtime/keeper/nanoseconds.hpp"

namespace wale::command {
namespace {

/// Signals that ask a process to end, and by default end it; those of SIGRTMIN and above do too. SIGPIPE and SIGXFSZ
/// are ignored (`prepare_streams`).
constexpr int endings[] = {SIGHUP,  SIGINT,  SIGQUIT, SIGTERM, SIGALRM,   SIGVTALRM, SIGPROF,
                           SIGUSR1, SIGUSR2, SIGIO,   SIGPWR,  SIGSTKFLT, SIGXCPU};
constexpr int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP};

// Set by signal handlers.
std::atomic<bool> is_to_stop{false};
std::atomic<int> first_signal{0};         // that asked to end
std::atomic<std::int64_t> first_came{0};  // ns of CLOCK_MONOTONIC
std::atomic<bool> is_crashing{false}, has_let_go{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

/// Texts to standard error, without memory or locks.
void tell(std::initializer_list<const char*> texts) noexcept {
  for (const char* text : texts) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  }
}

/// "SEGV (Segmentation fault)" in pieces; a signal in real time has no name.
const char* short_name(int signal) noexcept {
  const char* name = sigabbrev_np(signal);
  return name != nullptr ? name : "in real time";
}
const char* long_name(int signal) noexcept {
  const char* name = sigdescr_np(signal);
  return name != nullptr ? name : "for an application's own use";
}

/// Makes a signal do what it does by default, now that this process has nothing to lose.
void raise_by_default(int signal) noexcept {
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  sigaction(signal, &usual, nullptr);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  raise(signal);  // comes as soon as it is not blocked any more
  pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
}

/// Lets devices and terminal go before an end that cannot be put off. True for the thread that did it; any other waits
/// until it is done, or would end the process too early.
bool let_all_go() noexcept {
  if (!is_crashing.exchange(true)) {
    let_all_devices_go();
    pointer::give_terminal_back();
    has_let_go.store(true);
    return true;
  }
  constexpr int most_milliseconds = 300;
  for (int waited = 0; waited < most_milliseconds && !has_let_go.load(); ++waited) {
    const timespec millisecond{0, 1'000'000};
    nanosleep(&millisecond, nullptr);
  }
  return false;
}

void when_crashed(int signal) {
  if (let_all_go()) {
    tell({"wale: crashed by the signal ", short_name(signal), " (", long_name(signal),
          "); no device is pushed any more\n"});
  }
  raise_by_default(signal);
}

void when_asked_to_end(int signal) {
  const int error = errno;
  constexpr std::int64_t patience = 1'000'000'000;  // ns; a run ends within 0.1 s, also on a slow machine within 1 s
  int none = 0;
  if (first_signal.compare_exchange_strong(none, signal)) {
    first_came.store(nanoseconds_of(CLOCK_MONOTONIC));
  } else if (nanoseconds_of(CLOCK_MONOTONIC) - first_came.load() > patience) {
    let_all_go();
    tell({"wale: ended at once by the second signal, ", short_name(signal), "\n"});
    raise_by_default(signal);
  }
  is_to_stop.store(true);
  errno = error;
}

void when_stopped(int) {
  const int error = errno;
  let_all_devices_go();  // each is set up again, from no force, when the process continues
  pointer::give_terminal_back();
  raise(SIGSTOP);
  // some time later the process continues:
  pointer::take_terminal_again();
  errno = error;
}

[[noreturn]] void when_terminated() {
  std::array<char, 200> why{};
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
    std::strcpy(why.data(), "std::terminate was called");
  } catch (const std::exception& error) {
    std::strncpy(why.data(), error.what(), why.size() - 1);
  } catch (...) {
    std::strcpy(why.data(), "an exception of unknown kind");
  }
  if (let_all_go()) {
    tell({"wale: ended by an error that nothing handles: ", why.data(),
          "; no device is pushed any more; please report it (schema/SECURITY.md)\n"});
  }
  std::abort();
}

/// Unless the signal was ignored before: that was somebody's wish.
void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction before {};
  const bool may_be_ignored = signal != SIGINT && signal != SIGTERM;
  if (sigaction(signal, nullptr, &before) != 0 || (may_be_ignored && before.sa_handler == SIG_IGN)) return;
  struct sigaction ours {};
  ours.sa_handler = handler;
  ours.sa_flags = flags;
  sigfillset(&ours.sa_mask);  // one at a time, and no stop by a terminal that is given back from the background
  sigaction(signal, &ours, nullptr);
}

/// A stack of its own for handlers of this thread: one that has overflowed has no room.
void take_another_stack() {
  static std::vector<char> memory(64 * 1024);
  stack_t stack{};
  stack.ss_sp = memory.data();
  stack.ss_size = memory.size();
  sigaltstack(&stack, nullptr);
}

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  take_another_stack();
  for (const int signal : endings) handle(signal, when_asked_to_end, 0);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) handle(signal, when_asked_to_end, 0);
  for (const int signal : crashes) handle(signal, when_crashed, SA_ONSTACK);
  handle(SIGTSTP, when_stopped, SA_RESTART);
  std::set_terminate(when_terminated);
  return is_to_stop;
}

void ask_to_stop() noexcept { is_to_stop.store(true); }

int status_after_signals(int status) {
  const int signal = first_signal.load();
  if (signal == 0) return status;
  std::fflush(nullptr);
  tell({"wale: ended by the signal ", short_name(signal), " (", long_name(signal), ")\n"});
  if (signal != SIGINT) raise_by_default(signal);
  return status;
}

}  // namespace wale::command
