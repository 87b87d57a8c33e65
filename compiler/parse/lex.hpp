#pragma once

#include <cstdint>
#include <forward_list>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

enum class TokenKind : std::uint8_t {
  end,
  name,  ///< perhaps dotted: fabric.denim
  number,
  text,
  // The words that cannot be names, because a value or a unit may stand before them.
  word_if,
  word_then,
  word_else,
  word_in,
  word_on,
  word_from,
  word_and,
  word_or,
  word_not,
  left_parenthesis,
  right_parenthesis,
  left_bracket,
  right_bracket,
  left_brace,
  right_brace,
  comma,
  semicolon,
  colon,
  equals,
  range,
  plus,
  minus,
  star,
  slash,
  caret,
  less,
  less_equal,
  greater,
  greater_equal,
  plus_minus,
  prime,
  part_x,  ///< `.x` right behind a `)`
  part_y,
  percent,
  unreadable,  ///< already reported; whatever needs it gives up silently
};

/// Whether a line that ends in such a token goes on in the next.
bool continues(TokenKind kind);

/// Whether a statement ends before a token.
enum class StatementEnd : std::uint8_t {
  no,
  outside_parentheses,  ///< the token begins a line that is not the rest of the one above
  yes,                  ///< `;`, `}` or the end of the file
};

struct Token {
  TokenKind kind = TokenKind::end;
  bool starts_line = false;  ///< a newline stands before it
  StatementEnd ends_statement = StatementEnd::no;
  std::uint32_t begin = 0, end = 0;  ///< bytes of the source
  /// Of a number or text: its index in `numbers` or `texts`. Of a name: 0, or one more than the index of its corrected
  /// spelling in `texts`. Of a bracket: the token that closes it, or 0 when none does.
  std::uint32_t value = 0;
};

/// A file as tokens; the last one is always `end`. Texts are parts of `source` or of `rewritten`.
struct Tokens {
  std::vector<Token> tokens;
  std::vector<double> numbers;
  std::vector<std::string_view> texts;
  std::map<std::size_t, std::string> documentation;  ///< text of the `///` comments before a token
  std::shared_ptr<const Source> source;
  std::shared_ptr<std::forward_list<std::string>> rewritten;  ///< null while nothing is

  /// Keeps what the file says in other letters: a text with escapes, a corrected name.
  std::string_view rewrite(std::string text) {
    if (!rewritten) rewritten = std::make_shared<std::forward_list<std::string>>();
    return rewritten->emplace_front(std::move(text));
  }
};

/// Reading a file stops after this many errors in it.
constexpr std::size_t error_limit = 100;

/// Cuts one file into tokens. Reports what is no token and leaves `unreadable`, or what was evidently meant, in its
/// place. A file that is no text at all (W0107, W0109) gives nothing but `end`.
Tokens lex(const SourceSet& sources, SourceId source, Diagnostics& diagnostics);

}  // namespace wale
