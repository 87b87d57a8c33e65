#include "feeling/work_thread.hpp"

#include <algorithm>

namespace sandpaper {
namespace {

constexpr unsigned stack = 16u << 20;  // the compiler needs 8 MB

}  // namespace

WorkThread::WorkThread() {
  setStackSize(stack);
  start(QThread::LowPriority);
}

WorkThread::~WorkThread() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    pieces_.clear();
  }
  news_.notify_all();
  wait();
  // A thread sanitizer does not see how Qt waits for a thread; it sees that this lock comes after the thread's last.
  const std::lock_guard ended(mutex_);
}

void WorkThread::post(int urgency, const std::string& key, std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    for (auto& [other, pieces] : pieces_)
      std::erase_if(pieces, [&](const auto& each) { return each.first == key; });
    pieces_[urgency].emplace_back(key, std::move(work));
  }
  news_.notify_one();
}

std::size_t WorkThread::waiting() const {
  const std::lock_guard lock(mutex_);
  std::size_t count = is_busy_ ? 1 : 0;
  for (const auto& [urgency, pieces] : pieces_) count += pieces.size();
  return count;
}

void WorkThread::run() {
  for (;;) {
    std::unique_lock lock(mutex_);
    is_busy_ = false;
    news_.wait(lock, [&] { return ends_ || !pieces_.empty(); });
    if (ends_) return;
    auto& first = pieces_.begin()->second;
    auto work = std::move(first.front().second);
    first.pop_front();
    if (first.empty()) pieces_.erase(pieces_.begin());
    is_busy_ = true;
    lock.unlock();
    work();
  }
}

}  // namespace sandpaper
