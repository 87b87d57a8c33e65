#include "window/announcement.hpp"

#include <QAccessible>
#include <QEvent>
#include <QHBoxLayout>
#include <algorithm>

namespace sandpaper {
namespace {

constexpr int least_milliseconds = 6000, for_each_letter = 70;

}  // namespace

Announcement::Announcement(QWidget* over) : QFrame(over), words_(new QLabel), button_(new QToolButton) {
  setFrameShape(QFrame::StyledPanel);
  setAutoFillBackground(true);
  over->installEventFilter(this);
  words_->setWordWrap(true);
  words_->setTextFormat(Qt::PlainText);
  words_->setObjectName("announcement");
  auto* close = new QToolButton;
  close->setText("✕");
  close->setAccessibleName(tr("Close this line"));
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(8, 4, 4, 4);
  layout->addWidget(words_, 1);
  layout->addWidget(button_);
  layout->addWidget(close);
  timer_.setSingleShot(true);
  connect(&timer_, &QTimer::timeout, this, &Announcement::go_on);
  connect(close, &QToolButton::clicked, this, [this] { withdraw(text()); });
  connect(button_, &QToolButton::clicked, this, [this] {
    hide();
    const std::function<void()> act = act_;  // it may replace itself
    if (act) act();
    if (isHidden()) go_on();
  });
  hide();
}

bool Announcement::eventFilter(QObject* watched, QEvent* event) {
  if (watched == parent() && event->type() == QEvent::Resize) take_place();
  return QFrame::eventFilter(watched, event);
}

void Announcement::take_place() {
  const int width = parentWidget()->width();
  layout()->activate();
  setGeometry(0, 0, width, std::max(sizeHint().height(), layout()->heightForWidth(width)));
}

void Announcement::say(const QString& words) {
  show_line({words, {}, {}});
  timer_.start(std::max(least_milliseconds, for_each_letter * static_cast<int>(words.size())));
}

void Announcement::offer(const QString& words, const QString& button, const std::function<void()>& act) {
  show_line({words, button, act});
}

void Announcement::keep_offering(const QString& words, const QString& button, const std::function<void()>& act) {
  kept_ = Offer{words, button, act};
  show_line(*kept_);
}

void Announcement::withdraw(const QString& words) {
  if (kept_ && kept_->words == words) kept_.reset();
  if (text() == words) go_on();
}

void Announcement::go_on() {
  timer_.stop();
  hide();
  if (kept_) show_line(*kept_);
}

void Announcement::show_line(const Offer& line) {
  timer_.stop();
  act_ = line.act;
  words_->setText(line.words);
  words_->setAccessibleName(line.words);
  button_->setText(line.button);
  button_->setVisible(!line.button.isEmpty());
  take_place();
  show();
  raise();
  if (quiet_) return;
  QAccessibleEvent alert(words_, QAccessible::Alert);
  QAccessible::updateAccessibility(&alert);
  emit read_out(line.words);
}

}  // namespace sandpaper
