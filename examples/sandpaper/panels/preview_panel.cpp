#include "panels/preview_panel.hpp"

#include <QPainter>
#include <algorithm>
#include <utility>

namespace sandpaper {
namespace {

constexpr int before_drawing = 300;               // ms without a change, as while a slider is dragged
constexpr int least_side = 100, most_side = 560;  // pixels of a picture
constexpr int gap = 6;                            // pixels

}  // namespace

void PreviewSheet::show(std::vector<PreviewPicture> pictures, const QString& words) {
  pictures_ = std::move(pictures);
  words_ = words;
  QStringList told;
  for (const PreviewPicture& each : pictures_) told << (each.title.isEmpty() ? each.name : each.title);
  setAccessibleDescription(pictures_.empty() ? words : told.join(", "));
  fit(room_);
}

void PreviewSheet::fit(QSize room) {
  room_ = room;
  boxes_.clear();
  const bool is_low = room.width() > 2 * room.height();
  int x = gap, y = gap;
  for (const PreviewPicture& each : pictures_) {
    const double ratio = static_cast<double>(each.image.width()) / std::max(1, each.image.height());
    if (is_low) {
      const int high = std::clamp(room.height() - 2 * gap, least_side, most_side);
      boxes_.emplace_back(x, gap, static_cast<int>(high * ratio), high);
      x = boxes_.back().right() + gap;
    } else {
      const int wide = std::clamp(room.width() - 2 * gap, least_side, std::min(most_side, each.image.width()));
      boxes_.emplace_back(gap, y, wide, static_cast<int>(wide / ratio));
      y = boxes_.back().bottom() + gap;
    }
  }
  QRect all;
  for (const QRect& each : boxes_) all |= each;
  resize(room.expandedTo({all.right() + gap, all.bottom() + gap}));
  update();
}

void PreviewSheet::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.fillRect(rect(), pictures_.empty() ? palette().color(QPalette::Base) : QColor(Qt::white));
  if (pictures_.empty()) {
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(rect().adjusted(8, 8, -8, -8), Qt::AlignCenter | Qt::TextWordWrap, words_);
    return;
  }
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const QRect& box = boxes_[i];
    // Scaled before it is painted, so that thin lines stay.
    QImage shown =
        pictures_[i].image.scaled(box.size() * devicePixelRatioF(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    painter.drawImage(box, shown);
  }
}

PreviewPanel::PreviewPanel(const wale::LanguageService& language, QWidget* parent)
    : QScrollArea(parent), language_(language), sheet_(new PreviewSheet) {
  setObjectName("preview");
  sheet_->setAccessibleName(tr("Preview"));
  setFrameShape(QFrame::NoFrame);
  setMinimumSize(160, 120);
  setWidget(sheet_);
  sheet_->show({}, tr("Choose or touch a patch."));
  waiting_.setSingleShot(true);
  waiting_.setInterval(before_drawing);
  connect(&waiting_, &QTimer::timeout, this, &PreviewPanel::draw);
}

bool PreviewPanel::alike(const std::optional<wale::PlacedProgram>& a, const std::optional<wale::PlacedProgram>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return &a->program.decoded() == &b->program.decoded() && a->parameters == b->parameters &&
         a->size.width == b->size.width && a->size.height == b->size.height && a->size.rim == b->size.rim;
}

void PreviewPanel::show(const QString& name, std::optional<wale::PlacedProgram> what) {
  name_ = name;
  setAccessibleDescription(name);
  if (alike(what, wanted_)) return;
  wanted_ = std::move(what);
  if (!wanted_) {
    waiting_.stop();
    drawn_.reset();
    return sheet_->show({}, tr("Choose or touch a patch."));
  }
  if (isVisible()) waiting_.start();
}

void PreviewPanel::showEvent(QShowEvent* event) {
  QScrollArea::showEvent(event);
  if (!alike(wanted_, drawn_)) waiting_.start();
}

void PreviewPanel::resizeEvent(QResizeEvent* event) {
  QScrollArea::resizeEvent(event);
  sheet_->fit(viewport()->size());
}

void PreviewPanel::draw() {
  if (!wanted_ || !isVisible() || alike(wanted_, drawn_)) return;
  if (pictures().empty()) sheet_->show({}, tr("drawing …"));
  thread_.post(0, "preview", [this, what = *wanted_] {
    const auto parts = language_.preview_parts(what.program, what.parameters, what.size);
    std::vector<PreviewPicture> pictures;
    if (parts)
      for (const wale::PreviewPart& each : *parts)
        pictures.push_back({QString::fromStdString(each.name), QString::fromStdString(each.title),
                            QImage::fromData(reinterpret_cast<const uchar*>(each.png.data()),
                                             static_cast<int>(each.png.size()))});
    const QString why = parts ? QString() : QString::fromStdString(wale::in_words(parts.error()));
    window_.post([this, what, pictures, why] {
      if (!alike(what, wanted_)) return;
      drawn_ = what;
      sheet_->show(pictures, why);
    });
  });
}

}  // namespace sandpaper
