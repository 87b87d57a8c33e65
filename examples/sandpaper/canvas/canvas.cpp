#include "canvas/canvas.hpp"

#include "canvas/canvas_access.hpp"

#include <QAccessible>
#include <QEvent>
#include <QPainter>
#include <QPaintEvent>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <wale/picture.hpp>

namespace sandpaper {
namespace {

constexpr int picture_milliseconds = 16;
constexpr double margin = 1.08;        // how much more than the workspace is shown
constexpr double least_scale = 100, most_scale = 200000;
constexpr double usual_side = 0.04;    // m, of a patch whose program is not known yet
constexpr int view_rests_milliseconds = 150;
constexpr int small = 12;              // pixels: smaller patches are drawn plain
constexpr int largest_mask = 2048;     // pixels
constexpr double arrow_per_newton = 0.01;  // m

}  // namespace

Canvas::Canvas(Document& document, Feeling& feeling, Pictures& pictures, const Numbers& numbers, QWidget* parent)
    : QWidget(parent), document_(document), feeling_(feeling), pictures_(pictures), numbers_(numbers) {
  use_canvas_access();
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setAcceptDrops(true);
  setMinimumSize(200, 150);
  setAccessibleName(tr("Workspace"));
  setAttribute(Qt::WA_OpaquePaintEvent);
  for (auto signal : {&Document::contents_changed, &Document::chosen_changed})
    connect(&document_, signal, this, &Canvas::changed);
  connect(&document_, &Document::chosen_changed, this, &Canvas::tell_readers);
  connect(&feeling_, &Feeling::programs_changed, this, &Canvas::changed);
  connect(&feeling_, &Feeling::device_changed, this, [this] {
    if (shows_all_) show_all();
    changed();
  });
  connect(&pictures_, &Pictures::drawn, this, &Canvas::changed);
  connect(&numbers_, &Numbers::renewed, this, &Canvas::changed);
  connect(&timer_, &QTimer::timeout, this, &Canvas::refresh);
  moving_.setSingleShot(true);
  connect(&moving_, &QTimer::timeout, this, &Canvas::changed);
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.start(picture_milliseconds);
}

void Canvas::set_look(const CanvasLook& look) {
  look_ = look;
  changed();
}

void Canvas::tell_readers() {
  if (!QAccessible::isActive() || fixed_) return;  // nobody chooses where all is fixed
  if (document_.chosen().size() == 1)
    if (auto* self = QAccessible::queryAccessibleInterface(this))
      for (int i = 0; i < self->childCount(); ++i)
        if (document_.contents().placed[static_cast<std::size_t>(i)]->id == *document_.chosen().begin()) {
          QAccessibleEvent event(this, QAccessible::Focus);
          event.setChild(i);
          QAccessible::updateAccessibility(&event);
        }
}

void Canvas::changed() {
  still_is_old_ = true;
  update();
}

void Canvas::view_changed() {
  shows_all_ = false;
  moving_.start(view_rests_milliseconds);
  changed();
}

void Canvas::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) changed();
  QWidget::changeEvent(event);
}

QPointF Canvas::to_pixels(glm::dvec2 metres) const {
  return {width() / 2.0 + (metres.x - centre_.x) * scale_, height() / 2.0 - (metres.y - centre_.y) * scale_};
}

glm::dvec2 Canvas::to_metres(QPointF pixels) const {
  return {centre_.x + (pixels.x() - width() / 2.0) / scale_, centre_.y - (pixels.y() - height() / 2.0) / scale_};
}

void Canvas::zoom(double factor, std::optional<QPointF> about) {
  const QPointF fixed = about.value_or(QPointF(width() / 2.0, height() / 2.0));
  const glm::dvec2 before = to_metres(fixed);
  scale_ = std::clamp(scale_ * factor, least_scale, most_scale);
  centre_ += before - to_metres(fixed);
  view_changed();
}

void Canvas::show_all() {
  const double across =
      margin * (feeling_.profile().workspace_diameter > 0 ? feeling_.profile().workspace_diameter : 0.2);
  scale_ = std::clamp(std::min(width(), height()) / across, least_scale, most_scale);
  centre_ = {0, 0};
  shows_all_ = true;
  changed();
}

void Canvas::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (shows_all_) show_all();
  changed();
}

glm::dvec2 Canvas::size_of(const Placed& placed) const {
  if (placed.patch.size) return *placed.patch.size;
  const wale::Shape& outline = placed.patch.outline;
  if (!outline.is_rectangle() && placed.patch.shape != "ellipse") return outline.size();
  if (const wale::Program* program = feeling_.program(placed.id))
    return {program->default_size().width, program->default_size().height};
  return glm::dvec2(usual_side);
}

QRectF Canvas::box_of(const Placed& placed) const {
  const glm::dvec2 half = 0.5 * size_of(placed);
  return QRectF(to_pixels({placed.patch.at.x - half.x, placed.patch.at.y + half.y}),
                to_pixels({placed.patch.at.x + half.x, placed.patch.at.y - half.y}));
}

const Placed* Canvas::patch_at(glm::dvec2 metres) const {
  const auto& all = document_.contents().placed;
  for (std::size_t i = all.size(); i-- > 0;) {
    const Placed& each = *all[i];
    if (!each.is_laid_out()) continue;
    const glm::dvec2 from = metres - each.patch.at, half = 0.5 * size_of(each);
    if (std::abs(from.x) < half.x && std::abs(from.y) < half.y &&
        each.patch.outline.contains(glm::vec2(from), glm::vec2(2.0 * half)))
      return &each;
  }
  return nullptr;
}

QString Canvas::label_of(const Placed& placed) const {
  return look_.random_numbers ? numbers_.of(placed) : QString::fromStdString(placed.patch.name);
}

QString Canvas::told_of(const Placed& placed) const {
  return look_.random_numbers
             ? label_of(placed)
             : tr("%1, made of %2").arg(label_of(placed), QString::fromStdString(placed.patch.made_of));
}

QImage Canvas::covered_part(const Placed& placed, QSize pixels) {
  pixels = pixels.expandedTo({1, 1}).boundedTo(QSize(largest_mask, largest_mask));
  const wale::Shape outline = placed.patch.outline.stretched(glm::vec2(size_of(placed)));
  const glm::vec2 size(size_of(placed));
  const QString key = QString("%1|%2|%3|%4|%5").arg(reinterpret_cast<quintptr>(placed.patch.outline.identity()))
                          .arg(pixels.width()).arg(pixels.height()).arg(size.x).arg(size.y);
  if (const QImage* known = covered_.object(key)) return *known;
  auto* image = new QImage(pixels, QImage::Format_Alpha8);
  const float per_metre = pixels.width() / size.x;
  for (int row = 0; row < pixels.height(); ++row) {
    uchar* line = image->scanLine(row);
    for (int column = 0; column < pixels.width(); ++column) {
      const glm::vec2 at{((column + 0.5f) / pixels.width() - 0.5f) * size.x,
                         (0.5f - (row + 0.5f) / pixels.height()) * size.y};
      line[column] = static_cast<uchar>(255 * std::clamp(0.5f + outline.edge(at).metres * per_metre, 0.f, 1.f));
    }
  }
  const QImage covered = *image;
  covered_.insert(key, image, static_cast<int>(image->sizeInBytes() / 1024) + 1);
  return covered;
}

std::vector<float> Canvas::parameters_of(const Placed& placed) const {
  std::vector<float> parameters;
  if (const wale::Program* program = feeling_.program(placed.id))
    for (const wale::Parameter& each : program->description().parameters)
      parameters.push_back(feeling_.value(placed, each));
  return parameters;
}

void Canvas::draw_patch(QPainter& painter, const Placed& placed) {
  const QRectF box = box_of(placed);
  if (!box.intersects(QRectF(rect()))) return;
  const wale::Program* program = feeling_.program(placed.id);
  const bool is_chosen = !fixed_ && document_.chosen().contains(placed.id);
  // All alike: a colour would tell which patches are made of the same.
  const bool is_blind = look_.surfaces == Look::blind;
  if (box.width() < small && box.height() < small) {
    painter.fillRect(box.toAlignedRect(), is_chosen  ? palette().color(QPalette::Highlight)
                                          : program && !is_blind ? colour_of(placed.patch.made_of)
                                                                 : QColor(Qt::gray));
    return;
  }
  const bool is_plain = placed.patch.outline.is_rectangle();
  const QSize pixels = (box.size() * devicePixelRatioF()).toSize();
  QImage image;
  QColor plain = program && !is_blind ? colour_of(placed.patch.made_of) : QColor(190, 190, 190);
  const auto material = program ? nullptr : feeling_.material(placed.id);
  if (material) plain = QColor(230, 160, 160);
  if (program)
    image = pictures_.find(*program, parameters_of(placed), glm::vec2(size_of(placed)), placed.patch.outline, pixels,
                           look_.surfaces, plain, is_chosen ? 2 : 1);
  if (is_plain) {
    if (image.isNull()) painter.fillRect(box, plain);
    else painter.drawImage(box, image);
  } else {
    QImage shown(pixels.expandedTo({1, 1}).boundedTo(QSize(largest_mask, largest_mask)),
                 QImage::Format_ARGB32_Premultiplied);
    shown.fill(plain);
    QPainter inside(&shown);
    inside.setRenderHint(QPainter::SmoothPixmapTransform);
    if (!image.isNull()) inside.drawImage(QRectF(shown.rect()), image);
    inside.setCompositionMode(QPainter::CompositionMode_DestinationIn);
    inside.drawImage(0, 0, covered_part(placed, shown.size()));
    inside.end();
    painter.drawImage(box, shown);
  }
  if (!program && box.width() > 60 && box.height() > 16) {
    painter.setPen(Qt::black);
    QRectF words = box;
    if (!is_plain)  // below the name, and inside: the middle of a polygon's box can lie on another patch
      words.moveCenter(to_pixels(placed.patch.at + inner_place(placed.patch.outline, size_of(placed))) +
                       QPointF(0, 1.2 * fontMetrics().height()));
    painter.drawText(words, Qt::AlignCenter | Qt::TextWordWrap,
                     !material               ? tr("compiling …")
                     : document_.is_stale() ? tr("an error in the text")
                                            : tr("an error in its material"));
  }
  if (!is_blind || is_chosen) {
    painter.setPen(QPen(is_chosen ? palette().color(QPalette::Highlight) : QColor(0, 0, 0, 110), is_chosen ? 2 : 1));
    painter.setBrush(Qt::NoBrush);
    if (is_plain) painter.drawRect(box);
    else if (placed.patch.shape == "ellipse") painter.drawEllipse(box);
    else if (is_chosen) painter.drawRect(box);
  }
  const double reach = feeling_.profile().workspace_diameter / 2;
  const glm::dvec2 far = glm::abs(placed.patch.at) + 0.5 * size_of(placed);
  if (reach > 0 && std::max(far.x, far.y) > reach) {
    painter.setPen(QPen(QColor(200, 60, 0), 2, Qt::DashLine));
    painter.drawRect(box.adjusted(-2, -2, 2, 2));
  }
  if (look_.names && box.width() > 30 && box.height() > 14) {
    const QString label = label_of(placed) + (placed.locked ? QStringLiteral(" 🔒") : QString());
    QRectF place(box.left() + 3, box.top() + 2, box.width() - 6, fontMetrics().height() + 2);
    if (!is_plain) place.moveCenter(to_pixels(placed.patch.at + inner_place(placed.patch.outline, size_of(placed))));
    const int alignment = (is_plain ? Qt::AlignLeft : Qt::AlignHCenter) | Qt::AlignVCenter;
    const QRectF text = painter.boundingRect(place, alignment, label).adjusted(-2, 0, 2, 0);
    painter.fillRect(text.intersected(place.adjusted(-2, 0, 2, 0)), QColor(255, 255, 255, 190));
    painter.setPen(Qt::black);
    painter.drawText(place, alignment,
                     fontMetrics().elidedText(label, Qt::ElideRight, static_cast<int>(place.width())));
  }
}

void Canvas::draw_still() {
  const QSize wanted = size() * devicePixelRatioF();
  if (still_.size() != wanted) {
    still_ = QPixmap(wanted);
    still_.setDevicePixelRatio(devicePixelRatioF());
  }
  const QColor ground = look_.black ? QColor(Qt::black) : palette().color(QPalette::Base);
  const QColor lines = look_.black ? QColor(70, 70, 70) : palette().color(QPalette::Mid);
  still_.fill(ground);
  QPainter painter(&still_);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setRenderHint(QPainter::SmoothPixmapTransform, !moving_.isActive());
  if (look_.grid && !look_.black) {
    // Lines of 1, 5, 10 mm and so on, no closer than 8 pixels.
    double step = 0.001;
    for (int i = 0; step * scale_ < 8; ++i) step *= i % 2 == 0 ? 5 : 2;
    const glm::dvec2 from = to_metres({0.0, double(height())}), to = to_metres({double(width()), 0.0});
    QColor faint = lines;
    faint.setAlpha(70);
    painter.setPen(faint);
    for (double x = std::ceil(from.x / step) * step; x < to.x; x += step)
      painter.drawLine(QPointF(to_pixels({x, 0}).x(), 0), QPointF(to_pixels({x, 0}).x(), height()));
    for (double y = std::ceil(from.y / step) * step; y < to.y; y += step)
      painter.drawLine(QPointF(0, to_pixels({0, y}).y()), QPointF(width(), to_pixels({0, y}).y()));
  }
  const double reach = feeling_.profile().workspace_diameter / 2;
  painter.setPen(QPen(lines, 1.5));
  painter.drawEllipse(to_pixels({0, 0}), reach * scale_, reach * scale_);
  for (const PlacedRef& each : document_.contents().placed)
    if (each->is_laid_out()) draw_patch(painter, *each);
  // The scale bar: a round length of about 80 pixels.
  double bar = 0.001;
  for (int i = 0; bar * scale_ < 60; ++i) bar *= i % 3 == 1 ? 2.5 : 2;
  const QPointF end(width() - 16, height() - 14);
  painter.setPen(QPen(look_.black ? Qt::lightGray : palette().color(QPalette::Text), 2));
  painter.drawLine(end, end - QPointF(bar * scale_, 0));
  painter.drawText(QRectF(end.x() - bar * scale_ - 60, end.y() - 20, bar * scale_ + 60, 16), Qt::AlignRight,
                   tr("%1 mm").arg(std::round(bar * 1e4) / 10));
  still_is_old_ = false;
}

void Canvas::draw_marks(QPainter& painter, const Placed& placed) {
  const auto snapshot = feeling_.snapshot(placed.id);
  if (!snapshot) return;
  const wale::Hand hand{.position = now_.position - glm::vec2(placed.patch.at),
                        .velocity = now_.velocity,
                        .workspace = now_.position,
                        .time = now_.time};
  const auto place = [&](float x, float y) { return to_pixels(placed.patch.at + glm::dvec2(x, y)); };
  painter.setBrush(Qt::NoBrush);
  for (const wale::ShownMark& mark : wale::show(snapshot->bank, snapshot->memory, hand)) {
    const auto& v = mark.values;
    if (!std::ranges::all_of(v, [](float each) { return std::isfinite(each) && std::abs(each) < 10; })) continue;
    const QColor colour = QColor::fromRgb(mark.colour);
    painter.setPen(QPen(colour, 2));
    switch (mark.kind) {
      case wale::MarkKind::point:
        painter.setBrush(colour);
        painter.drawEllipse(place(v[0], v[1]), std::max(1.5, v[2] / 2 * scale_), std::max(1.5, v[2] / 2 * scale_));
        painter.setBrush(Qt::NoBrush);
        break;
      case wale::MarkKind::circle: painter.drawEllipse(place(v[0], v[1]), v[2] * scale_, v[2] * scale_); break;
      case wale::MarkKind::box:
        painter.save();
        painter.translate(place(v[0], v[1]));
        painter.rotate(-v[4] * 180 / 3.14159265358979);
        painter.drawRect(QRectF(-v[2] / 2 * scale_, -v[3] / 2 * scale_, v[2] * scale_, v[3] * scale_));
        painter.restore();
        break;
      case wale::MarkKind::line: painter.drawLine(place(v[0], v[1]), place(v[2], v[3])); break;
      case wale::MarkKind::spring: {
        const QPointF from = place(v[0], v[1]), way = place(v[2], v[3]) - from;
        const double length = std::hypot(way.x(), way.y()), wide = v[4] / 2 * scale_;
        const QPointF square = length > 0 ? QPointF(-way.y(), way.x()) / length * wide : QPointF();
        QPolygonF coils{from};
        for (int i = 1; i < 16; ++i) coils << from + way * i / 16.0 + (i % 2 ? square : -square);
        painter.drawPolyline(coils << from + way);
        break;
      }
      case wale::MarkKind::trajectory: {
        path_.push_back({placed.patch.at.x + v[0], placed.patch.at.y + v[1]});
        const auto most = static_cast<std::size_t>(std::clamp(v[2], 0.f, 30.f) * 60);
        while (path_.size() > most) path_.pop_front();
        QPolygonF way;
        for (const QPointF& each : path_) way << to_pixels({each.x(), each.y()});
        painter.drawPolyline(way);
        break;
      }
    }
  }
}

void Canvas::draw_cursor(QPainter& painter) const {
  const QPointF at = to_pixels(glm::dvec2(now_.position));
  painter.setBrush(Qt::NoBrush);
  switch (look_.cursor) {
    case Cursor::hidden: return;
    case Cursor::drop_shadow:
      painter.setPen(Qt::NoPen);
      painter.setBrush(QColor(0, 0, 0, 90));
      painter.drawEllipse(at + QPointF(4, 5), 9, 9);
      [[fallthrough]];
    case Cursor::ring:
      painter.setBrush(QColor(255, 255, 255, 200));
      painter.setPen(QPen(Qt::black, 2));
      painter.drawEllipse(at, 7, 7);
      break;
    case Cursor::square:
      painter.setBrush(QColor(255, 255, 255, 200));
      painter.setPen(QPen(Qt::black, 2));
      painter.drawRect(QRectF(at.x() - 6, at.y() - 6, 12, 12));
  }
}

void Canvas::draw_moving(QPainter& painter) {
  painter.setRenderHint(QPainter::Antialiasing);
  if (feeling_.is_on() && look_.cursor_behind) draw_cursor(painter);
  if (feeling_.is_on() && look_.marks && touched_)
    if (const Placed* touched = document_.contents().find(*touched_)) draw_marks(painter, *touched);
  if (feeling_.is_on()) {
    if (!look_.cursor_behind) draw_cursor(painter);
    const wale::Force force = now_.force;
    if (look_.force && !feeling_.profile().shaker && std::hypot(force.x, force.y) > 0.005f) {
      const QPointF from = to_pixels(glm::dvec2(now_.position));
      const QPointF to = from + QPointF(force.x, -force.y) * arrow_per_newton * scale_;
      painter.setPen(QPen(QColor(200, 30, 30), 3, Qt::SolidLine, Qt::RoundCap));
      painter.drawLine(from, to);
      const double angle = std::atan2(to.y() - from.y(), to.x() - from.x());
      for (const double turn : {2.6, -2.6})
        painter.drawLine(to, to + 8 * QPointF(std::cos(angle + turn), std::sin(angle + turn)));
    }
  }
  if (drag_ == Drag::choose) {
    painter.setPen(QPen(palette().color(QPalette::Highlight), 1, Qt::DashLine));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(QRectF(pressed_at_, dragged_to_).normalized());
  }
  if (document_.chosen().size() == 1 && !fixed_) {
    painter.setPen(QPen(palette().color(QPalette::Highlight), 1));
    painter.setBrush(palette().color(QPalette::Base));
    for (const QPointF& each : handles()) painter.drawRect(QRectF(each.x() - 3, each.y() - 3, 6, 6));
  }
  if (hasFocus()) {
    painter.setPen(QPen(palette().color(QPalette::Highlight), 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
  }
}

void Canvas::paintEvent(QPaintEvent*) {
  if (still_is_old_ || still_.size() != size() * devicePixelRatioF()) draw_still();
  QPainter painter(this);
  painter.drawPixmap(0, 0, still_);
  draw_moving(painter);
}

void Canvas::refresh() {
  const wale::Now before = now_;
  now_ = feeling_.now();
  auto touched = feeling_.touched(now_);
  if (!feeling_.is_on() && mouse_)
    if (const Placed* under = patch_at(*mouse_)) touched = under->id;
  if (touched != touched_) {
    touched_ = touched;
    path_.clear();
    emit touched_changed();
    update();
  } else if (feeling_.is_on() && (now_.position != before.position || now_.force != before.force)) {
    update();
  }
}

}  // namespace sandpaper
