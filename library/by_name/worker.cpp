#include "library/by_name/worker.hpp"

#include <exception>
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
  for (Piece& each : dropped_) {
    try {
      each.result.set_value(Error{Code::wrong_moment,
                                  "the library was destroyed before this was begun",
                                  "keep the library until its futures are ready",
                                  {.name = "library"}});
    } catch (const std::bad_alloc&) {
      each.result.set_exception(std::current_exception());
    }
  }
  thread_.reset();
}

std::future<Result<Compiled>> Worker::Queue::begin(Work work) {
  Piece piece{std::move(work), {}};
  auto result = piece.result.get_future();
  const std::lock_guard lock(mutex_);
  try {
    if (!thread_) thread_.emplace([this] { serve(); });
  } catch (const std::system_error& refused) {
    piece.result.set_value(Error{Code::short_of_resources,
                                 std::string("the system gives no thread: ") + refused.what(),
                                 "end other programs, or raise the limit on processes (ulimit -u)",
                                 {.name = "library"}});
    return result;
  }
  waiting_.push_back(std::move(piece));
  news_.notify_one();
  return result;
}

void Worker::Queue::serve() {
  for (;;) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    Piece piece = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    try {
      piece.result.set_value(piece.work());
    } catch (...) {
      piece.result.set_exception(std::current_exception());
    }
  }
}

}  // namespace wale
