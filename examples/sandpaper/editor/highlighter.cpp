#include "editor/highlighter.hpp"

#include <QApplication>
#include <QPalette>
#include <QTextDocument>
#include <algorithm>

namespace sandpaper {
namespace {

QTextCharFormat format_of(wale::WordKind kind, bool on_dark) {
  QTextCharFormat format;
  const auto colour = [&](int light, int dark) {
    format.setForeground(QColor::fromRgb(static_cast<QRgb>(on_dark ? dark : light)));
  };
  switch (kind) {
    case wale::WordKind::comment: colour(0x6a737d, 0x9aa5b1); break;
    case wale::WordKind::documentation: colour(0x22703c, 0x8ccf9e); break;
    case wale::WordKind::keyword:
      colour(0x7a2a8c, 0xd8a0e8);
      format.setFontWeight(QFont::Bold);
      break;
    case wale::WordKind::number: colour(0x0b5aa8, 0x8fc4ff); break;
    case wale::WordKind::unit: colour(0x2b7a9b, 0x8fdcf0); break;
    case wale::WordKind::text: colour(0xa04010, 0xf0b080); break;
    case wale::WordKind::name:
    case wale::WordKind::symbol: break;
  }
  return format;
}

}  // namespace

bool is_dark(const QPalette& palette) { return palette.color(QPalette::Base).lightness() < 128; }

QColor error_colour(const QPalette& palette) { return is_dark(palette) ? QColor(255, 125, 115) : QColor(200, 30, 30); }

Offsets::Offsets(const QString& text) {
  bytes_.reserve(static_cast<std::size_t>(text.size()) + 1);
  std::size_t at = 0;
  for (int i = 0; i < text.size(); ++i) {
    bytes_.push_back(at);
    const ushort unit = text[i].unicode();
    if (text[i].isHighSurrogate() && i + 1 < text.size() && text[i + 1].isLowSurrogate()) {
      at += 4;
      bytes_.push_back(at);  // inside the pair: its end
      ++i;
    } else {
      at += unit < 0x80 ? 1 : unit < 0x800 ? 2 : 3;
    }
  }
  bytes_.push_back(at);
}

int Offsets::characters(std::size_t byte) const {
  const auto found = std::lower_bound(bytes_.begin(), bytes_.end(), byte);
  return static_cast<int>(std::min(found, bytes_.end() - 1) - bytes_.begin());
}

std::size_t Offsets::bytes(int character) const {
  return bytes_[static_cast<std::size_t>(std::clamp(character, 0, static_cast<int>(bytes_.size()) - 1))];
}

Highlighter::Highlighter(QTextDocument* document) : QSyntaxHighlighter(static_cast<QTextDocument*>(nullptr)) {
  // Before the base class connects its own: it highlights at once.
  connect(document, &QTextDocument::contentsChange, this, [this] { is_old_ = true; });
  setDocument(document);
}

void Highlighter::read() {
  const QString text = document()->toPlainText();
  const Offsets offsets(text);
  words_.clear();
  for (const wale::ColouredWord& each : wale::coloured_words(text.toStdString())) {
    const int begin = offsets.characters(each.begin);
    words_.push_back({begin, offsets.characters(each.end) - begin, each.kind});
  }
  is_old_ = false;
}

void Highlighter::highlightBlock(const QString& text) {
  if (is_old_) read();
  const bool dark = is_dark(QApplication::palette());
  const int from = currentBlock().position(), to = from + static_cast<int>(text.size());
  auto each = std::ranges::lower_bound(words_, from, {}, [](const Word& word) { return word.begin + word.length; });
  bool in_comment = false;
  for (; each != words_.end() && each->begin < to; ++each) {
    setFormat(std::max(each->begin, from) - from,
              std::min(each->begin + each->length, to) - std::max(each->begin, from), format_of(each->kind, dark));
    in_comment = each->kind == wale::WordKind::comment && each->begin + each->length > to;
  }
  setCurrentBlockState(in_comment ? 1 : 0);  // the lines of a block comment follow one another
}

}  // namespace sandpaper
