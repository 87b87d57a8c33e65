#pragma once

#include <array>
#include <string_view>

#include "compiler/parse/lex.hpp"

namespace wale {

/// Characters that people or their word processors write instead of a token of Wale.
struct Lookalike {
  std::string_view text;
  std::string_view called;
  std::string_view meant;
  TokenKind kind;  ///< the token it is read as; `unreadable` if it may mean several things
};

inline constexpr Lookalike lookalikes[] = {
    {"...", "three dots", "`..`", TokenKind::range},
    {"…", "an ellipsis", "`..`", TokenKind::range},
    {"=>", "an arrow", "`=`", TokenKind::equals},
    {":=", "an assignment of other languages", "`=`", TokenKind::equals},
    {"==", "a doubled equals sign", "`=` to define; values are compared with `<`, `<=`, `>` and `>=`",
     TokenKind::unreadable},
    {"!=", "an unequal sign", "`<` or `>`: values are compared with `<`, `<=`, `>` and `>=`", TokenKind::unreadable},
    {"**", "a doubled asterisk", "`^` for a power", TokenKind::caret},
    {"&&", "a doubled ampersand", "`and`", TokenKind::word_and},
    {"||", "a doubled bar", "`or`", TokenKind::word_or},
    {"×", "a multiplication sign", "`*`", TokenKind::star},
    {"·", "a middle dot", "`*` between values, a space between units", TokenKind::unreadable},
    {"⋅", "a dot operator", "`*` between values, a space between units", TokenKind::unreadable},
    {"÷", "a division sign", "`/`", TokenKind::slash},
    {"∕", "a division slash", "`/`", TokenKind::slash},
    {"⁄", "a fraction slash", "`/`", TokenKind::slash},
    {"−", "a typographic minus", "`-`", TokenKind::minus},
    {"–", "a dash", "`-`", TokenKind::minus},
    {"—", "a long dash", "`-`", TokenKind::minus},
    {"‐", "a typographic hyphen", "`-`", TokenKind::minus},
    {"≤", "a less-or-equal sign", "`<=`", TokenKind::less_equal},
    {"≥", "a greater-or-equal sign", "`>=`", TokenKind::greater_equal},
    {"’", "a typographic apostrophe", "`'`", TokenKind::prime},
    {"‘", "a typographic quote", "`'`", TokenKind::prime},
    {"′", "a prime", "`'`", TokenKind::prime},
};

/// By first byte: whether a lookalike may begin with it, which is true of every byte that is not ASCII.
inline constexpr auto begins_lookalike = [] {
  std::array<bool, 256> table{};
  for (std::size_t byte = 0x80; byte < table.size(); ++byte) table[byte] = true;
  for (const Lookalike& each : lookalikes) table[static_cast<unsigned char>(each.text.front())] = true;
  return table;
}();

/// Characters that stand for an ASCII spelling of two tokens or of a name.
struct Abbreviation {
  std::string_view text;
  std::string_view called;
  std::string_view meant;
};

inline constexpr Abbreviation abbreviations[] = {
    {"²", "a raised 2", "^2"}, {"³", "a raised 3", "^3"}, {"°", "a degree sign", "deg"}};

inline constexpr std::string_view typographic_quotes[] = {"“", "”", "„", "«", "»", "‟"};

}  // namespace wale
