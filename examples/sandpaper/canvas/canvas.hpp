#pragma once

#include <QCache>
#include <QElapsedTimer>
#include <QImage>
#include <QPixmap>
#include <QTimer>
#include <QWidget>
#include <glm/vec2.hpp>
#include <optional>
#include <set>

#include "canvas/marks.hpp"
#include "document/document.hpp"
#include "document/numbers.hpp"
#include "feeling/feeling.hpp"
#include "canvas/pictures.hpp"

namespace sandpaper {

/// How the hand is shown.
enum class Cursor { ring, square, drop_shadow, hidden };

/// What the canvas shows besides the patches.
struct CanvasLook {
  Look surfaces = Look::relief;
  Cursor cursor = Cursor::ring;
  bool cursor_behind = false;  ///< behind the patches' outlines and names
  bool force = true;           ///< the force as an arrow
  bool grid = true, names = true, marks = true;
  bool random_numbers = false;  ///< three digits instead of each name, new in each session
  bool black = false;           ///< black background
};

/// The workspace from above: patches where they lie, the hand, the force. The mouse and the keys lay patches out. In
/// the window's thread.
class Canvas : public QWidget {
  Q_OBJECT

 public:
  Canvas(Document& document, Feeling& feeling, Pictures& pictures, const Numbers& numbers, QWidget* parent = nullptr);

  Document& document() const { return document_; }
  const CanvasLook& look() const { return look_; }
  void set_look(const CanvasLook& look);
  /// Places snap to multiples of this, m; 0: they do not.
  void set_snap(double metres) { snap_ = metres; }
  double snap() const { return snap_; }
  /// Only shows: nobody can move anything (the participant's window).
  void set_fixed(bool fixed) { fixed_ = fixed; }
  bool is_fixed() const { return fixed_; }

  void zoom(double factor, std::optional<QPointF> about = {});
  void show_all();
  double pixels_per_metre() const { return scale_; }

  QPointF to_pixels(glm::dvec2 metres) const;
  glm::dvec2 to_metres(QPointF pixels) const;
  /// The rectangle that a patch covers, m from the workspace's centre: centre and full size.
  glm::dvec2 size_of(const Placed& placed) const;
  QRectF box_of(const Placed& placed) const;  ///< in pixels
  /// The front-most patch at a place.
  const Placed* patch_at(glm::dvec2 metres) const;
  /// What a patch is called on the canvas.
  QString label_of(const Placed& placed) const;
  /// The same, with what it is made of unless numbers hide that.
  QString told_of(const Placed& placed) const;
  /// The patch under the hand, or with force off under the mouse.
  std::optional<std::uint64_t> touched() const { return touched_; }
  const wale::Now& now() const { return now_; }

 signals:
  void touched_changed();
  void hovered(glm::dvec2 metres);
  void material_dropped(const QString& spelling, glm::dvec2 metres);
  void recipe_dropped(const QString& recipe, glm::dvec2 metres);
  void others_dropped(const QStringList& files, glm::dvec2 metres);  ///< pictures, and files of the thesis's Sandpaper
  void file_dropped(const QString& file);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  /// What the pressed mouse does.
  enum class Drag { nothing, pan, choose, move, resize };

  void refresh();      ///< reads the hand, 60 times a second
  void draw_still();   ///< all that does not move, into `still_`
  void draw_patch(QPainter& painter, const Placed& placed);
  void draw_label(QPainter& painter, const Placed& placed, const QRectF& box);
  /// Where a patch's name is written in its box, and as much of it as fits there; an empty text if it is not.
  std::pair<QRectF, QString> label_place(const Placed& placed, const QRectF& box) const;
  void find_marked();  ///< the patches whose marks can be seen, and where
  void add_cursor(std::vector<MovingShape>& shapes) const;
  void add_arrow(std::vector<MovingShape>& shapes) const;
  QRegion follow_moving();  ///< where what moves is another than before
  void draw_moving(QPainter& painter, const QRegion& where);
  void draw_remembered();  ///< the touched surface, if its program changes it
  QImage covered_part(const Placed& placed, QSize pixels);
  std::vector<float> parameters_of(const Placed& placed) const;
  void changed();
  void view_changed();
  void tell_readers();  ///< that another patch is chosen
  std::optional<int> handle_at(QPointF pixels) const;
  std::array<QPointF, 8> handles() const;
  glm::dvec2 snapped(glm::dvec2 metres) const;
  void drag_to(QPointF pixels, Qt::KeyboardModifiers modifiers);
  void nudge(glm::dvec2 by);

  Document& document_;
  Feeling& feeling_;
  Pictures& pictures_;
  const Numbers& numbers_;
  CanvasLook look_;
  double scale_ = 3000;       // pixels per metre
  glm::dvec2 centre_{0};      // m, in the middle of the widget
  bool shows_all_ = true;     // follows the size of the widget
  double snap_ = 0.001;
  bool fixed_ = false;
  QCache<QString, QImage> covered_{64 * 1024};  // how much of each pixel a shape covers, kB
  QPixmap still_;
  bool still_is_old_ = true;
  QTimer timer_;
  QTimer moving_;  // while the view moves, patches are drawn with less detail
  wale::Now now_;
  std::optional<std::uint64_t> touched_;
  std::optional<glm::dvec2> mouse_;  // m, while it is over the canvas
  struct Marked {
    PlacedRef placed;
    QRegion seen;
  };
  Marks marks_;
  std::vector<Marked> marked_;
  bool marked_are_old_ = true, was_on_ = false;
  std::vector<MovingShape> moving_shapes_;  // the marks, the cursor, and the force as an arrow
  QElapsedTimer last_live_;

  Drag drag_ = Drag::nothing;
  QPointF pressed_at_, dragged_to_;
  int handle_ = 0;
  Contents before_drag_;
  glm::dvec2 centre_before_{0};
  int merge_ = 0;
};

}  // namespace sandpaper
