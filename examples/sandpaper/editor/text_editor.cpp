#include "editor/text_editor.hpp"

#include <QVBoxLayout>
#include <algorithm>

namespace sandpaper {
namespace {

constexpr int typing_pause = 400;     // ms without a key, after which the text is taken over
constexpr int most_listed = 200;
constexpr int most_height = 110;      // pixels of the list of problems
constexpr int following_pause = 150;  // ms after a change on the canvas

}  // namespace

TextEditor::TextEditor(Document& document, const wale::LanguageService& language, QWidget* parent)
    : QWidget(parent), document_(document), field_(new TextField(language)), problems_(new QListWidget) {
  problems_->setWordWrap(true);
  problems_->setAccessibleName(tr("Problems in the text"));
  problems_->setObjectName("problems");
  field_->setObjectName("text");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  layout->addWidget(field_);
  layout->addWidget(problems_);
  pause_.setSingleShot(true);
  following_.setSingleShot(true);
  connect(field_, &QPlainTextEdit::textChanged, this, [this] {
    if (is_own_change_) return;
    is_typed_ = true;
    pause_.start(typing_pause);
    emit typing();
  });
  connect(&pause_, &QTimer::timeout, this, &TextEditor::commit);
  connect(&following_, &QTimer::timeout, this, &TextEditor::follow);
  connect(&document_, &Document::contents_changed, this, [this] {
    if (!is_typed_) following_.start(following_pause);
  });
  connect(&document_, &Document::file_changed, this, [this] {
    field_->set_file(document_.file().toStdString());
    if (!is_typed_) following_.start(0);
  });
  connect(&document_, &Document::loaded, this, [this] {
    pause_.stop();
    is_typed_ = false, is_own_change_ = true;
    field_->set_file(document_.file().toStdString());
    field_->setPlainText(QString::fromStdString(document_.text()));
    is_own_change_ = false;
    show_problems();
  });
  connect(&document_, &Document::problems_changed, this, &TextEditor::show_problems);
  connect(problems_, &QListWidget::itemActivated, this, [this](QListWidgetItem*) {
    const auto row = static_cast<std::size_t>(problems_->currentRow());
    if (row < field_->problems().size()) field_->go_to(field_->problems()[row]);
  });
  follow();
}

void TextEditor::commit() {
  pause_.stop();
  if (!is_typed_) return;
  document_.set_text(field_->toPlainText().toStdString(), tr("Type"));
  is_typed_ = false;
  following_.stop();  // the text stays as it was typed
}

std::optional<std::string> TextEditor::typed() const {
  return is_typed_ ? std::optional(field_->toPlainText().toStdString()) : std::nullopt;
}

void TextEditor::follow() {
  if (is_typed_ || document_.is_stale()) return;
  const QString text = QString::fromStdString(document_.text());
  if (text == field_->toPlainText()) return show_problems();
  is_own_change_ = true;
  field_->show_text(text);
  is_own_change_ = false;
  show_problems();
}

void TextEditor::show_problems() {
  std::vector<wale::Problem> problems = document_.problems();
  const Document::Advice& advice = document_.advice();
  if (!document_.is_stale() && advice.text == field_->toPlainText().toStdString())
    problems.insert(problems.end(), advice.problems.begin(), advice.problems.end());
  field_->set_problems(problems);
  problems_->clear();
  for (const wale::Problem& each : problems) {
    if (problems_->count() == most_listed) {
      problems_->addItem(tr("and %1 more").arg(problems.size() - most_listed));
      break;
    }
    const bool is_error = wale::severity_of(each.error.code) == wale::Severity::error;
    QString words = QString::fromStdString(each.error.sentence);
    if (!each.error.mend.empty()) words += "; " + QString::fromStdString(each.error.mend);
    if (each.error.place.number) words = tr("line %1: %2").arg(*each.error.place.number).arg(words);
    auto* item = new QListWidgetItem((is_error ? tr("error, ") : tr("warning, ")) + words, problems_);
    item->setForeground(is_error ? error_colour(palette()) : palette().color(QPalette::Text));
  }
  problems_->setVisible(!problems.empty());
  problems_->setMaximumHeight(std::min(problems_->sizeHintForRow(0) * problems_->count() + 6, most_height));
}

}  // namespace sandpaper
