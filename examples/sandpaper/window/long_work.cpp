#include "window/long_work.hpp"

#include <QHBoxLayout>
#include <QToolButton>
#include <cmath>

namespace sandpaper {

LongWork::LongWork(QWidget* parent)
    : QFrame(parent), words_(new QLabel), bar_(new QProgressBar), thread_(std::make_unique<WorkThread>()) {
  setFrameShape(QFrame::StyledPanel);
  setObjectName("long_work");
  auto* cancel = new QToolButton;
  cancel->setObjectName("cancel_work");
  cancel->setText(tr("Cancel"));
  bar_->setRange(0, 100);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 4, 4, 4);
  row->addWidget(words_);
  row->addWidget(bar_, 1);
  row->addWidget(cancel);
  connect(cancel, &QToolButton::clicked, this, &LongWork::cancel);
  hide();
}

LongWork::~LongWork() {
  cancel();
  thread_.reset();  // waits: the work ends soon
}

void LongWork::cancel() {
  if (cancelled_) *cancelled_ = true;
}

bool LongWork::begin(const QString& what, const std::function<QString(const Progress&)>& work) {
  if (busy_) return false;
  busy_ = true;
  words_->setText(what);
  bar_->setAccessibleName(what);
  bar_->setValue(0);
  show();
  const auto cancelled = std::make_shared<std::atomic<bool>>(false);
  cancelled_ = cancelled;
  const auto shown = std::make_shared<std::atomic<int>>(0);
  const Progress progress = [this, cancelled, shown](double share) {
    const int percent = static_cast<int>(std::lround(100 * share));
    if (shown->exchange(percent) != percent)
      window_.post([this, percent] { bar_->setValue(percent); });
    return !*cancelled;
  };
  thread_->post(0, "work", [this, work, progress, cancelled] {
    const QString words = work(progress);
    window_.post([this, words, cancelled] {
      busy_ = false;
      hide();
      emit ended(*cancelled ? tr("Cancelled: nothing is written") : words);
    });
  });
  return true;
}

}  // namespace sandpaper
