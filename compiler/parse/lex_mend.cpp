// Bytes that form no token are reported, and read as the token that was evidently meant.

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/lexer.hpp"

namespace wale {
namespace {

/// The text between the first two backticks: the token in "`^` for a power".
std::string quoted_token(std::string_view text) {
  const std::size_t begin = text.find('`') + 1;
  return std::string(text.substr(begin, text.find('`', begin) - begin));
}

/// The name with its Greek letters replaced by `u`.
std::string with_u(std::string_view name) {
  std::string ascii;
  for (std::size_t at = 0; at < name.size(); at += decode(name, at).bytes)
    ascii += is_micro(decode(name, at).code) ? 'u' : name[at];
  return ascii;
}

/// What a `#` means in other languages.
std::string help_for_hash(std::string_view text) {
  if (text.starts_with("#include")) return "other files are known by `import`, as in `import fabric.denim`";
  if (text.starts_with("#define")) return "a value is named as in `let wale = 2.5 mm`";
  const auto is_hex = [](char c) {
    return std::string_view("0123456789abcdefABCDEF").find(c) != std::string_view::npos;
  };
  std::size_t digits = 0;
  while (digits + 1 < text.size() && is_hex(text[digits + 1])) ++digits;
  const bool ends = digits + 1 >= text.size() || !continues_name(text[digits + 1]);
  if (ends && (digits == 3 || digits == 6 || digits == 8))
    return "the parts of a colour go from 0 to 1: write `show colour(0.8, 0.5, 0.2)`";
  return "comments begin with `//`";
}

std::string help_for(char c, bool visible) {
  switch (c) {
    case '!': return "for the opposite of a condition write `not`";
    case '.': return "functions are called as `clamp(value, low, high)`; a vector has the parts `.x` and `.y`";
    case '?': return "write `if … then … else …`";
    case '\\': return "a line continues by itself after an operator, a comma, `=` or `..`, and inside parentheses";
    case '`': return "write texts in straight quotes: `\"`";
    default: return visible ? "remove it, or put it into a text or a comment" : "delete it";
  }
}

}  // namespace

/// A fix that adds a `0` before the point, unless the `0` would become part of the word before it.
std::vector<Fix> Lexer::leading_zero(std::size_t begin) const {
  if (begin > 0 && (continues_name(text_[begin - 1]) || text_[begin - 1] == '.')) return {};
  return {insert_before(span(begin, at_), "0")};
}

void Lexer::out_of_range(std::size_t begin, std::string_view digits) {
  // from_chars leaves the value unset; strtod tells overflow from underflow.
  const double size = std::strtod(std::string(digits).c_str(), nullptr);
  report(Code::number_out_of_range, begin, at_,
         std::isinf(size) ? "this number is too large to hold" : "this number is too close to zero to hold",
         "use a unit of another size", {},
         {{"least", NumberWithUnit{1e-300, ""}}, {"greatest", NumberWithUnit{1e300, ""}}},
         "numbers reach from 1e-300 to 1e300");
  add(TokenKind::unreadable, begin);
}

void Lexer::hexadecimal() {
  const std::size_t begin = at_;
  at_ += 2;
  while (at_ < text_.size() && std::isxdigit(static_cast<unsigned char>(text_[at_]))) ++at_;
  const double value = std::strtod(std::string(text_.substr(begin, at_ - begin)).c_str(), nullptr);
  report(Code::unexpected_character, begin, at_, "numbers are written in decimal", fmt::format("write `{}`", value),
         {replace(span(begin, at_), fmt::format("{}", value))});
  add(TokenKind::number, begin, add_number(value));
}

/// Reads a name that contains letters of other alphabets, and reports it.
void Lexer::foreign_name() {
  const std::size_t begin = at_;
  bool micro = false, foreign = false;
  for (;;) {
    while (continues_name(here())) ++at_;
    if (is_dot_in_name()) {
      ++at_;
      continue;
    }
    const Character character = decode(text_, at_);
    if (is_micro(character.code)) {
      micro = true;
    } else if (is_foreign_letter(character.code)) {
      foreign = true;
    } else {
      break;
    }
    at_ += character.bytes;
  }
  const std::string_view word = text_.substr(begin, at_ - begin);
  if (word == "π") {
    report(Code::unexpected_character, begin, at_, "`π` is written in Latin letters", "write `pi`",
           {replace(span(begin, at_),
                    begin > 0 && std::isdigit(static_cast<unsigned char>(text_[begin - 1])) ? " pi" : "pi")});
    return add_corrected("pi", begin);
  }
  if (foreign) {
    // The name may be used many times; report it once.
    if (reported_names_.emplace(word).second) {
      report(Code::unexpected_character, begin, at_, fmt::format("`{}` has letters other than a to z", word),
             "rename it with a-z, A-Z, 0-9 and `_`; texts in quotes may hold any letter");
    }
  } else if (micro) {
    const std::string ascii = with_u(word);
    report(Code::unexpected_character, begin, at_, fmt::format("`{}` is written without the Greek letter", word),
           fmt::format("write `{}`", ascii), {replace(span(begin, at_), ascii)});
    return add_corrected(ascii, begin);
  }
  add(TokenKind::name, begin);
}

/// Lookalikes are not ASCII, or else doubled, or `!=`; for other bytes the list need not be searched.
bool Lexer::may_be_lookalike() const {
  const auto c = static_cast<unsigned char>(text_[at_]);
  if (!begins_lookalike[c]) return false;
  if (c == '.') return starts("...");
  return c >= 0x80 || after() == here() || (c == '!' && after() == '=') || (c == '=' && after() == '>') ||
         (c == ':' && after() == '=');
}

bool Lexer::quote() {
  for (const std::string_view mark : typographic_quotes) {
    if (starts(mark)) {
      const std::size_t begin = at_;
      text(mark.size());
      report(Code::unexpected_character, begin, begin + mark.size(), "typographic quotation mark",
             "write texts in straight quotes: `\"`", quote_fixes(begin, begin + mark.size()));
      return true;
    }
  }
  return false;
}

/// Fixes that put straight quotes around the text that has just been read, if both its quotes are typographic. If the
/// second is straight, it may be part of the text instead of its end.
std::vector<Fix> Lexer::quote_fixes(std::size_t begin, std::size_t inside) const {
  Fix fix = replace(span(begin, inside), "\"", "write straight quotes");
  for (const std::string_view closing : typographic_quotes) {
    if (!text_.substr(inside, at_ - inside).ends_with(closing)) continue;
    fix.edits.push_back({span(at_ - closing.size(), at_), "\""});
    return {fix};
  }
  return {};
}

bool Lexer::lookalike() {
  for (const Lookalike& each : lookalikes) {
    if (!starts(each.text)) continue;
    const std::size_t begin = at_;
    at_ += each.text.size();
    while (each.kind == TokenKind::range && at_ < text_.size() && text_[at_] == '.') ++at_;
    report(Code::unexpected_character, begin, at_,
           fmt::format("`{}` is {}", text_.substr(begin, at_ - begin), each.called),
           fmt::format("write {}", each.meant), lookalike_fixes(each, begin));
    add(each.kind, begin);
    return true;
  }
  for (const Abbreviation& each : abbreviations) {
    if (!starts(each.text)) continue;
    const std::size_t begin = at_;
    at_ += each.text.size();
    report(Code::unexpected_character, begin, at_, fmt::format("`{}` is {}", each.text, each.called),
           fmt::format("write `{}`", each.meant), {replace(span(begin, at_), std::string(each.meant))});
    if (each.meant.starts_with('^')) {
      add(TokenKind::caret, begin);
      add(TokenKind::number, begin, add_number(each.meant[1] - '0'));
    } else {
      add_corrected(std::string(each.meant), begin);
    }
    return true;
  }
  return false;
}

/// Adds a name with a corrected spelling.
void Lexer::add_corrected(std::string name, std::size_t begin) {
  result_.texts.push_back(result_.rewrite(std::move(name)));
  add(TokenKind::name, begin, static_cast<std::uint32_t>(result_.texts.size()));
}

/// The fix for a lookalike; none if it may mean several things.
std::vector<Fix> Lexer::lookalike_fixes(const Lookalike& each, std::size_t begin) const {
  if (each.kind == TokenKind::unreadable) return {};
  std::string meant = quoted_token(each.meant);
  const bool is_word = begins_name(meant.front());
  if (is_word && begin > 0 && continues_name(text_[begin - 1])) meant = " " + meant;
  if (is_word && at_ < text_.size() && continues_name(text_[at_])) meant += " ";
  return {replace(span(begin, at_), meant)};
}

/// Reports an unknown character; a run of the same character is one error.
void Lexer::unknown(const Character& character) {
  const std::size_t begin = at_;
  while (at_ < text_.size() && decode(text_, at_).code == character.code) at_ += character.bytes;
  const bool visible = character.code > ' ' && !(character.code >= 0x7F && character.code < 0xA0) &&
                       !(character.code >= 0x200B && character.code <= 0x206F) && character.code != 0xFEFF;
  report(Code::unexpected_character, begin, at_,
         visible ? fmt::format("Wale does not use the character `{}`", text_.substr(begin, character.bytes))
                 : fmt::format("invisible character U+{:04X}", static_cast<std::uint32_t>(character.code)),
         text_[begin] == '#' ? help_for_hash(text_.substr(begin)) : help_for(text_[begin], visible),
         unknown_fixes(begin, visible));
  // `!button` is read as `not button`, so that nothing else is reported for it.
  add(text_[begin] == '!' && at_ == begin + 1 ? TokenKind::word_not : TokenKind::unreadable, begin);
}

/// Fixes: remove an invisible character; replace a `#` at the beginning of a line, a comment in many languages, by
/// `//`.
std::vector<Fix> Lexer::unknown_fixes(std::size_t begin, bool visible) const {
  if (!visible) return {replace(span(begin, at_), "")};
  if (text_[begin] == '!' && at_ == begin + 1) return {replace(span(begin, at_), "not ")};
  if (text_[begin] == '#' && starts_line_ && text_.substr(begin).starts_with("#include")) return {};
  if (text_[begin] == '#' && starts_line_) return {replace(span(begin, at_), "//")};
  return {};
}

}  // namespace wale
