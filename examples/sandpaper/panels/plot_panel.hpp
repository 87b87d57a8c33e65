#pragma once

#include <QWidget>
#include <deque>
#include <wale/run.hpp>

namespace sandpaper {

/// Position, force and lateness of the last ten seconds, scrolling. In the window's thread.
class PlotPanel : public QWidget {
  Q_OBJECT

 public:
  explicit PlotPanel(QWidget* parent = nullptr);

  /// The state of the run at one picture. Nothing is added while it stands still.
  void add(const wale::Now& now);

 protected:
  void paintEvent(QPaintEvent* event) override;
  QSize sizeHint() const override { return {400, 220}; }

 private:
  struct Sample {
    double time = 0;
    float x = 0, y = 0, force_x = 0, force_y = 0, lateness = 0;
  };
  std::deque<Sample> samples_;
};

}  // namespace sandpaper
