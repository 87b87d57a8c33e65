#include "presenting/sorting_table.hpp"

#include <QAccessible>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

namespace sandpaper {
namespace {

constexpr int picture_milliseconds = 16;
constexpr double strip = 20;      // pixels, the height of a pile's label
constexpr double least_drag = 4;  // pixels

}  // namespace

SortingTable::SortingTable(Sorting& sorting, Feeling& feeling, QWidget* parent)
    : QWidget(parent), sorting_(sorting), feeling_(feeling) {
  use_sorting_access();
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(tr("Keys to sort"));
  setAttribute(Qt::WA_OpaquePaintEvent);
  connect(&sorting_, &Sorting::changed, this, qOverload<>(&QWidget::update));
  connect(&sorting_, &Sorting::chosen_changed, this, &SortingTable::tell_readers);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (isVisible() && feeling_.is_on()) update();
  });
  timer_.start(picture_milliseconds);
}

double SortingTable::scale() const {
  return std::max(1.0, std::min(width() / sorting_.table().x, (height() - 2 * strip) / sorting_.table().y));
}

QPointF SortingTable::to_pixels(glm::dvec2 metres) const {
  return {width() / 2.0 + metres.x * scale(), height() / 2.0 - metres.y * scale()};
}

glm::dvec2 SortingTable::to_metres(QPointF pixels) const {
  return {(pixels.x() - width() / 2.0) / scale(), -(pixels.y() - height() / 2.0) / scale()};
}

QRectF SortingTable::rectangle(glm::dvec2 centre, glm::dvec2 size) const {
  return QRectF(to_pixels({centre.x - size.x / 2, centre.y + size.y / 2}),
                to_pixels({centre.x + size.x / 2, centre.y - size.y / 2}));
}

QRectF SortingTable::box_of(const SortingKey& key) const { return rectangle(key.at, glm::dvec2(sorting_.side())); }

QRectF SortingTable::box_of_pile(int pile) const {
  QRectF box;
  for (const SortingKey& each : sorting_.keys())
    if (each.pile == pile) box |= box_of(each);
  return box.adjusted(-4, -4 - strip, 4, 4);
}

QRectF SortingTable::label_of(int pile) const {
  const QRectF box = box_of_pile(pile);
  return {box.left(), box.top(), box.width(), strip};
}

int SortingTable::pile_labelled_at(QPointF pixels) const {
  for (const int pile : sorting_.piles())
    if (label_of(pile).contains(pixels)) return pile;
  return 0;
}

void SortingTable::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  const QColor ink = palette().color(QPalette::Text), highlight = palette().color(QPalette::Highlight);
  const QRectF area = rectangle(sorting_.area_at(), sorting_.area_size());
  painter.setPen(QPen(ink, 1.5));
  painter.setBrush(palette().color(QPalette::AlternateBase));
  painter.drawRect(area);
  const SortingKey* chosen = sorting_.chosen();
  // At the top: the hand is in the middle.
  painter.drawText(area.adjusted(4, 6, -4, -6), Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap,
                   !chosen              ? tr("Choose a key:\nits surface is felt here")
                   : !feeling_.is_on() ? tr("%1\nno force").arg(chosen->label)
                                       : chosen->label);
  for (const int pile : sorting_.piles()) {
    painter.setPen(QPen(chosen && chosen->pile == pile ? highlight : ink, 1.5));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(box_of_pile(pile), 5, 5);
    painter.setPen(ink);
    const QRectF place = label_of(pile).adjusted(5, 0, -3, 0);
    const QString words =
        sorting_.says(pile).isEmpty() ? QString::number(pile) : QString("%1 %2").arg(pile).arg(sorting_.says(pile));
    painter.drawText(place, Qt::AlignVCenter,
                     fontMetrics().elidedText(words, Qt::ElideRight, static_cast<int>(place.width())));
  }
  for (std::size_t i = 0; i < sorting_.keys().size(); ++i) {
    const SortingKey& key = sorting_.keys()[i];
    const QRectF box = box_of(key);
    const bool is_chosen = sorting_.chosen_index() == i;
    painter.setPen(QPen(is_chosen ? highlight : ink, is_chosen ? 4 : 1));
    painter.setBrush(Qt::black);
    painter.drawRect(box);
    painter.setPen(Qt::white);
    painter.drawText(box, Qt::AlignCenter,
                     fontMetrics().elidedText(key.label, Qt::ElideRight, static_cast<int>(box.width()) - 4));
  }
  if (dragged_pile_ != 0) {
    painter.setPen(QPen(highlight, 2, Qt::DashLine));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(box_of_pile(dragged_pile_).translated(dragged_to_ - pressed_at_), 5, 5);
  }
  if (feeling_.is_on()) {
    painter.setPen(QPen(ink, 2));
    painter.setBrush(QColor(255, 255, 255, 200));
    painter.drawEllipse(to_pixels(glm::dvec2(feeling_.now().position)), 7, 7);
  }
  if (hasFocus()) {
    painter.setPen(QPen(highlight, 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
  }
}

void SortingTable::mousePressEvent(QMouseEvent* event) {
  setFocus(Qt::MouseFocusReason);
  if (event->button() != Qt::LeftButton) return;
  pressed_at_ = dragged_to_ = event->position();
  if (const auto key = sorting_.key_at(to_metres(pressed_at_))) {
    sorting_.choose(*key);
    dragged_ = key;
    from_ = sorting_.keys()[*key].at;
    grip_ = to_metres(pressed_at_) - from_;
  } else {
    dragged_pile_ = pile_labelled_at(pressed_at_);
  }
}

void SortingTable::mouseMoveEvent(QMouseEvent* event) {
  dragged_to_ = event->position();
  if (feeling_.is_mouse()) feeling_.move_mouse(glm::vec2(to_metres(dragged_to_)), false);
  if (dragged_ && (dragged_to_ - pressed_at_).manhattanLength() > least_drag)
    sorting_.move(*dragged_, to_metres(dragged_to_) - grip_);
  if (dragged_pile_ != 0) update();
}

void SortingTable::mouseReleaseEvent(QMouseEvent* event) {
  dragged_to_ = event->position();
  const bool moved = (dragged_to_ - pressed_at_).manhattanLength() > least_drag;
  if (const auto key = std::exchange(dragged_, std::nullopt); key && moved) {
    const glm::dvec2 dropped_at = sorting_.keys()[*key].at;
    const int pile = sorting_.keys()[*key].pile;
    sorting_.move(*key, from_);  // a change that is taken back brings it back here
    std::optional<std::size_t> under;
    for (std::size_t i = 0; i < sorting_.keys().size(); ++i)
      if (i != *key && box_of(sorting_.keys()[i]).contains(dragged_to_)) under = i;
    int onto = 0;
    for (const int each : sorting_.piles())
      if (box_of_pile(each).contains(dragged_to_)) onto = each;
    if (under && sorting_.keys()[*under].pile == 0) sorting_.put_on(*key, *under);
    else if (onto != 0) sorting_.put(*key, onto);
    else {
      sorting_.put(*key, 0);
      if (sorting_.keys()[*key].pile == 0) sorting_.move(*key, dropped_at);
    }
    if (onto != 0 && onto == pile) update();
  }
  if (const int pile = std::exchange(dragged_pile_, 0); pile != 0 && moved)
    for (const int each : sorting_.piles())
      if (each != pile && box_of_pile(each).contains(dragged_to_)) {
        sorting_.join(pile, each);
        break;
      }
  update();
}

void SortingTable::step(int by) {
  const auto count = static_cast<int>(sorting_.keys().size());
  if (count == 0) return;
  const int now = sorting_.chosen_index() ? static_cast<int>(*sorting_.chosen_index()) : (by > 0 ? -1 : 0);
  sorting_.choose(static_cast<std::size_t>((now + by + count) % count));
}

bool SortingTable::event(QEvent* event) {
  // Ctrl and a digit change how the canvas looks; here they join piles.
  if (event->type() == QEvent::ShortcutOverride) {
    const auto* key = static_cast<QKeyEvent*>(event);
    if (key->modifiers() == Qt::ControlModifier && key->key() >= Qt::Key_1 && key->key() <= Qt::Key_9) {
      event->accept();
      return true;
    }
  }
  return QWidget::event(event);
}

void SortingTable::keyPressEvent(QKeyEvent* event) {
  const auto chosen = sorting_.chosen_index();
  const int digit = event->key() - Qt::Key_0;
  switch (event->key()) {
    case Qt::Key_Right:
    case Qt::Key_Down:
    case Qt::Key_N: return step(1);
    case Qt::Key_Left:
    case Qt::Key_Up:
    case Qt::Key_P: return step(-1);
    case Qt::Key_Plus:
      if (chosen) sorting_.put(*chosen, sorting_.new_pile());
      return;
    case Qt::Key_Backspace: return sorting_.take_back();
    case Qt::Key_L: emit label_wanted(); return;
    default: break;
  }
  if (digit >= 0 && digit <= 9 && chosen) {
    if (event->modifiers() & Qt::ControlModifier) sorting_.join(sorting_.keys()[*chosen].pile, digit);
    else sorting_.put(*chosen, digit);
    return;
  }
  QWidget::keyPressEvent(event);
}

void SortingTable::tell_readers() {
  if (!QAccessible::isActive() || !sorting_.chosen_index() || !isVisible()) return;
  QAccessibleEvent event(this, QAccessible::Focus);
  event.setChild(static_cast<int>(*sorting_.chosen_index()));
  QAccessible::updateAccessibility(&event);
}

}  // namespace sandpaper
