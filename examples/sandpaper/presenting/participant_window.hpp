#pragma once

#include <QStackedWidget>

#include "canvas/canvas.hpp"
#include "presenting/sorting_page.hpp"

namespace sandpaper {

/// The window that a participant sees: the workspace, where nothing can be moved, or the sorting table. Patches have
/// numbers for names, for screen readers too, so that no word tells a material.
class ParticipantWindow : public QStackedWidget {
  Q_OBJECT

 public:
  ParticipantWindow(Document& document, Feeling& feeling, Pictures& pictures, const Numbers& numbers, Sorting& sorting,
                    QWidget* parent);

  /// As the other window looks, but for the numbers.
  void set_look(const CanvasLook& look);
  /// Whether all patches look alike here, whatever the other window shows; at first they do.
  void set_blind(bool blind);
  Canvas& canvas() const { return *canvas_; }
  SortingPage& page() const { return *page_; }

 signals:
  void visible_changed(bool visible);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  Canvas* canvas_;
  SortingPage* page_;
  CanvasLook look_;
  bool blind_ = true;
};

}  // namespace sandpaper
