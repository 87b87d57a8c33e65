#pragma once

#include <QAccessible>
#include <QPointer>
#include <QWidget>
#include <QWindow>
#include <functional>
#include <utility>
#include <vector>

namespace sandpaper {

/// What a screen reader meets of something that a widget paints and that is no widget itself: an item of a list, with
/// actions. On the thread of the window.
class ItemAccess : public QAccessibleInterface, public QAccessibleActionInterface {
 public:
  explicit ItemAccess(QWidget* list) : list_(list) {}

  QObject* object() const override { return nullptr; }
  QWindow* window() const override { return list_ ? list_->window()->windowHandle() : nullptr; }
  QAccessibleInterface* parent() const override {
    return list_ ? QAccessible::queryAccessibleInterface(list_) : nullptr;
  }
  QAccessibleInterface* child(int) const override { return nullptr; }
  QAccessibleInterface* childAt(int, int) const override { return nullptr; }
  int childCount() const override { return 0; }
  int indexOfChild(const QAccessibleInterface*) const override { return -1; }
  QAccessible::Role role() const override { return QAccessible::ListItem; }
  void setText(QAccessible::Text, const QString&) override {}
  QRect rect() const override {
    return isValid() ? box().toAlignedRect().translated(list_->mapToGlobal(QPoint(0, 0))) : QRect();
  }
  QAccessible::State state() const override {
    QAccessible::State state;
    state.invalid = !isValid();
    state.selectable = state.focusable = isValid();
    state.selected = state.focused = isValid() && is_chosen();
    return state;
  }
  void* interface_cast(QAccessible::InterfaceType type) override {
    return type == QAccessible::ActionInterface ? static_cast<QAccessibleActionInterface*>(this) : nullptr;
  }
  QStringList actionNames() const override {
    QStringList names;
    for (const auto& [name, act] : actions()) names << name;
    return names;
  }
  QStringList keyBindingsForAction(const QString&) const override { return {}; }
  void doAction(const QString& wanted) override {
    if (!isValid()) return;
    for (const auto& [name, act] : actions())
      if (name == wanted) return act();
  }

 protected:
  using Actions = std::vector<std::pair<QString, std::function<void()>>>;
  /// Pixels of the widget. These two are asked only of a valid item.
  virtual QRectF box() const = 0;
  virtual bool is_chosen() const = 0;
  /// By their names; none of an item that is not valid.
  virtual Actions actions() const = 0;
  bool has_list() const { return !list_.isNull(); }

 private:
  QPointer<QWidget> list_;
};

}  // namespace sandpaper
