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
constexpr float least_arrow = 0.005f;      // N
constexpr double grid_strength = 0.27;     // of its lines, where the ground has the rest
constexpr std::size_t most_covers = 4000000;  // pairs of patches of which one may cover the other's marks
constexpr std::size_t most_small_numbers = 200;  // more would lie on each other
constexpr int live_milliseconds = 100;        // between pictures of a surface that remembers

QColor mixed(QColor a, QColor b, double share) {
  const auto part = [&](int of_a, int of_b) { return static_cast<int>(std::lround(of_a + share * (of_b - of_a))); };
  return QColor(part(a.red(), b.red()), part(a.green(), b.green()), part(a.blue(), b.blue()));
}

}  // namespace

Canvas::Canvas(Document& document, Feeling& feeling, Pictures& pictures, const Numbers& numbers, QWidget* parent)
    : QWidget(parent), document_(document), feeling_(feeling), pictures_(pictures), numbers_(numbers), marks_(feeling) {
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
  connect(&feeling_, &Feeling::forgot, this, [this] {
    marks_.keep({});
    pictures_.forget_remembered();
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
  still_is_old_ = marked_are_old_ = true;
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
    return draw_label(painter, placed, box);
  }
  const bool is_plain = placed.patch.outline.is_rectangle();
  const QSize pixels = (box.size() * devicePixelRatioF()).toSize();
  QImage image;
  QColor plain = program && !is_blind ? colour_of(placed.patch.made_of) : QColor(190, 190, 190);
  const auto material = program ? nullptr : feeling_.material(placed.id);
  if (material) plain = QColor(230, 160, 160);
  if (program) image = pictures_.remembered(placed.id, *program, parameters_of(placed), glm::vec2(size_of(placed)), look_.surfaces);
  if (program && image.isNull())
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
  painter.setPen(QPen(is_chosen ? palette().color(QPalette::Highlight) : QColor(0, 0, 0, 110), is_chosen ? 2 : 1));
  painter.setBrush(Qt::NoBrush);
  if (is_plain) painter.drawRect(box);
  else if (placed.patch.shape == "ellipse") painter.drawEllipse(box);
  else if (is_chosen) painter.drawRect(box);
  const double reach = feeling_.profile().workspace_diameter / 2;
  const glm::dvec2 far = glm::abs(placed.patch.at) + 0.5 * size_of(placed);
  if (reach > 0 && std::max(far.x, far.y) > reach) {
    painter.setPen(QPen(QColor(200, 60, 0), 2, Qt::DashLine));
    painter.drawRect(box.adjusted(-2, -2, 2, 2));
  }
  draw_label(painter, placed, box);
}

void Canvas::draw_label(QPainter& painter, const Placed& placed, const QRectF& box) {
  const auto [place, text] = label_place(placed, box);
  if (text.isEmpty()) return;
  painter.fillRect(place, QColor(255, 255, 255, 190));
  painter.setPen(Qt::black);
  painter.drawText(place, Qt::AlignCenter, text);
}

std::pair<QRectF, QString> Canvas::label_place(const Placed& placed, const QRectF& box) const {
  if (!look_.names) return {};
  if (box.width() <= 30 || box.height() <= 14) {
    // A participant needs a number for each; it has its place below a small one.
    if (!look_.random_numbers || document_.contents().placed.size() > most_small_numbers) return {};
    const QString number = label_of(placed);
    const QSizeF size(fontMetrics().horizontalAdvance(number) + 4, fontMetrics().height() + 2);
    return {QRectF(box.center().x() - size.width() / 2, box.bottom() + 1, size.width(), size.height()), number};
  }
  const QString whole = placed.locked && !fixed_ ? tr("%1 (locked)").arg(label_of(placed)) : label_of(placed);
  const QString text = fontMetrics().elidedText(whole, Qt::ElideRight, static_cast<int>(box.width() - 6));
  QRectF place(box.left() + 1, box.top() + 2, fontMetrics().horizontalAdvance(text) + 4, fontMetrics().height() + 2);
  if (!placed.patch.outline.is_rectangle())
    place.moveCenter(to_pixels(placed.patch.at + inner_place(placed.patch.outline, size_of(placed))));
  return {place, text};
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
    // Opaque and on whole pixels: Qt hands long transparent lines to other threads, which takes longer than to draw them.
    const QColor faint = mixed(ground, lines, grid_strength);
    for (double x = std::ceil(from.x / step) * step; x < to.x; x += step)
      painter.fillRect(QRect(static_cast<int>(to_pixels({x, 0}).x()), 0, 1, height()), faint);
    for (double y = std::ceil(from.y / step) * step; y < to.y; y += step)
      painter.fillRect(QRect(0, static_cast<int>(to_pixels({0, y}).y()), width(), 1), faint);
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

void Canvas::find_marked() {
  marked_are_old_ = false;
  marked_.clear();
  marks_.keep([&] {
    std::vector<std::uint64_t> ids;
    for (const PlacedRef& each : document_.contents().placed) ids.push_back(each->id);
    return ids;
  }());
  if (!look_.marks || look_.surfaces == Look::blind) return;
  std::vector<std::pair<PlacedRef, QRect>> boxes;  // of what may be seen
  for (const PlacedRef& each : document_.contents().placed) {
    if (!each->is_laid_out()) continue;
    const QRect box = box_of(*each).toAlignedRect();
    if (box.intersects(rect()) && (box.width() >= small || box.height() >= small)) boxes.emplace_back(each, box);
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto& [placed, box] = boxes[i];
    if (!marks_.has(placed->id)) continue;
    QRegion seen(box, placed->patch.shape == "ellipse" ? QRegion::Ellipse : QRegion::Rectangle);
    if (boxes.size() * boxes.size() < most_covers)
      for (std::size_t front = i + 1; front < boxes.size(); ++front)
        if (boxes[front].second.intersects(box)) seen -= boxes[front].second;
    seen -= label_place(*placed, box_of(*placed)).first.toAlignedRect();
    if (!seen.isEmpty()) marked_.push_back({placed, seen});
  }
}

void Canvas::add_cursor(std::vector<MovingShape>& shapes) const {
  const QPointF at = to_pixels(glm::dvec2(now_.position));
  const QPen line(Qt::black, 2);
  const QColor light(255, 255, 255, 200);
  const auto round = [&](QPointF middle, double radius, QPen pen, QBrush brush) {
    MovingShape shape{.pen = std::move(pen), .brush = std::move(brush)};
    shape.path.addEllipse(middle, radius, radius);
    shapes.push_back(std::move(shape));
  };
  switch (look_.cursor) {
    case Cursor::hidden: return;
    case Cursor::drop_shadow: round(at + QPointF(4, 5), 9, Qt::NoPen, QColor(0, 0, 0, 90)); [[fallthrough]];
    case Cursor::ring: round(at, 7, line, light); break;
    case Cursor::square:
      shapes.push_back({.pen = line, .brush = light});
      shapes.back().path.addRect(at.x() - 6, at.y() - 6, 12, 12);
  }
}

void Canvas::add_arrow(std::vector<MovingShape>& shapes) const {
  const wale::Force force = now_.force;
  if (!look_.force || feeling_.profile().shaker || std::hypot(force.x, force.y) <= least_arrow) return;
  const QPointF from = to_pixels(glm::dvec2(now_.position));
  const QPointF to = from + QPointF(force.x, -force.y) * arrow_per_newton * scale_;
  MovingShape shape{.pen = QPen(QColor(200, 30, 30), 3, Qt::SolidLine, Qt::RoundCap)};
  shape.path.moveTo(from);
  shape.path.lineTo(to);
  const double angle = std::atan2(to.y() - from.y(), to.x() - from.x());
  for (const double turn : {2.6, -2.6}) {
    shape.path.moveTo(to);
    shape.path.lineTo(to + 8 * QPointF(std::cos(angle + turn), std::sin(angle + turn)));
  }
  shapes.push_back(std::move(shape));
}

QRegion Canvas::follow_moving() {
  const bool is_on = feeling_.is_on();
  if (!is_on && !was_on_ && !marked_are_old_) return {};
  was_on_ = is_on;
  if (marked_are_old_) find_marked();
  std::vector<MovingShape> next;
  if (is_on && look_.cursor_behind) add_cursor(next);
  const auto to_pixels = [this](glm::dvec2 metres) { return this->to_pixels(metres); };
  for (const auto& [placed, seen] : marked_) {
    const bool is_touched = is_on && touched_ == placed->id;
    for (MovingShape& each : marks_.shapes(*placed, glm::vec2(size_of(*placed)), now_, is_touched, to_pixels, scale_)) {
      if (!is_touched) each.within = seen;
      next.push_back(std::move(each));
    }
  }
  if (is_on && !look_.cursor_behind) add_cursor(next);
  if (is_on) add_arrow(next);
  QRegion changed;
  for (std::size_t i = 0; i < std::max(next.size(), moving_shapes_.size()); ++i) {
    const MovingShape* before = i < moving_shapes_.size() ? &moving_shapes_[i] : nullptr;
    const MovingShape* now = i < next.size() ? &next[i] : nullptr;
    if (before && now && *before == *now) continue;
    if (before) changed += before->region();
    if (now) changed += now->region();
  }
  moving_shapes_ = std::move(next);
  return changed;
}

void Canvas::draw_moving(QPainter& painter, const QRegion& where) {
  painter.setRenderHint(QPainter::Antialiasing);
  for (const MovingShape& each : moving_shapes_)
    if (where.intersects(each.region())) each.draw(painter);
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

void Canvas::paintEvent(QPaintEvent* event) {
  if (still_is_old_ || still_.size() != size() * devicePixelRatioF()) draw_still();
  if (marked_are_old_) follow_moving();  // all is painted now
  QPainter painter(this);
  painter.drawPixmap(0, 0, still_);  // as much of it as the event asks for
  draw_moving(painter, event->region());
}

void Canvas::draw_remembered() {
  if (!feeling_.is_on() || !touched_ || (last_live_.isValid() && last_live_.elapsed() < live_milliseconds)) return;
  if (look_.surfaces != Look::relief && look_.surfaces != Look::depth) return;
  const wale::Program* program = feeling_.program(*touched_);
  const Placed* placed = document_.contents().find(*touched_);
  if (!placed || !program || !surface_remembers(program->description())) return;
  auto snapshot = feeling_.snapshot(*touched_);
  if (!snapshot) return;
  last_live_.start();
  pictures_.draw_remembered(placed->id, *std::move(snapshot), parameters_of(*placed), placed->patch.outline,
                            (box_of(*placed).size() * devicePixelRatioF()).toSize(), look_.surfaces,
                            colour_of(placed->patch.made_of));
}

void Canvas::refresh() {
  now_ = feeling_.now();
  auto touched = feeling_.touched(now_);
  if (!feeling_.is_on() && mouse_)
    if (const Placed* under = patch_at(*mouse_)) touched = under->id;
  if (touched != touched_) {
    touched_ = touched;
    emit touched_changed();
  }
  draw_remembered();
  if (const QRegion changed = follow_moving(); !changed.isEmpty()) update(changed);
}

}  // namespace sandpaper
