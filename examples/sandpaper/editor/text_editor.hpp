#pragma once

#include <QCompleter>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QStandardItemModel>
#include <QTimer>
#include <QWidget>
#include <vector>

#include "document/document.hpp"
#include "editor/highlighter.hpp"

namespace sandpaper {

/// A field for Wale text with its problems under the words and proposals while typing.
class TextField : public QPlainTextEdit {
  Q_OBJECT

 public:
  explicit TextField(const wale::LanguageService& language, QWidget* parent = nullptr);

  /// Shows another text; what is the same in both stays, with the cursor and the scrolled place.
  void show_text(const QString& text);
  void set_problems(const std::vector<wale::Problem>& problems);
  const std::vector<wale::Problem>& problems() const { return problems_; }
  void set_file(const std::string& file) { file_ = file; }
  /// Applies the first mend of the problem at the cursor, or else of the first problem behind it that has one.
  bool mend();
  void apply(const wale::TextFix& fix);
  /// Puts the cursor on a problem.
  void go_to(const wale::Problem& problem);
  void complete(bool is_asked);

 signals:
  /// The problem at the cursor, in words; empty if there is none.
  void problem_at_cursor(const QString& words);

 protected:
  bool event(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void insert(const QString& word);
  const wale::Problem* problem_at(int character) const;

  const wale::LanguageService& language_;
  std::string file_;
  Highlighter* highlighter_;
  QCompleter* completer_;
  QStandardItemModel* proposals_;
  std::vector<wale::Problem> problems_;
  int word_begin_ = 0;
};

/// The text of the document: what is typed is felt on every pause in which it has no errors.
class TextEditor : public QWidget {
  Q_OBJECT

 public:
  TextEditor(Document& document, const wale::LanguageService& language, QWidget* parent = nullptr);

  TextField* field() const { return field_; }
  /// Takes over what has been typed at once.
  void commit();
  /// What has been typed and is not taken over yet; nothing where there is none.
  std::optional<std::string> typed() const;

 signals:
  void typing();  ///< with each key

 private:
  void follow();
  void show_problems();

  Document& document_;
  TextField* field_;
  QListWidget* problems_;
  QTimer pause_, following_;
  bool is_own_change_ = false, is_typed_ = false;
};

}  // namespace sandpaper
