#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/parse/lex.hpp"

namespace wale::formatting {

/// A token or a comment, in the order of the text. Nothing else of a file is kept, and all of these are, but for `;`.
struct Piece {
  enum class Kind : std::uint8_t { token, line_comment, block_comment };
  Kind kind = Kind::token;
  Token token;            ///< of a comment: `end`
  std::string text;       ///< as it will be written
  unsigned newlines = 0;  ///< in the white space before it
  bool after_semicolon = false;
  bool touches = false;  ///< nothing stands between it and what is before it

  bool is(TokenKind wanted) const { return kind == Kind::token && token.kind == wanted; }
  bool is_comment() const { return kind != Kind::token; }
};

/// Everything that a file without lexical errors holds. Comments lose the blanks at the ends of their lines and gain
/// one behind `//`.
std::vector<Piece> pieces_of(std::string_view text, const Tokens& tokens);

/// Columns that a text takes: its characters.
std::size_t width_of(std::string_view text);

}  // namespace wale::formatting
