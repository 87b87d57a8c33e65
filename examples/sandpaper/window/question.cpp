#include "window/question.hpp"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

namespace sandpaper {
namespace {

QWidget* number_of(const Question::Field& field) {
  auto* number = new QDoubleSpinBox;
  number->setDecimals(field.decimals);
  number->setRange(field.least, field.most);
  number->setValue(field.value);
  number->setSuffix(field.unit.isEmpty() ? QString() : " " + field.unit);
  return number;
}

QWidget* choice_of(const Question::Field& field) {
  auto* choice = new QComboBox;
  choice->addItems(field.choices);
  return choice;
}

}  // namespace

Question::Question(QWidget* parent)
    : QFrame(parent), words_(new QLabel), row_(new QHBoxLayout), button_(new QPushButton) {
  setFrameShape(QFrame::StyledPanel);
  setObjectName("question");
  words_->setWordWrap(true);
  words_->setTextFormat(Qt::PlainText);
  button_->setObjectName("answer");
  button_->setDefault(true);
  auto* cancel = new QToolButton;
  cancel->setText(tr("Cancel"));
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(8, 4, 4, 4);
  all->addWidget(words_);
  row_->addStretch(1);
  row_->addWidget(button_);
  row_->addWidget(cancel);
  all->addLayout(row_);
  connect(button_, &QPushButton::clicked, this, &Question::answer);
  connect(cancel, &QToolButton::clicked, this, &QWidget::hide);
  hide();
}

void Question::ask(const QString& words, const std::vector<Field>& fields, const QString& button,
                   const std::function<void(const std::vector<double>&)>& answered) {
  // The key that is being handled may be of one of them.
  const auto put_away = [](QWidget* each) {
    each->hide();
    each->setObjectName({});
    each->deleteLater();
  };
  std::ranges::for_each(labels_, put_away);
  std::ranges::for_each(numbers_, put_away);
  labels_.clear(), numbers_.clear();
  words_->setText(words);
  setAccessibleName(words);
  button_->setText(button);
  answered_ = answered;
  int at = 0;
  for (const Field& field : fields) {
    auto* label = new QLabel(field.label);
    QWidget* number = field.choices.isEmpty() ? number_of(field) : choice_of(field);
    number->setObjectName(QString("question_%1").arg(numbers_.size()));
    number->setAccessibleName(QString(field.label).remove('&'));
    label->setBuddy(number);
    row_->insertWidget(at++, label);
    row_->insertWidget(at++, number);
    labels_.push_back(label), numbers_.push_back(number);
  }
  show();
  if (!numbers_.empty()) {
    numbers_.front()->setFocus();
    if (auto* number = qobject_cast<QDoubleSpinBox*>(numbers_.front())) number->selectAll();
  }
}

void Question::answer() {
  if (isHidden()) return;
  std::vector<double> values;
  for (QWidget* each : numbers_)
    if (auto* number = qobject_cast<QDoubleSpinBox*>(each)) {
      number->interpretText();
      values.push_back(number->value());
    } else {
      values.push_back(qobject_cast<QComboBox*>(each)->currentIndex());
    }
  hide();
  const auto answered = answered_;  // it may ask the next question
  if (answered) answered(values);
}

void Question::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return hide();
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) return answer();
  QFrame::keyPressEvent(event);
}

}  // namespace sandpaper
