#include <QAbstractItemView>
#include <QFontDatabase>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QScrollBar>
#include <QToolTip>

#include "editor/text_editor.hpp"

namespace sandpaper {
namespace {

constexpr int most_underlined = 300;

QString in_words(const wale::Problem& problem) {
  QString words = QString::fromStdString(problem.error.sentence);
  if (!problem.error.mend.empty()) words += "\n" + QString::fromStdString(problem.error.mend);
  if (!problem.fixes.empty())
    words += "\n" + TextField::tr("Ctrl+.  %1").arg(QString::fromStdString(problem.fixes.front().title));
  return words;
}

QString kind_name(wale::ProposalKind kind) {
  switch (kind) {
    case wale::ProposalKind::keyword: return TextField::tr("word of the language");
    case wale::ProposalKind::percept: return TextField::tr("percept");
    case wale::ProposalKind::level: return TextField::tr("level");
    case wale::ProposalKind::unit: return TextField::tr("unit");
    case wale::ProposalKind::function: return TextField::tr("function");
    case wale::ProposalKind::constant: return TextField::tr("value");
    case wale::ProposalKind::parameter: return TextField::tr("of this file");
    case wale::ProposalKind::material: return TextField::tr("material");
  }
  return {};
}

}  // namespace

TextField::TextField(const wale::LanguageService& language, QWidget* parent)
    : QPlainTextEdit(parent),
      language_(language),
      highlighter_(new Highlighter(document())),
      completer_(new QCompleter(this)),
      proposals_(new QStandardItemModel(this)) {
  setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  setLineWrapMode(QPlainTextEdit::NoWrap);
  setTabStopDistance(2 * fontMetrics().horizontalAdvance(' '));
  setAccessibleName(tr("Text of the workspace"));
  completer_->setModel(proposals_);
  completer_->setWidget(this);
  completer_->setCompletionMode(QCompleter::PopupCompletion);
  completer_->setModelSorting(QCompleter::UnsortedModel);
  connect(completer_, qOverload<const QString&>(&QCompleter::activated), this, &TextField::insert);
  connect(this, &QPlainTextEdit::cursorPositionChanged, this, [this] {
    const wale::Problem* problem = problem_at(textCursor().position());
    emit problem_at_cursor(problem ? in_words(*problem) : QString());
  });
}

void TextField::set_problems(const std::vector<wale::Problem>& problems) {
  problems_ = problems;
  const Offsets offsets(toPlainText());
  QList<QTextEdit::ExtraSelection> selections;
  for (const wale::Problem& each : problems_) {
    if (each.begin == 0 && each.end == 0) continue;
    if (selections.size() == most_underlined) break;  // each is a cursor that every change of the text moves
    QTextEdit::ExtraSelection selection;
    selection.cursor = QTextCursor(document());
    const int begin = offsets.characters(each.begin);
    selection.cursor.setPosition(begin);
    selection.cursor.setPosition(
        std::max(offsets.characters(each.end), std::min(begin + 1, offsets.characters(SIZE_MAX))),
        QTextCursor::KeepAnchor);
    selection.format.setUnderlineStyle(QTextCharFormat::WaveUnderline);
    selection.format.setUnderlineColor(
        wale::severity_of(each.error.code) == wale::Severity::error ? error_colour(palette()) : QColor(200, 140, 0));
    selections << selection;
  }
  setExtraSelections(selections);
}

void TextField::show_text(const QString& text) {
  const QString now = toPlainText();
  qsizetype same = 0, same_end = 0;
  const qsizetype most = std::min(now.size(), text.size());
  while (same < most && now[same] == text[same]) ++same;
  while (same_end < most - same && now[now.size() - 1 - same_end] == text[text.size() - 1 - same_end]) ++same_end;
  if (same == now.size() && same == text.size()) return;
  setExtraSelections({});
  QTextCursor cursor(document());
  cursor.setPosition(static_cast<int>(same));
  cursor.setPosition(static_cast<int>(now.size() - same_end), QTextCursor::KeepAnchor);
  cursor.insertText(text.mid(same, text.size() - same - same_end));
}

const wale::Problem* TextField::problem_at(int character) const {
  const Offsets offsets(toPlainText());
  const std::size_t byte = offsets.bytes(character);
  for (const wale::Problem& each : problems_)
    if (each.begin <= byte && byte <= each.end && each.end > 0) return &each;
  return nullptr;
}

bool TextField::mend() {
  const Offsets offsets(toPlainText());
  const std::size_t byte = offsets.bytes(textCursor().position());
  const wale::Problem* found = problem_at(textCursor().position());
  if (found && found->fixes.empty()) found = nullptr;
  for (const wale::Problem& each : problems_)
    if (!found && !each.fixes.empty() && each.end >= byte) found = &each;
  for (const wale::Problem& each : problems_)
    if (!found && !each.fixes.empty()) found = &each;
  if (!found) return false;
  apply(wale::TextFix(found->fixes.front()));
  return true;
}

void TextField::apply(const wale::TextFix& fix) {
  const Offsets offsets(toPlainText());
  auto edits = fix.edits;
  std::ranges::sort(edits, std::ranges::greater(), &wale::TextEdit::begin);  // from the end, so that places stay
  QTextCursor cursor(document());
  cursor.beginEditBlock();
  for (const wale::TextEdit& each : edits) {
    cursor.setPosition(offsets.characters(each.begin));
    cursor.setPosition(offsets.characters(each.end), QTextCursor::KeepAnchor);
    cursor.insertText(QString::fromStdString(each.replacement));
  }
  cursor.endEditBlock();
}

void TextField::go_to(const wale::Problem& problem) {
  const Offsets offsets(toPlainText());
  QTextCursor cursor(document());
  cursor.setPosition(offsets.characters(problem.begin));
  cursor.setPosition(offsets.characters(problem.end), QTextCursor::KeepAnchor);
  setTextCursor(cursor);
  setFocus();
}

void TextField::complete(bool is_asked) {
  const QString text = toPlainText();
  const Offsets offsets(text);
  const wale::Proposals found =
      language_.proposals(text.toStdString(), offsets.bytes(textCursor().position()), {.name = file_});
  const std::size_t length = found.end - found.begin;
  if (found.words.empty() || (!is_asked && length < 2) ||
      (found.words.size() == 1 && found.words.front().text.size() == length)) {
    completer_->popup()->hide();
    return;
  }
  word_begin_ = offsets.characters(found.begin);
  proposals_->clear();
  for (const wale::Proposal& each : found.words) {
    auto* item = new QStandardItem(QString::fromStdString(each.text));
    const QString says = each.documentation.empty()
                             ? kind_name(each.kind)
                             : kind_name(each.kind) + ": " + QString::fromStdString(each.documentation);
    item->setToolTip(says);
    item->setData(says, Qt::AccessibleDescriptionRole);
    proposals_->appendRow(item);
  }
  completer_->setCompletionPrefix({});
  QRect place = cursorRect();
  place.setWidth(completer_->popup()->sizeHintForColumn(0) +
                 completer_->popup()->verticalScrollBar()->sizeHint().width() + 20);
  completer_->complete(place);
  completer_->popup()->setCurrentIndex(completer_->completionModel()->index(0, 0));
}

void TextField::insert(const QString& word) {
  QTextCursor cursor = textCursor();
  cursor.setPosition(word_begin_, QTextCursor::KeepAnchor);
  cursor.insertText(word);
  setTextCursor(cursor);
}

void TextField::keyPressEvent(QKeyEvent* event) {
  if (completer_->popup()->isVisible())
    switch (event->key()) {
      case Qt::Key_Enter:
      case Qt::Key_Return:
      case Qt::Key_Escape:
      case Qt::Key_Tab:
      case Qt::Key_Backtab: event->ignore(); return;  // the list of proposals takes them
      default: break;
    }
  if (event->key() == Qt::Key_Space && event->modifiers() == Qt::ControlModifier) return complete(true);
  if (event->key() == Qt::Key_Period && event->modifiers() == Qt::ControlModifier) {
    if (!mend()) emit problem_at_cursor(problems_.empty() ? tr("There is nothing to mend") : tr("No mend is known for what is wrong"));
    return;
  }
  if (event->key() == Qt::Key_Tab && event->modifiers() == Qt::NoModifier) {
    insertPlainText("  ");
    return;
  }
  QPlainTextEdit::keyPressEvent(event);
  const QString typed = event->text();
  if (!typed.isEmpty() && (typed[0].isLetter() || typed[0] == '_')) complete(false);
  else completer_->popup()->hide();
}

bool TextField::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    // These keys are the text's here, and no command of a menu: least of all the one that begins to push.
    const auto* key = static_cast<QKeyEvent*>(event);
    if (key->modifiers() == Qt::ControlModifier && (key->key() == Qt::Key_Space || key->key() == Qt::Key_Period)) {
      event->accept();
      return true;
    }
  }
  if (event->type() == QEvent::ToolTip) {
    const auto* help = static_cast<QHelpEvent*>(event);
    const wale::Problem* problem =
        problem_at(cursorForPosition(viewport()->mapFromGlobal(help->globalPos())).position());
    if (problem) QToolTip::showText(help->globalPos(), in_words(*problem), this);
    else QToolTip::hideText();
    return true;
  }
  return QPlainTextEdit::event(event);
}

}  // namespace sandpaper
