#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/parse/lex.hpp"

namespace wale::formatting {

/// A token or a comment, in the order of the text. All tokens and comments of a file are kept except `;`, and nothing
/// else is.
struct Piece {
  enum class Kind : std::uint8_t { token, line_comment, block_comment };
  Kind kind = Kind::token;
  Token token;            ///< for a comment: `end`
  std::string text;       ///< as it is written into the result
  unsigned newlines = 0;  ///< in the white space before it
  bool after_semicolon = false;
  bool touches = false;  ///< no white space is before it

  bool is(TokenKind wanted) const { return kind == Kind::token && token.kind == wanted; }
  bool is_comment() const { return kind != Kind::token; }
};

/// All pieces of a file without lexical errors. Blanks at the ends of a comment's lines are removed, and one is added
/// after `//`.
std::vector<Piece> pieces_of(std::string_view text, const Tokens& tokens);

/// The width of a text in columns: its number of characters.
std::size_t width_of(std::string_view text);

}  // namespace wale::formatting
