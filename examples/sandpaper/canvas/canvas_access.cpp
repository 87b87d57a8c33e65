#include "canvas/canvas_access.hpp"

#include "document/counted.hpp"

#include <QAccessible>
#include <algorithm>
#include <cmath>

#include "canvas/item_access.hpp"

namespace sandpaper {
namespace {

constexpr double one_move = 0.001;  // m

/// One patch.
class PatchAccess : public ItemAccess {
 public:
  PatchAccess(const CanvasAccess& owner, QWidget* canvas, std::uint64_t id)
      : ItemAccess(canvas), owner_(owner), id_(id) {}

  bool isValid() const override { return has_list() && placed(); }

  QString text(QAccessible::Text kind) const override {
    const Placed* patch = isValid() ? placed() : nullptr;
    if (!patch) return {};
    const glm::dvec2 at = 1000.0 * patch->patch.at, size = 1000.0 * owner_.canvas().size_of(*patch);
    switch (kind) {
      case QAccessible::Name: return owner_.canvas().label_of(*patch);
      case QAccessible::Value:
        return owner_.canvas().look().random_numbers ? QString() : QString::fromStdString(patch->patch.made_of);
      case QAccessible::Description:
        return Canvas::tr("%1, at %2, %3 mm, %4 by %5 mm%6")
            .arg(owner_.canvas().told_of(*patch))
            .arg(at.x, 0, 'f', 1).arg(at.y, 0, 'f', 1).arg(size.x, 0, 'f', 1).arg(size.y, 0, 'f', 1)
            .arg(patch->locked ? Canvas::tr(", locked") : QString());
      default: return {};
    }
  }

 private:
  const Placed* placed() const { return owner_.document().contents().find(id_); }

  QRectF box() const override { return owner_.canvas().box_of(*placed()); }
  bool is_chosen() const override { return owner_.document().chosen().contains(id_); }
  Actions actions() const override {
    if (!isValid() || owner_.canvas().is_fixed()) return {};  // the participant's window only shows
    Document& document = owner_.document();
    const auto move = [&document, id = id_](glm::dvec2 by) {
      document.change_placed(Canvas::tr("Move"), {id}, [by](Placed& placed) {
        if (!placed.locked) placed.patch.at += by;
      });
    };
    return {{pressAction(), [&document, id = id_] { document.choose({id}); }},
            {Canvas::tr("move left"), [move] { move({-one_move, 0}); }},
            {Canvas::tr("move right"), [move] { move({one_move, 0}); }},
            {Canvas::tr("move up"), [move] { move({0, one_move}); }},
            {Canvas::tr("move down"), [move] { move({0, -one_move}); }},
            {Canvas::tr("raise"), [&document, id = id_] { document.raise({id}, 1); }},
            {Canvas::tr("lower"), [&document, id = id_] { document.raise({id}, -1); }},
            {Canvas::tr("delete"), [&document, id = id_] { document.remove({id}); }}};
  }

  const CanvasAccess& owner_;
  std::uint64_t id_;
};

QAccessibleInterface* make_access(const QString& of_class, QObject* object) {
  if (of_class == QLatin1String("sandpaper::Canvas"))
    if (auto* canvas = qobject_cast<Canvas*>(object)) return new CanvasAccess(*canvas);
  return nullptr;
}

}  // namespace

CanvasAccess::CanvasAccess(Canvas& canvas) : QAccessibleWidget(&canvas, QAccessible::List), canvas_(canvas) {}

CanvasAccess::~CanvasAccess() {
  for (const auto& [id, known] : known_) QAccessible::deleteAccessibleInterface(known);
}

Document& CanvasAccess::document() const { return canvas_.document(); }

const Placed* CanvasAccess::placed(int index) const {
  const auto& all = document().contents().placed;
  return index >= 0 && index < static_cast<int>(all.size()) ? all[static_cast<std::size_t>(index)].get() : nullptr;
}

int CanvasAccess::childCount() const { return static_cast<int>(document().contents().placed.size()); }

QAccessibleInterface* CanvasAccess::of(std::uint64_t id) const {
  const auto known = known_.find(id);
  if (known != known_.end())
    if (QAccessibleInterface* found = QAccessible::accessibleInterface(known->second)) return found;
  auto* made = new PatchAccess(*this, &canvas_, id);
  known_[id] = QAccessible::registerAccessibleInterface(made);
  return made;
}

QAccessibleInterface* CanvasAccess::child(int index) const {
  const Placed* found = placed(index);
  return found ? of(found->id) : nullptr;
}

int CanvasAccess::indexOfChild(const QAccessibleInterface* child) const {
  const auto& all = document().contents().placed;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const auto known = known_.find(all[i]->id);
        known != known_.end() && QAccessible::accessibleInterface(known->second) == child)
      return static_cast<int>(i);
  return -1;
}

QAccessibleInterface* CanvasAccess::childAt(int x, int y) const {
  const Placed* found = canvas_.patch_at(canvas_.to_metres(QPointF(canvas_.mapFromGlobal(QPoint(x, y)))));
  return found ? of(found->id) : nullptr;
}

QAccessibleInterface* CanvasAccess::focusChild() const {
  return canvas_.hasFocus() && document().chosen().size() == 1 ? of(*document().chosen().begin()) : nullptr;
}

QString CanvasAccess::text(QAccessible::Text kind) const {
  if (kind == QAccessible::Description) {
    const auto touched = canvas_.touched();
    const Placed* on = touched ? document().contents().find(*touched) : nullptr;
    return counted(childCount(), "patch", "patches") +
           (on ? Canvas::tr(", the hand is on %1").arg(canvas_.label_of(*on)) : QString());
  }
  return QAccessibleWidget::text(kind);
}

void use_canvas_access() {
  static const bool once = [] {
    QAccessible::installFactory(make_access);
    return true;
  }();
  (void)once;
}

}  // namespace sandpaper
