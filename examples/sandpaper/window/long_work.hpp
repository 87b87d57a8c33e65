#pragma once

#include <QFrame>
#include <QLabel>
#include <QProgressBar>
#include <atomic>
#include <functional>
#include <memory>

#include "feeling/hand_over.hpp"
#include "feeling/work_thread.hpp"

namespace sandpaper {

/// A line that shows how far long work is, with a button that ends it. One piece of work at a time, on a thread of its
/// own.
class LongWork : public QFrame {
  Q_OBJECT

 public:
  /// How the work says how far it is, 0 .. 1, from its thread. It returns false once the work is to end.
  using Progress = std::function<bool(double)>;

  explicit LongWork(QWidget* parent = nullptr);
  ~LongWork() override;

  /// Begins it. `work` returns what is to be said; where it was cancelled, that is said instead. False if other work is
  /// under way.
  bool begin(const QString& what, const std::function<QString(const Progress&)>& work);
  bool is_busy() const { return busy_; }
  void cancel();

 signals:
  void ended(const QString& words);

 private:
  QLabel* words_;
  QProgressBar* bar_;
  bool busy_ = false;
  std::shared_ptr<std::atomic<bool>> cancelled_;
  HandOver window_;
  std::unique_ptr<WorkThread> thread_;
};

}  // namespace sandpaper
