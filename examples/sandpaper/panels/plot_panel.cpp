#include "panels/plot_panel.hpp"

#include <QPainter>
#include <algorithm>
#include <array>
#include <cmath>

namespace sandpaper {
namespace {

constexpr double shown_seconds = 10;

/// The round number (1, 2 or 5 times a power of ten) at or above x.
double round_above(double x) {
  const double power = std::pow(10, std::floor(std::log10(std::max(x, 1e-9))));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= x) return factor * power;
  return 10 * power;
}

}  // namespace

PlotPanel::PlotPanel(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(120);
  setAccessibleName(tr("Position, force and lateness of the last ten seconds"));
}

void PlotPanel::add(const wale::Now& now) {
  if (!samples_.empty() && now.time == samples_.back().time) return;
  if (!samples_.empty() && now.time < samples_.back().time) samples_.clear();  // another run
  samples_.push_back({now.time, 1000 * now.position.x, 1000 * now.position.y, now.force.x, now.force.y,
                      static_cast<float>(1000 * now.lateness)});
  while (now.time - samples_.front().time > shown_seconds) samples_.pop_front();
  if (isVisible()) update();
}

void PlotPanel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  painter.setRenderHint(QPainter::Antialiasing);
  struct Row {
    QString name;
    std::array<float Sample::*, 2> of;
    double least;  // of the scale
  };
  const std::array<Row, 3> rows = {{{tr("position, mm"), {&Sample::x, &Sample::y}, 10},
                                    {tr("force, N"), {&Sample::force_x, &Sample::force_y}, 0.5},
                                    {tr("lateness, ms"), {&Sample::lateness, nullptr}, 0.1}}};
  const double high = height() / 3.0, end = samples_.empty() ? 0 : samples_.back().time;
  const QColor colours[] = {QColor(30, 100, 200), QColor(210, 110, 0)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const QRectF box(0, i * high, width(), high);
    double most = rows[i].least;
    for (const Sample& each : samples_)
      for (const auto of : rows[i].of)
        if (of && std::isfinite(each.*of)) most = std::max(most, std::abs(static_cast<double>(each.*of)));
    most = round_above(most);
    painter.setPen(palette().color(QPalette::Mid));
    painter.drawLine(box.bottomLeft(), box.bottomRight());
    painter.drawLine(QPointF(0, box.center().y()), QPointF(width(), box.center().y()));
    for (std::size_t j = 0; j < 2; ++j) {
      if (!rows[i].of[j]) continue;
      QPolygonF line;
      for (const Sample& each : samples_) {
        const float value = each.*rows[i].of[j];
        if (std::isfinite(value))
          line << QPointF(width() * (1 - (end - each.time) / shown_seconds),
                          box.center().y() - value / most * (high / 2 - 2));
      }
      painter.setPen(QPen(colours[j], 1.5));
      painter.drawPolyline(line);
    }
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(box.adjusted(4, 2, -4, -2), Qt::AlignTop | Qt::AlignLeft, rows[i].name);
    if (rows[i].of[1]) {  // which line is which
      int at = 4 + painter.fontMetrics().horizontalAdvance(rows[i].name + "   ");
      for (int axis = 0; axis < 2; ++axis) {
        painter.setPen(colours[axis]);
        painter.drawText(box.adjusted(at, 2, -4, -2), Qt::AlignTop | Qt::AlignLeft, axis == 0 ? "x" : "y");
        at += painter.fontMetrics().horizontalAdvance("y   ");
      }
      painter.setPen(palette().color(QPalette::Text));
    }
    painter.drawText(box.adjusted(4, 2, -4, -2), Qt::AlignTop | Qt::AlignRight, QString("±%1").arg(most));
  }
}

}  // namespace sandpaper
