#include "presenting/participant_window.hpp"

#include <QScreen>
#include <QShowEvent>

namespace sandpaper {
namespace {

constexpr int usual_side = 800;  // pixels

}  // namespace

ParticipantWindow::ParticipantWindow(Document& document, Feeling& feeling, Pictures& pictures, const Numbers& numbers,
                                     Sorting& sorting, QWidget* parent)
    : QStackedWidget(parent),
      canvas_(new Canvas(document, feeling, pictures, numbers)),
      page_(new SortingPage(sorting, feeling)) {
  setParent(parent, Qt::Window);
  setObjectName("participant_window");
  setWindowTitle(tr("Sandpaper"));
  canvas_->setObjectName("participant_canvas");
  canvas_->set_fixed(true);
  addWidget(canvas_);
  addWidget(page_);
  const QSize room = 0.8 * screen()->availableSize();
  resize(QSize(usual_side, usual_side).boundedTo(room));
  set_look({});
  connect(&sorting, &Sorting::changed, this, [this, &sorting] {
    QWidget* shown = sorting.runs() ? static_cast<QWidget*>(page_) : canvas_;
    if (currentWidget() == shown) return;
    setCurrentWidget(shown);
    shown->setFocus();
  });
  if (sorting.runs()) setCurrentWidget(page_);
}

void ParticipantWindow::set_look(const CanvasLook& look) {
  look_ = look;
  CanvasLook own = look;
  own.grid = false;
  own.random_numbers = true;
  if (blind_) own.surfaces = Look::blind, own.marks = own.force = false;
  canvas_->set_look(own);
}

void ParticipantWindow::set_blind(bool blind) {
  blind_ = blind;
  set_look(look_);
}

void ParticipantWindow::showEvent(QShowEvent* event) {
  QStackedWidget::showEvent(event);
  emit visible_changed(true);
}

void ParticipantWindow::hideEvent(QHideEvent* event) {
  QStackedWidget::hideEvent(event);
  emit visible_changed(false);
}

}  // namespace sandpaper
