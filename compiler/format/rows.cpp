#include "compiler/format/rows.hpp"

#include <algorithm>

#include "compiler/format/format.hpp"
#include "compiler/parse/parser.hpp"

namespace wale::formatting {
namespace {

class RowCutter {
 public:
  explicit RowCutter(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {}

  std::vector<Row> run() {
    for (at_ = 0; at_ < pieces_.size();) {
      const std::size_t token = next_token(at_);
      const bool last = token == pieces_.size();
      if (last || begins_row(token)) {
        comments_between_rows(token);
        if (last) break;
        begin_row(token);
      } else {
        for (; at_ < token; ++at_) rows_.back().pieces.push_back(pieces_[at_]);
      }
      take(token);
    }
    return std::move(rows_);
  }

 private:
  std::size_t next_token(std::size_t index) const {
    while (index < pieces_.size() && pieces_[index].is_comment()) ++index;
    return index;
  }

  /// Whether a statement, a block or its end begins at the token.
  bool begins_row(std::size_t index) const {
    if (previous_ == nullptr || ends_line_) return true;
    if (inline_block_) return false;
    const Piece& piece = pieces_[index];
    if (piece.is(TokenKind::right_brace)) return true;
    for (std::size_t i = at_; i <= index; ++i)
      if (pieces_[i].after_semicolon) return true;
    if (!piece.token.starts_line || parentheses_ > 0 || continues(previous_->token.kind)) return false;
    return !piece.is(TokenKind::word_then) && !piece.is(TokenKind::word_else) && !piece.is(TokenKind::left_brace);
  }

  void take(std::size_t index) {
    Piece& piece = pieces_[index];
    const bool opens = piece.is(TokenKind::left_brace), closes = piece.is(TokenKind::right_brace);
    // The `{` of a block comes after its heading on the same line, unless the heading ends in a comment.
    if (opens && !rows_.back().pieces.empty() && !rows_.back().pieces.back().is_comment()) piece.newlines = 0;
    if (inline_block_) piece.newlines = 0;
    if (piece.is(TokenKind::left_parenthesis)) ++parentheses_;
    if (piece.is(TokenKind::right_parenthesis) && parentheses_ > 0) --parentheses_;
    rows_.back().pieces.push_back(piece);
    ends_line_ = closes;
    if (opens) {
      inline_block_ = stays_in_line(index);
      ends_line_ = !inline_block_;
      depth_ += !inline_block_;
    } else if (closes) {
      inline_block_ = false;
    }
    previous_ = &piece;
    at_ = index + 1;
  }

  /// Whether the block that opens here is `{}`, or was written on one line with one statement in it.
  bool stays_in_line(std::size_t open) const {
    std::size_t width = 2 * depth_ + 2;
    for (const Piece& piece : rows_.back().pieces) width += 1 + width_of(piece.text);
    std::size_t close = open + 1;
    for (; close < pieces_.size() && !pieces_[close].is(TokenKind::right_brace); ++close) {
      const Piece& piece = pieces_[close];
      const bool second = piece.after_semicolon && close > open + 1;
      if (piece.is_comment() || piece.newlines > 0 || second || piece.is(TokenKind::left_brace)) return false;
      width += 1 + width_of(piece.text);
    }
    if (close == open + 1) return true;
    return close < pieces_.size() && pieces_[close].newlines == 0 && width <= format_columns;
  }

  void begin_row(std::size_t token) {
    const Piece& piece = pieces_[token];
    const bool closes = piece.is(TokenKind::right_brace);
    if (closes && depth_ > 0) --depth_;
    Row row{{}, {}, depth_, blank_before(pieces_[at_]) && !closes};
    for (; at_ < token; ++at_) row.pieces.push_back(pieces_[at_]);
    rows_.push_back(std::move(row));
  }

  bool blank_before(const Piece& piece) const {
    return piece.newlines > 1 && !rows_.empty() && !rows_.back().pieces.back().is(TokenKind::left_brace);
  }

  /// Assigns the comments before a row, from `at_` on: to the row above, to rows of their own, or to the row that
  /// begins at `token`.
  void comments_between_rows(std::size_t token) {
    std::size_t first_line = at_;  // the comments up to here are on the line above
    if (!rows_.empty())
      while (first_line < token && pieces_[first_line].newlines == 0) ++first_line;
    const bool ends = token == pieces_.size() || pieces_[token].is(TokenKind::right_brace);
    if (!ends && first_line == token && pieces_[token].newlines == 0) {
      // Between two statements on one line there are only comments; those before the `;` belong to the first statement.
      first_line = at_;
      for (std::size_t i = at_; i <= token; ++i)
        if (pieces_[i].after_semicolon) first_line = i;
    }
    for (; at_ < first_line; ++at_) {
      std::string& trailing = rows_.back().trailing;
      trailing += (trailing.empty() ? "" : " ") + pieces_[at_].text;
    }
    while (at_ < token) {
      std::size_t end = at_ + 1;
      while (end < token && pieces_[end].newlines == 0) ++end;
      if (end == token && !ends && pieces_[token].newlines == 0) return;
      rows_.push_back(
          {{pieces_.begin() + static_cast<std::ptrdiff_t>(at_), pieces_.begin() + static_cast<std::ptrdiff_t>(end)},
           {},
           depth_,
           blank_before(pieces_[at_])});
      at_ = end;
    }
  }

  std::vector<Piece> pieces_;
  std::vector<Row> rows_;
  std::size_t at_ = 0;
  const Piece* previous_ = nullptr;  ///< the last token
  std::size_t depth_ = 0;
  std::size_t parentheses_ = 0;
  bool inline_block_ = false;
  bool ends_line_ = false;  ///< nothing may follow the last token on its line
};

}  // namespace

std::vector<Row> rows_of(std::vector<Piece> pieces) { return RowCutter(std::move(pieces)).run(); }

}  // namespace wale::formatting
