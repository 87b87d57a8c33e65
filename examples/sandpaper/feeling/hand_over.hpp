#pragma once

#include <QObject>
#include <deque>
#include <functional>
#include <mutex>

namespace sandpaper {

/// Does in the thread in which it was made, mostly the window's, what other threads ask of it: what they found comes
/// into the window by it. What was not done when it ends is dropped.
class HandOver : public QObject {
 public:
  /// From any thread. In the order of the calls of one thread.
  void post(std::function<void()> work);

 protected:
  void customEvent(QEvent* event) override;

 private:
  std::mutex mutex_;
  std::deque<std::function<void()>> waiting_;
};

}  // namespace sandpaper
