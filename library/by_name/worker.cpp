#include "library/by_name/worker.hpp"

#include <new>
#include <system_error>
#include <utility>

namespace wale {

Worker::Queue::~Queue() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    dropped_.swap(waiting_);
  }
  news_.notify_all();
  for (const auto& each : dropped_) {
    try {
      each->end({Code::wrong_moment,
                 "the library was destroyed before this was begun",
                 "keep the library until its futures are ready",
                 {.name = "library"}});
    } catch (const std::bad_alloc&) {
      // Its future then throws that nobody kept its promise.
    }
  }
  thread_.reset();
}

void Worker::Queue::begin(std::unique_ptr<Piece> piece) {
  const std::lock_guard lock(mutex_);
  try {
    if (!thread_) thread_.emplace([this] { serve(); });
  } catch (const std::system_error& refused) {
    return piece->end({Code::short_of_resources,
                       std::string("the system gives no thread: ") + refused.what(),
                       "end other programs, or raise the limit on processes (ulimit -u)",
                       {.name = "library"}});
  }
  waiting_.push_back(std::move(piece));
  news_.notify_one();
}

void Worker::Queue::serve() {
  for (;;) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    const std::unique_ptr<Piece> piece = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    piece->run();
  }
}

}  // namespace wale
