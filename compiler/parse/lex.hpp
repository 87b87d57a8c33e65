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
  name,  ///< with or without dots: fabric.denim
  number,
  text,
  // Reserved words: a value or a unit may precede them, so they cannot be names.
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
  part_x,  ///< `.x` directly after a `)`
  part_y,
  percent,
  unreadable,  ///< already reported; the parser gives up silently where it meets one
};

/// Whether a line that ends in such a token continues in the next.
bool continues(TokenKind kind);

/// Whether a statement ends before a token.
enum class StatementEnd : std::uint8_t {
  no,
  outside_parentheses,  ///< the token begins a line that does not continue the one above; inside parentheses newlines
                        ///< do not matter
  yes,                  ///< `;`, `}` or the end of the file
};

struct Token {
  TokenKind kind = TokenKind::end;
  bool starts_line = false;  ///< a newline precedes it
  StatementEnd ends_statement = StatementEnd::no;
  std::uint32_t begin = 0, end = 0;  ///< bytes of the source
  /// For a number or text: its index in `numbers` or `texts`. For a name: 0, or 1 + the index of its corrected spelling
  /// in `texts`. For a bracket: the index of the token that closes it, or 0 if none does.
  std::uint32_t value = 0;
};

/// A file as tokens; the last one is always `end`. Texts are parts of `source` or of `rewritten`.
struct Tokens {
  std::vector<Token> tokens;
  std::vector<double> numbers;
  std::vector<std::string_view> texts;
  std::map<std::size_t, std::string> documentation;  ///< text of the `///` comments, by the token after them
  std::shared_ptr<const Source> source;
  std::shared_ptr<std::forward_list<std::string>> rewritten;  ///< null if nothing was rewritten

  /// Stores a text that differs from its spelling in the file: a text with escapes, a corrected name.
  std::string_view rewrite(std::string text) {
    if (!rewritten) rewritten = std::make_shared<std::forward_list<std::string>>();
    return rewritten->emplace_front(std::move(text));
  }
};

/// Reading a file stops after this many errors in it.
constexpr std::size_t error_limit = 100;

/// Cuts one file into tokens. Errors are reported; instead of the erroneous bytes the result has `unreadable`, or the
/// token that was evidently meant. A file that is not text or too large (W0107, W0109) gives only `end`.
Tokens lex(const SourceSet& sources, SourceId source, Diagnostics& diagnostics);

}  // namespace wale
