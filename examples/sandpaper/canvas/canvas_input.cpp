// The mouse and the keys on the canvas: choosing, moving, sizing, panning.
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileInfo>
#include <QKeyEvent>
#include <QMimeData>
#include <QMouseEvent>
#include <QUrl>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "canvas/canvas.hpp"

namespace sandpaper {
namespace {

constexpr double handle_reach = 6;     // pixels
constexpr double least_side = 0.002;   // m, of a patch that is drawn smaller
constexpr int merge_nudges = 1;
constexpr const char* of_materials = "application/x-wale-material";
constexpr const char* of_recipes = "application/x-wale-recipe";

}  // namespace

std::array<QPointF, 8> Canvas::handles() const {
  std::array<QPointF, 8> places;
  const Placed* chosen =
      document_.chosen().size() == 1 ? document_.contents().find(*document_.chosen().begin()) : nullptr;
  const QRectF box = chosen ? box_of(*chosen) : QRectF(-1000, -1000, 0, 0);
  // Clockwise from the upper left.
  const double x[3] = {box.left(), box.center().x(), box.right()}, y[3] = {box.top(), box.center().y(), box.bottom()};
  constexpr int columns[8] = {0, 1, 2, 2, 2, 1, 0, 0}, rows[8] = {0, 0, 0, 1, 2, 2, 2, 1};
  for (int i = 0; i < 8; ++i) places[i] = {x[columns[i]], y[rows[i]]};
  return places;
}

std::optional<int> Canvas::handle_at(QPointF pixels) const {
  if (document_.chosen().size() != 1) return std::nullopt;
  const Placed* chosen = document_.contents().find(*document_.chosen().begin());
  if (!chosen || chosen->locked || !chosen->is_changeable()) return std::nullopt;
  // A polygon and a mask have a size of their own.
  if (!chosen->patch.outline.is_rectangle() && chosen->patch.shape != "ellipse") return std::nullopt;
  const auto places = handles();
  for (int i = 0; i < 8; ++i) {
    const QPointF from = pixels - places[i];
    if (std::abs(from.x()) <= handle_reach && std::abs(from.y()) <= handle_reach) return i;
  }
  return std::nullopt;
}

glm::dvec2 Canvas::snapped(glm::dvec2 metres) const {
  if (snap_ <= 0) return metres;
  return {std::round(metres.x / snap_) * snap_, std::round(metres.y / snap_) * snap_};
}

void Canvas::mousePressEvent(QMouseEvent* event) {
  setFocus(Qt::MouseFocusReason);
  pressed_at_ = dragged_to_ = event->position();
  const bool is_free = event->button() == Qt::LeftButton && event->modifiers() & Qt::AltModifier;
  if (event->button() == Qt::MiddleButton || (is_free && (fixed_ || !patch_at(to_metres(event->position()))))) {
    drag_ = Drag::pan;
    centre_before_ = centre_;
    return;
  }
  // With force on, the mouse is the hand: its button is the device's, unless a key says that patches are meant.
  if (feeling_.is_on() && feeling_.is_mouse() && !(event->modifiers() & (Qt::ControlModifier | Qt::ShiftModifier))) {
    if (event->button() == Qt::LeftButton) feeling_.move_mouse(glm::vec2(to_metres(event->position())), true);
    return;
  }
  if (event->button() != Qt::LeftButton || fixed_) return;
  before_drag_ = document_.contents();
  ++merge_;
  if (const auto handle = handle_at(event->position())) {
    drag_ = Drag::resize;
    handle_ = *handle;
    return;
  }
  const Placed* under = patch_at(to_metres(event->position()));
  auto chosen = document_.chosen();
  if (event->modifiers() & (Qt::ShiftModifier | Qt::ControlModifier)) {
    if (under && !chosen.erase(under->id)) chosen.insert(under->id);
    document_.choose(chosen);
    drag_ = under ? Drag::move : Drag::choose;
    return;
  }
  if (!under) {
    document_.choose({});
    drag_ = Drag::choose;
    return;
  }
  if (!chosen.contains(under->id)) document_.choose({under->id});
  drag_ = Drag::move;
}

void Canvas::drag_to(QPointF pixels, Qt::KeyboardModifiers modifiers) {
  const glm::dvec2 by = to_metres(pixels) - to_metres(pressed_at_);
  const bool freely = modifiers & Qt::AltModifier;
  const int merge = 1000 + merge_;
  if (drag_ == Drag::move) {
    // The first chosen patch snaps; the others keep their distances to it.
    std::optional<glm::dvec2> way;
    for (const PlacedRef& each : before_drag_.placed)
      if (document_.chosen().contains(each->id) && !each->locked && each->is_changeable()) {
        way = freely ? by : snapped(each->patch.at + by) - each->patch.at;
        break;
      }
    if (!way) return;
    document_.change_placed(tr("Move"), document_.chosen(), [&](Placed& placed) {
      const Placed* before = before_drag_.find(placed.id);
      if (before && !placed.locked) placed.patch.at = before->patch.at + *way;
    }, merge);
  } else if (drag_ == Drag::resize) {
    constexpr int x_of[8] = {-1, 0, 1, 1, 1, 0, -1, -1}, y_of[8] = {1, 1, 1, 0, -1, -1, -1, 0};
    const glm::dvec2 side(x_of[handle_], y_of[handle_]);
    document_.change_placed(tr("Resize"), document_.chosen(), [&](Placed& placed) {
      const Placed* before = before_drag_.find(placed.id);
      if (!before) return;
      const glm::dvec2 size = size_of(*before);
      glm::dvec2 corner = before->patch.at + 0.5 * side * size + by;
      if (!freely) corner = snapped(corner);
      glm::dvec2 at = before->patch.at, next = size;
      for (int axis = 0; axis < 2; ++axis) {
        if (side[axis] == 0) continue;
        const double opposite = before->patch.at[axis] - 0.5 * side[axis] * size[axis];
        next[axis] = std::max(least_side, side[axis] * (corner[axis] - opposite));
        at[axis] = opposite + 0.5 * side[axis] * next[axis];
      }
      placed.patch.at = at, placed.patch.size = next;
    }, merge);
  }
}

void Canvas::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->position();
  mouse_ = to_metres(at);
  emit hovered(*mouse_);
  if (feeling_.is_mouse())
    feeling_.move_mouse(glm::vec2(*mouse_),
                        feeling_.is_on() && event->buttons() & Qt::LeftButton && drag_ == Drag::nothing);
  switch (drag_) {
    case Drag::nothing:
      setCursor(feeling_.is_on() && feeling_.is_mouse() ? Qt::BlankCursor
                : handle_at(at)                         ? Qt::SizeAllCursor
                                                        : Qt::ArrowCursor);
      break;
    case Drag::pan: {
      const QPointF by = at - pressed_at_;
      centre_ = centre_before_ - glm::dvec2(by.x(), -by.y()) / scale_;
      view_changed();
      break;
    }
    case Drag::choose: dragged_to_ = at, update(); break;
    case Drag::move:
    case Drag::resize:
      if ((at - pressed_at_).manhattanLength() > 3) drag_to(at, event->modifiers());
  }
}

void Canvas::mouseReleaseEvent(QMouseEvent* event) {
  if (feeling_.is_mouse() && event->button() == Qt::LeftButton)
    feeling_.move_mouse(glm::vec2(to_metres(event->position())), false);
  if (drag_ == Drag::choose) {
    const QRectF box = QRectF(pressed_at_, event->position()).normalized();
    std::set<std::uint64_t> chosen;
    if (event->modifiers() & (Qt::ShiftModifier | Qt::ControlModifier)) chosen = document_.chosen();
    if (box.width() > 2 || box.height() > 2)
      for (const PlacedRef& each : document_.contents().placed)
        if (each->is_laid_out() && box.contains(box_of(*each))) chosen.insert(each->id);
    document_.choose(chosen);
  }
  drag_ = Drag::nothing;
  update();
}

void Canvas::wheelEvent(QWheelEvent* event) { zoom(std::pow(1.0015, event->angleDelta().y()), event->position()); }

void Canvas::leaveEvent(QEvent*) { mouse_.reset(); }

void Canvas::nudge(glm::dvec2 by) {
  document_.change_placed(tr("Move"), document_.chosen(), [&](Placed& placed) {
    if (!placed.locked) placed.patch.at += by;
  }, merge_nudges);
}

void Canvas::keyPressEvent(QKeyEvent* event) {
  const double step = event->modifiers() & Qt::ControlModifier ? 0.0001
                      : event->modifiers() & Qt::ShiftModifier ? 0.01
                                                               : 0.001;
  const bool can = !fixed_ && !document_.chosen().empty();
  switch (event->key()) {
    case Qt::Key_Left: if (can) return nudge({-step, 0}); break;
    case Qt::Key_Right: if (can) return nudge({step, 0}); break;
    case Qt::Key_Up: if (can) return nudge({0, step}); break;
    case Qt::Key_Down: if (can) return nudge({0, -step}); break;
    case Qt::Key_Tab:
    case Qt::Key_N:
    case Qt::Key_P: {
      // The next or the previous patch, in the order of the file.
      const auto& all = document_.contents().placed;
      if (event->key() == Qt::Key_Tab || all.empty() || fixed_) break;
      const bool back = event->key() == Qt::Key_P;
      std::size_t at = back ? 0 : all.size() - 1;  // behind it is the next
      for (std::size_t i = 0; i < all.size(); ++i)
        if (const std::size_t one = back ? all.size() - 1 - i : i; document_.chosen().contains(all[one]->id)) at = one;
      std::set<std::uint64_t> chosen;
      if (event->modifiers() & Qt::ShiftModifier) chosen = document_.chosen();
      chosen.insert(all[(at + (back ? all.size() - 1 : 1)) % all.size()]->id);
      return document_.choose(chosen);
    }
    default: break;
  }
  QWidget::keyPressEvent(event);
}

void Canvas::dragEnterEvent(QDragEnterEvent* event) {
  if (!fixed_ && (event->mimeData()->hasFormat(of_materials) || event->mimeData()->hasFormat(of_recipes) ||
                  event->mimeData()->hasUrls())) event->acceptProposedAction();
}

void Canvas::dropEvent(QDropEvent* event) {
  const glm::dvec2 at = snapped(to_metres(event->position()));
  if (event->mimeData()->hasFormat(of_materials)) {
    emit material_dropped(QString::fromUtf8(event->mimeData()->data(of_materials)), at);
  } else if (event->mimeData()->hasFormat(of_recipes)) {
    emit recipe_dropped(QString::fromUtf8(event->mimeData()->data(of_recipes)), at);
  } else {
    QStringList workspaces, others;
    for (const QUrl& each : event->mimeData()->urls())
      if (const QString file = each.toLocalFile(); !file.isEmpty())
        (file.endsWith(".wale") || file.endsWith(".wws") ? workspaces : others) << file;
    if (!workspaces.isEmpty()) emit file_dropped(workspaces.front());
    else if (!others.isEmpty()) emit others_dropped(others, at);
  }
  event->acceptProposedAction();
}

}  // namespace sandpaper
