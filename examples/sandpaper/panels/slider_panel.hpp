#pragma once

#include <QLabel>
#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>
#include <optional>

#include "document/document.hpp"
#include "feeling/feeling.hpp"
#include "panels/slider_row.hpp"

namespace sandpaper {

/// The sliders of the chosen patch, or else of the touched one: percepts first, then parameters, then weights. In the
/// window's thread.
class SliderPanel : public QWidget {
  Q_OBJECT

 public:
  SliderPanel(Document& document, Feeling& feeling, QWidget* parent = nullptr);

  /// The hand is on another patch, or on none. The panel waits for a quarter of a second before it follows (Minsky
  /// 1995, Appendix B), so that a hand that passes over a patch does not change it.
  void set_touched(std::optional<std::uint64_t> id);
  /// The patch whose sliders are shown.
  std::optional<std::uint64_t> shown() const { return shown_; }

 signals:
  void shown_changed();

 private:
  void follow();
  void rebuild();
  void refresh();
  void moved(const SliderRow& row, float value, bool is_final);
  void reset(const SliderRow& row);
  void mark(const SliderRow& row, std::optional<bool> high);
  void say(const SliderRow& row, const QString& says);

  Document& document_;
  Feeling& feeling_;
  QTimer waiting_;
  std::optional<std::uint64_t> touched_, shown_;
  const void* program_ = nullptr;  // of which the rows are
  QLabel* title_;
  QScrollArea* area_;
  std::vector<SliderRow*> rows_;
};

}  // namespace sandpaper
