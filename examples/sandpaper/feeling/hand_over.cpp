#include "feeling/hand_over.hpp"

#include <QCoreApplication>
#include <QEvent>
#include <utility>

namespace sandpaper {

// A lock of our own and not a call that Qt queues: what is handed over is then ordered also to the eyes of a thread
// sanitizer, which does not see into Qt.
void HandOver::post(std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(work));
  }
  QCoreApplication::postEvent(this, new QEvent(QEvent::User));
}

void HandOver::customEvent(QEvent*) {
  std::function<void()> work;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return;
    work = std::move(waiting_.front());
    waiting_.pop_front();
  }
  work();
}

}  // namespace sandpaper
