#pragma once

#include <atomic>
#include <exception>
#include <functional>

#include "compiler/command/deep_thread.hpp"

namespace wale {

/// Calls a function again and again on a thread of its own, whose stack is enough to compile, until it is finished,
/// destroyed, or the function throws.
class BackgroundLoop {
 public:
  /// `step` should return within about 0.1 s, since the end waits for it. If it throws, `on_failure` is called once, on
  /// the same thread. `on_failure` may not throw.
  BackgroundLoop(std::function<void()> step, std::function<void()> on_failure);
  BackgroundLoop(const BackgroundLoop&) = delete;
  BackgroundLoop& operator=(const BackgroundLoop&) = delete;
  ~BackgroundLoop();

  /// Ends it, and throws what `step` threw, if it did.
  void finish();

 private:
  void run(const std::function<void()>& step, const std::function<void()>& on_failure);
  void end();

  std::atomic<bool> over_ = false;
  std::exception_ptr failure_;
  command::DeepThread thread_;
};

}  // namespace wale
