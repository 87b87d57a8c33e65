#include "calibration/feel/background_loop.hpp"

#include <utility>

namespace wale {

BackgroundLoop::BackgroundLoop(std::function<void()> step, std::function<void()> on_failure)
    : thread_([this, step = std::move(step), on_failure = std::move(on_failure)] { run(step, on_failure); }) {}

BackgroundLoop::~BackgroundLoop() { end(); }

void BackgroundLoop::finish() {
  end();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void BackgroundLoop::run(const std::function<void()>& step, const std::function<void()>& on_failure) {
  try {
    while (!over_) step();
  } catch (...) {  // whatever it is, the caller learns of it in `finish`
    failure_ = std::current_exception();
    on_failure();
  }
}

void BackgroundLoop::end() {
  over_ = true;
  thread_.join();
}

}  // namespace wale
