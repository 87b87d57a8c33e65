#pragma once

#include <QThread>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace sandpaper {

/// A thread that does one piece of work after the other, the more urgent ones first. A piece of the same key as one
/// that waits takes its place. The destructor waits for the piece that is under way; the others are dropped.
class WorkThread : public QThread {
 public:
  WorkThread();
  ~WorkThread() override;

  /// From any thread. `urgency`: the larger, the sooner; equal ones in the order of the calls.
  void post(int urgency, const std::string& key, std::function<void()> work);
  /// How many pieces wait or are under way.
  std::size_t waiting() const;

 protected:
  void run() override;

 private:
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::map<int, std::deque<std::pair<std::string, std::function<void()>>>, std::greater<>> pieces_;
  bool is_busy_ = false, ends_ = false;
};

}  // namespace sandpaper
