#pragma once

#include <QPalette>
#include <QSyntaxHighlighter>
#include <vector>
#include <wale/language_service.hpp>

namespace sandpaper {

/// Whether the window's colours are light on dark.
bool is_dark(const QPalette& palette);
/// The colour of errors, as text and as a line below it.
QColor error_colour(const QPalette& palette);

/// Colours a text by what its words are, in the light or the dark palette of the window.
class Highlighter : public QSyntaxHighlighter {
  Q_OBJECT

 public:
  explicit Highlighter(QTextDocument* document);

 protected:
  void highlightBlock(const QString& text) override;

 private:
  void read();

  bool is_old_ = true;
  struct Word {
    int begin, length;  // in characters of the whole text
    wale::WordKind kind;
  };
  std::vector<Word> words_;
};

/// Bytes of UTF-8 as characters of a QString, and the other way round.
class Offsets {
 public:
  explicit Offsets(const QString& text);
  int characters(std::size_t byte) const;
  std::size_t bytes(int character) const;

 private:
  std::vector<std::size_t> bytes_;  // of each character, and of the end
};

}  // namespace sandpaper
