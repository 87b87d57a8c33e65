#pragma once

#include <QAccessibleWidget>
#include <QPointer>
#include <memory>
#include <unordered_map>

#include "canvas/canvas.hpp"

namespace sandpaper {

/// What a screen reader meets on the canvas: each patch is a child with a name, a place and actions. In the window's
/// thread.
class CanvasAccess : public QAccessibleWidget {
 public:
  explicit CanvasAccess(Canvas& canvas);
  ~CanvasAccess() override;

  int childCount() const override;
  QAccessibleInterface* child(int index) const override;
  int indexOfChild(const QAccessibleInterface* child) const override;
  QAccessibleInterface* childAt(int x, int y) const override;
  QAccessibleInterface* focusChild() const override;
  QString text(QAccessible::Text kind) const override;

  Canvas& canvas() const { return canvas_; }
  Document& document() const;
  /// The patch that is child `index`; null if there is none.
  const Placed* placed(int index) const;

 private:
  QAccessibleInterface* of(std::uint64_t id) const;

  Canvas& canvas_;
  mutable std::unordered_map<std::uint64_t, QAccessible::Id> known_;
};

/// Makes Qt use it for canvases. Once per process.
void use_canvas_access();

}  // namespace sandpaper
