#include "panels/slider_row.hpp"

#include <QGridLayout>
#include <QMenu>
#include <QPainter>
#include <QSignalBlocker>
#include <QStyle>
#include <QStyleOptionSlider>
#include <algorithm>
#include <cmath>

namespace sandpaper {
namespace {

constexpr int longest_words = 200;

}  // namespace

MarkedSlider::MarkedSlider(QWidget* parent) : QSlider(Qt::Horizontal, parent) {
  setRange(0, steps);
  setPageStep(steps / 10);
  setSingleStep(steps / 100);
}

void MarkedSlider::set_marks(std::optional<double> low, std::optional<double> high) {
  low_ = low, high_ = high;
  update();
}

void MarkedSlider::paintEvent(QPaintEvent* event) {
  if (low_ || high_) {
    QStyleOptionSlider option;
    initStyleOption(&option);
    const QRect groove = style()->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderGroove, this);
    const int handle = style()->pixelMetric(QStyle::PM_SliderLength, &option, this);
    const double width = groove.width() - handle;
    const double from = groove.left() + handle / 2.0 + std::clamp(low_.value_or(0), 0.0, 1.0) * width;
    const double to = groove.left() + handle / 2.0 + std::clamp(high_.value_or(1), 0.0, 1.0) * width;
    QPainter painter(this);
    QColor colour = palette().color(QPalette::Highlight);
    colour.setAlpha(80);
    painter.fillRect(QRectF(from, 1, std::max(2.0, to - from), height() - 2), colour);
  }
  QSlider::paintEvent(event);
}

SliderRow::SliderRow(const wale::Parameter& parameter, bool is_percept, float value, float default_value,
                     QWidget* parent)
    : QWidget(parent),
      parameter_(parameter),
      is_percept_(is_percept),
      value_(value),
      default_(default_value),
      name_(new QLabel(QString::fromStdString(parameter.name))),
      slider_(new MarkedSlider),
      number_(new QDoubleSpinBox),
      reset_(new QToolButton),
      mark_(new QToolButton),
      says_(new QLineEdit) {
  const QString name = QString::fromStdString(parameter.name), unit = QString::fromStdString(parameter.unit);
  const QString says = QString::fromStdString(parameter.description);
  if (is_percept) {
    QFont font = name_->font();
    font.setBold(true);
    name_->setFont(font);
  }
  name_->setToolTip(says);
  slider_->setAccessibleName(name);
  slider_->setAccessibleDescription(says);
  slider_->setObjectName("slider_" + name);
  number_->setObjectName("number_" + name);
  const double factor = parameter.unit_in_si == 0 ? 1 : parameter.unit_in_si;
  const double span = (parameter.soft_high - parameter.soft_low) / factor;
  const int decimals = span > 0 ? std::clamp(static_cast<int>(std::ceil(3 - std::log10(span))), 0, 9) : 4;
  number_->setDecimals(decimals);
  number_->setRange(parameter.low / factor, parameter.high / factor);
  number_->setSingleStep(span > 0 ? span / 100 : 0.01);
  if (!unit.isEmpty()) number_->setSuffix(" " + unit);
  number_->setAccessibleName(tr("%1, exactly").arg(name));
  number_->setKeyboardTracking(false);
  reset_->setText("⟲");
  reset_->setToolTip(tr("Back to what the material gives"));
  reset_->setAccessibleName(tr("Reset %1").arg(name));
  mark_->setText("◆");
  mark_->setPopupMode(QToolButton::InstantPopup);
  mark_->setAccessibleName(tr("Mark %1").arg(name));
  mark_->setToolTip(tr("Mark from where to where it still feels alike"));
  auto* menu = new QMenu(mark_);
  menu->addAction(tr("From here on"), this, [this] { emit mark_wanted(false); });
  menu->addAction(tr("Up to here"), this, [this] { emit mark_wanted(true); });
  menu->addAction(tr("Remove the mark"), this, [this] { emit unmark_wanted(); });
  mark_->setMenu(menu);
  says_->setObjectName("says_" + name);
  says_->setPlaceholderText(tr("it still feels like …"));
  says_->setAccessibleName(tr("What %1 still feels like within its marks").arg(name));
  says_->setMaxLength(longest_words);
  says_->hide();
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(2, 2, 2, 2);
  layout->setVerticalSpacing(0);
  layout->addWidget(name_, 0, 0);
  layout->addWidget(number_, 0, 1);
  layout->addWidget(mark_, 0, 2);
  layout->addWidget(reset_, 0, 3);
  layout->addWidget(slider_, 1, 0, 1, 4);
  layout->addWidget(says_, 2, 0, 1, 4);
  layout->setColumnStretch(0, 1);
  connect(slider_, &QSlider::valueChanged, this, [this](int step) {
    const double share = static_cast<double>(step) / MarkedSlider::steps;
    value_ = static_cast<float>(parameter_.soft_low + share * (parameter_.soft_high - parameter_.soft_low));
    const QSignalBlocker quiet(number_);
    number_->setValue(value_ / (parameter_.unit_in_si == 0 ? 1 : parameter_.unit_in_si));
    reset_->setEnabled(value_ != default_);
    emit moved(value_, !slider_->isSliderDown());
  });
  connect(slider_, &QSlider::sliderReleased, this, [this] { emit moved(value_, true); });
  connect(number_, &QDoubleSpinBox::valueChanged, this, [this](double shown) {
    value_ = static_cast<float>(shown * parameter_.unit_in_si);
    const QSignalBlocker quiet(slider_);
    slider_->setValue(step_of(value_));
    reset_->setEnabled(value_ != default_);
    emit moved(value_, true);
  });
  connect(reset_, &QToolButton::clicked, this, &SliderRow::reset_wanted);
  connect(says_, &QLineEdit::editingFinished, this, [this] {
    if (says_->isModified()) emit says_wanted(says_->text());
    says_->setModified(false);
  });
  show_value();
}

int SliderRow::step_of(float value) const {
  const double span = parameter_.soft_high - parameter_.soft_low;
  if (span <= 0) return 0;
  return static_cast<int>(
      std::lround(std::clamp((value - parameter_.soft_low) / span, 0.0, 1.0) * MarkedSlider::steps));
}

void SliderRow::set_value(float value) {
  if (value == value_ || slider_->isSliderDown()) return;
  value_ = value;
  show_value();
}

void SliderRow::show_value() {
  const QSignalBlocker quiet_slider(slider_), quiet_number(number_);
  slider_->setValue(step_of(value_));
  number_->setValue(value_ / (parameter_.unit_in_si == 0 ? 1 : parameter_.unit_in_si));
  reset_->setEnabled(value_ != default_);
}

void SliderRow::set_marks(std::optional<float> low, std::optional<float> high, const QString& says) {
  const double span = parameter_.soft_high - parameter_.soft_low;
  const auto share = [&](std::optional<float> end) -> std::optional<double> {
    if (!end || span <= 0) return std::nullopt;
    return (*end - parameter_.soft_low) / span;
  };
  slider_->set_marks(share(low), share(high));
  says_->setVisible(low || high);
  if (!says_->hasFocus() || !says_->isModified()) says_->setText(says);
  slider_->setToolTip(low || high ? tr("marked: %1").arg(says.isEmpty() ? tr("it still feels like this") : says)
                                  : QString());
}

}  // namespace sandpaper
