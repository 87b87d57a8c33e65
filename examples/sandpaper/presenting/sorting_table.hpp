#pragma once

#include <QTimer>
#include <QWidget>

#include "feeling/feeling.hpp"
#include "presenting/sorting.hpp"

namespace sandpaper {

/// The keys, the piles and the touching area from above. Keys are chosen with a click, not by moving over them, and
/// dragged into piles: onto another key, which joins it or makes a pile of both; onto free ground, which takes it out.
/// A pile is dragged by its label. In the window's thread.
class SortingTable : public QWidget {
  Q_OBJECT

 public:
  SortingTable(Sorting& sorting, Feeling& feeling, QWidget* parent = nullptr);

  Sorting& sorting() const { return sorting_; }
  QPointF to_pixels(glm::dvec2 metres) const;
  glm::dvec2 to_metres(QPointF pixels) const;
  QRectF box_of(const SortingKey& key) const;  ///< in pixels
  QRectF label_of(int pile) const;             ///< the same of the strip with a pile's label, by which it is dragged
  QSize minimumSizeHint() const override { return {320, 240}; }

 signals:
  void label_wanted();  ///< somebody wants to type the label of the chosen key's pile

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  double scale() const;  ///< pixels per metre
  QRectF rectangle(glm::dvec2 centre, glm::dvec2 size) const;
  QRectF box_of_pile(int pile) const;
  int pile_labelled_at(QPointF pixels) const;
  void step(int by);
  void tell_readers();

  Sorting& sorting_;
  Feeling& feeling_;
  QTimer timer_;
  std::optional<std::size_t> dragged_;  // a key
  int dragged_pile_ = 0;
  QPointF pressed_at_, dragged_to_;
  glm::dvec2 from_{0}, grip_{0};  // m, where the key lay, and from there to the mouse
};

/// Makes screen readers meet the keys of sorting tables as items of a list. Once per process.
void use_sorting_access();

}  // namespace sandpaper
