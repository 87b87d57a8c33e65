#pragma once

namespace wale {

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

constexpr bool continues_name(char c) { return begins_name(c) || is_digit(c); }

/// Whether it is the micro sign or the Greek letter mu.
inline bool is_micro(char32_t code) { return code == 0xB5 || code == 0x3BC; }

/// Whether it is a letter of another alphabet, approximately: everything beyond the signs of Latin-1 except the blocks
/// of punctuation and symbols.
inline bool is_foreign_letter(char32_t code) {
  const bool sign = code == 0xD7 || code == 0xF7 || (code >= 0x2000 && code <= 0x2BFF) ||
                    (code >= 0x3000 && code <= 0x303F) || (code >= 0xFE00 && code <= 0xFEFF) || code >= 0xFFF0;
  return is_micro(code) || (code >= 0xC0 && !sign);
}

inline bool is_blank(char32_t code) {
  return code == ' ' || code == '\t' || code == '\r' || code == '\f' || code == '\v' || code == 0xA0 ||
         (code >= 0x2000 && code <= 0x200A) || code == 0x202F || code == 0x205F || code == 0x3000;
}

}  // namespace wale
