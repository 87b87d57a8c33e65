#pragma once

#include <pthread.h>

#include <cstddef>
#include <functional>
#include <memory>

namespace wale::command {

/// The stack of a thread that compiles, in bytes: several times what the deepest text needs, which counted limits
/// bound (`deepest_expression`).
inline constexpr std::size_t deep_stack = std::size_t{16} << 20;

/// A thread with a stack of `deep_stack` bytes, whatever the limit of the process (ulimit -s), and another for handlers
/// of signals, so that one of them can still act when the first has overflowed.
class DeepThread {
 public:
  /// `work` may not throw. Throws std::system_error if the system gives no thread.
  explicit DeepThread(std::function<void()> work);
  DeepThread(const DeepThread&) = delete;
  DeepThread& operator=(const DeepThread&) = delete;
  ~DeepThread() { join(); }

  /// Waits until `work` has returned.
  void join();

 private:
  static void* run(void* self);

  std::function<void()> work_;
  std::unique_ptr<char[]> handlers_stack_;  // of the thread, which might have no memory for it
  pthread_t thread_{};
  bool is_joined_ = false;
};

/// The status of a command, which runs on a `DeepThread` if this process may have only a small stack, and else where it
/// is called. On the way, signals are handled by the thread of the command, whose waiting they end. `command` may not
/// throw.
int with_deep_stack(const std::function<int()>& command);

}  // namespace wale::command
