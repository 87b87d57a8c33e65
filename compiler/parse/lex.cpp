#include "compiler/parse/lex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/lexer.hpp"

namespace wale {
namespace {

struct Spelling {
  std::string_view text;
  TokenKind kind;
};

constexpr Spelling reserved_words[] = {
    {"if", TokenKind::word_if},   {"then", TokenKind::word_then}, {"else", TokenKind::word_else},
    {"in", TokenKind::word_in},   {"on", TokenKind::word_on},     {"from", TokenKind::word_from},
    {"and", TokenKind::word_and}, {"or", TokenKind::word_or},     {"not", TokenKind::word_not},
};

constexpr std::size_t longest_reserved_word = [] {
  std::size_t longest = 0;
  for (const Spelling& each : reserved_words) longest = std::max(longest, each.text.size());
  return longest;
}();

/// Spellings that begin alike stand together, the longer ones first, so that `<=` is not read as `<` and `=`.
constexpr Spelling punctuation[] = {
    {"..", TokenKind::range},
    {".x", TokenKind::part_x},
    {".y", TokenKind::part_y},
    {"<=", TokenKind::less_equal},
    {"<", TokenKind::less},
    {">=", TokenKind::greater_equal},
    {">", TokenKind::greater},
    {"+-", TokenKind::plus_minus},
    {"+", TokenKind::plus},
    {"-", TokenKind::minus},
    {"*", TokenKind::star},
    {"/", TokenKind::slash},
    {"^", TokenKind::caret},
    {"(", TokenKind::left_parenthesis},
    {")", TokenKind::right_parenthesis},
    {"[", TokenKind::left_bracket},
    {"]", TokenKind::right_bracket},
    {"{", TokenKind::left_brace},
    {"}", TokenKind::right_brace},
    {",", TokenKind::comma},
    {";", TokenKind::semicolon},
    {":", TokenKind::colon},
    {"=", TokenKind::equals},
    {"±", TokenKind::plus_minus},
    {"'", TokenKind::prime},
    {"%", TokenKind::percent},
};

/// By first byte: where in `punctuation` the spellings that begin with it are, or its size.
constexpr auto first_spelling = [] {
  std::array<std::uint8_t, 256> first{};
  first.fill(std::size(punctuation));
  for (std::size_t i = std::size(punctuation); i-- > 0;)
    first[static_cast<unsigned char>(punctuation[i].text.front())] = static_cast<std::uint8_t>(i);
  return first;
}();

/// A name of ASCII letters and Greek ones, which become `u`.
std::string with_u(std::string_view name) {
  std::string ascii;
  for (std::size_t at = 0; at < name.size(); at += decode(name, at).bytes)
    ascii += is_micro(decode(name, at).code) ? 'u' : name[at];
  return ascii;
}

}  // namespace

Tokens Lexer::run() {
  if (is_readable()) {
    result_.tokens.reserve(text_.size() / 4);      // about as many as there are
    if (decode(text_, 0).code == 0xFEFF) at_ = 3;  // the byte order mark that some editors write
    while (at_ < text_.size() && diagnostics_.all().size() < error_limit) next();
  } else {
    at_ = text_.size();
  }
  add(TokenKind::end, at_);
  return std::move(result_);
}

bool Lexer::is_readable() {
  if (text_.size() > largest_source) {
    report(
        Code::too_long, 0, 0,
        fmt::format("this file has {:.1f} MB; Wale reads up to {} MB", text_.size() / 1048576.0, largest_source >> 20),
        "keep measurements in an image or a table of their own, or split the file and `import` its parts", {},
        {{"size", NumberWithUnit{text_.size() / 1048576.0, "MB"}},
         {"limit", NumberWithUnit{largest_source / 1048576.0, "MB"}}});
    return false;
  }
  for (std::size_t at = 0;;) {
    at = end_of_ascii(at);
    if (at == text_.size()) return true;
    const Character character = decode(text_, at);
    if (!character.valid || character.code == 0) {
      report(Code::invalid_encoding, at, at + 1,
             character.code == 0 ? "a NUL byte: this is not a text file"
                                 : fmt::format("the byte {:#04x} is not UTF-8", static_cast<unsigned char>(text_[at])),
             character.code == 0 ? "Wale files are plain text" : "save the file as UTF-8");
      return false;
    }
    at += character.bytes;
  }
}

/// The first byte from `at` on that is no ASCII character, or NUL; eight at a time, since nearly all are.
std::size_t Lexer::end_of_ascii(std::size_t at) const {
  constexpr std::uint64_t ones = 0x0101010101010101, tops = 0x8080808080808080;
  for (std::uint64_t eight; at + sizeof eight <= text_.size(); at += sizeof eight) {
    std::memcpy(&eight, text_.data() + at, sizeof eight);
    if (((eight | (eight - ones)) & tops) != 0) break;  // a top bit is set, or something borrowed one
  }
  while (at < text_.size() && text_[at] > 0) ++at;
  return at;
}

void Lexer::next() {
  const char c = text_[at_], after = at_ + 1 < text_.size() ? text_[at_ + 1] : ' ';
  if (c == ' ') {
    while (++at_ < text_.size() && text_[at_] == ' ') {
    }
  } else if (c == '\n') {
    starts_line_ = true;
    ++at_;
  } else if (begins_name(c)) {
    name();
  } else if (is_digit(c) || (c == '.' && is_digit(after))) {
    number();
  } else if (c == '/' && after == '/') {
    line_comment();
  } else if (c == '/' && after == '*') {
    block_comment();
  } else if (c == '"') {
    text(1);
  } else if (may_be_lookalike() || !symbol()) {
    const Character character = decode(text_, at_);
    if (is_blank(character.code)) {
      at_ += character.bytes;
    } else if (is_foreign_letter(character.code)) {
      name();
    } else if (!(may_be_lookalike() && (quote() || lookalike())) && !symbol()) {
      unknown(character);
    }
  }
}

void Lexer::line_comment() {
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  const std::string_view comment = text_.substr(at_, end - at_);
  if (comment.starts_with("///") && !comment.starts_with("////")) {
    std::string_view line = comment.substr(3);
    if (line.starts_with(' ')) line.remove_prefix(1);
    // Only ASCII's blanks: the last byte of a letter may be that of another one.
    while (!line.empty() && static_cast<unsigned char>(line.back()) <= ' ') line.remove_suffix(1);
    std::string& documentation = result_.documentation[result_.tokens.size()];
    if (!documentation.empty()) documentation += '\n';
    documentation += line;
  }
  at_ = end;
}

void Lexer::block_comment() {
  const std::size_t end = text_.find("*/", at_ + 2);
  if (end == std::string_view::npos) {
    report(Code::unterminated_text, at_, at_ + 2, "this comment does not end", "close it with `*/`");
    at_ = text_.size();
    return;
  }
  if (text_.substr(at_, end - at_).find('\n') != std::string_view::npos) starts_line_ = true;
  at_ = end + 2;
}

void Lexer::number() {
  const std::size_t begin = at_;
  if (starts("0x") && at_ + 2 < text_.size() && std::isxdigit(static_cast<unsigned char>(text_[at_ + 2]))) {
    return hexadecimal();
  }
  digits();
  if (at_ + 1 < text_.size() && text_[at_] == '.' && is_digit(text_[at_ + 1])) {
    ++at_;
    digits();
  } else if (at_ < text_.size() && text_[at_] == '.' && !starts("..")) {
    ++at_;
    report(Code::unexpected_character, begin, at_, "a number does not end in a point",
           fmt::format("write `{0}` or `{0}.0`", text_.substr(begin, at_ - 1 - begin)),
           {replace(span(at_ - 1, at_), "")});
  }
  if (text_[begin] == '.') {
    report(Code::unexpected_character, begin, at_, "a number begins with a digit",
           fmt::format("write `0{}`", text_.substr(begin, at_ - begin)), leading_zero(begin));
  }
  exponent();
  const std::string_view digits = text_.substr(begin, at_ - begin);
  double value = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status == std::errc::result_out_of_range) return out_of_range(begin, digits);
  add(TokenKind::number, begin, add_number(value));
}

void Lexer::digits() {
  while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
}

/// `e-3`; an `e` that no digits follow is the beginning of a unit's name.
void Lexer::exponent() {
  std::size_t at = at_;
  if (at == text_.size() || (text_[at] != 'e' && text_[at] != 'E')) return;
  ++at;
  if (at < text_.size() && (text_[at] == '+' || text_[at] == '-')) ++at;
  if (at == text_.size() || !is_digit(text_[at])) return;
  at_ = at;
  digits();
}

void Lexer::name() {
  const std::size_t begin = at_;
  bool micro = false, foreign = false;
  for (;;) {
    const auto end = std::find_if_not(text_.begin() + at_, text_.end(), continues_name);
    at_ = static_cast<std::size_t>(end - text_.begin());
    if (end == text_.end()) break;
    if (is_dot_in_name()) {
      ++at_;
      continue;
    }
    if (*end > 0) break;  // another ASCII character
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
  if (foreign) {
    // A name may be used many times; once is enough to say what is wrong with it.
    if (reported_names_.emplace(word).second) {
      report(Code::unexpected_character, begin, at_,
             fmt::format("names are written in the letters a to z; `{}` is not", word),
             "rename it with a-z, A-Z, 0-9 and `_`; texts in quotes may hold any letter");
    }
  } else if (micro) {
    const std::string ascii = with_u(word);
    report(Code::unexpected_character, begin, at_, fmt::format("`{}` is written without the Greek letter", word),
           fmt::format("write `{}`", ascii), {replace(span(begin, at_), ascii)});
    result_.texts.push_back(ascii);
    return add(TokenKind::name, begin, static_cast<std::uint32_t>(result_.texts.size()));
  }
  if (word.size() <= longest_reserved_word)
    for (const Spelling& reserved : reserved_words)
      if (word.front() == reserved.text.front() && word == reserved.text) return add(reserved.kind, begin);
  add(TokenKind::name, begin);
}

/// A text whose opening quote is `quote_bytes` long; one that opens typographically may close so.
void Lexer::text(std::size_t quote_bytes) {
  const std::size_t begin = at_;
  const bool typographic = quote_bytes > 1;
  std::string value;
  at_ += quote_bytes;
  while (at_ < text_.size() && text_[at_] != '\n') {
    if (text_[at_] == '"') {
      ++at_;
      return add_text(begin, std::move(value));
    }
    if (text_[at_] == '\\') {
      value += escape();
      continue;
    }
    if (typographic) {
      for (const std::string_view mark : typographic_quotes) {
        if (!starts(mark)) continue;
        at_ += mark.size();
        return add_text(begin, std::move(value));
      }
    }
    const std::size_t plain = at_++;
    while (!typographic && at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\\' && text_[at_] != '\n') ++at_;
    value.append(text_, plain, at_ - plain);
  }
  if (at_ > begin && text_[at_ - 1] == '\r') --at_;
  if (!typographic) {
    report(Code::unterminated_text, begin, at_, "this text does not end", "close it with `\"` on the same line");
  }
  add_text(begin, std::move(value));
}

char Lexer::escape() {
  const std::size_t begin = at_;
  const char c = at_ + 1 < text_.size() ? text_[at_ + 1] : '\n';
  if (c == '\n') {
    ++at_;
    return '\\';
  }
  const Character character = decode(text_, at_ + 1);
  at_ += 1 + character.bytes;
  if (c == 'n') return '\n';
  if (c != '"' && c != '\\') {
    report(Code::unexpected_character, begin, at_,
           fmt::format("`{}` means nothing in a text", text_.substr(begin, at_ - begin)),
           "write `\\\\` for a backslash, `\\\"` for a quote, `\\n` for a new line; paths are written with `/`");
  }
  return c;
}

bool Lexer::symbol() {
  const char first = text_[at_];
  for (std::size_t i = first_spelling[static_cast<unsigned char>(first)]; i < std::size(punctuation); ++i) {
    const Spelling& each = punctuation[i];
    if (each.text.front() != first) break;
    if (!starts(each.text)) continue;
    if ((each.kind == TokenKind::part_x || each.kind == TokenKind::part_y) && !is_part()) continue;
    const std::size_t begin = at_;
    at_ += each.text.size();
    const auto index = static_cast<std::uint32_t>(result_.tokens.size());
    add(each.kind, begin);
    match_brackets(each.kind, index);
    return true;
  }
  return false;
}

/// Whether `.x` here is a part of what the parenthesis right before it closes.
bool Lexer::is_part() const {
  if (result_.tokens.empty()) return false;
  const Token& last = result_.tokens.back();
  const char next = at_ + 2 < text_.size() ? text_[at_ + 2] : ' ';
  const bool goes_on =
      (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z') || next == '_' || (next >= '0' && next <= '9');
  return last.kind == TokenKind::right_parenthesis && last.end == at_ && !goes_on;
}

/// Finds which bracket closes which, for the parser's recovery. A brace ends the parentheses that are open inside it:
/// one forgotten `)` must not swallow the rest of the file.
void Lexer::match_brackets(TokenKind kind, std::uint32_t index) {
  const auto close = [&](TokenKind opening) {
    while (!open_.empty()) {
      const std::uint32_t candidate = open_.back();
      const TokenKind found = result_.tokens[candidate].kind;
      if (found != opening && (opening != TokenKind::left_brace || found == TokenKind::left_brace)) return;
      open_.pop_back();
      if (found != opening) continue;
      result_.tokens[candidate].value = index;
      return;
    }
  };
  switch (kind) {
    case TokenKind::left_parenthesis:
    case TokenKind::left_bracket:
    case TokenKind::left_brace: open_.push_back(index); break;
    case TokenKind::right_parenthesis: close(TokenKind::left_parenthesis); break;
    case TokenKind::right_bracket: close(TokenKind::left_bracket); break;
    case TokenKind::right_brace: close(TokenKind::left_brace); break;
    default: break;
  }
}

void Lexer::add_text(std::size_t begin, std::string value) {
  result_.texts.push_back(std::move(value));
  add(TokenKind::text, begin, static_cast<std::uint32_t>(result_.texts.size() - 1));
}

std::uint32_t Lexer::add_number(double value) {
  result_.numbers.push_back(value);
  return static_cast<std::uint32_t>(result_.numbers.size() - 1);
}

void Lexer::add(TokenKind kind, std::size_t begin, std::uint32_t value) {
  result_.tokens.push_back(
      {kind, starts_line_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(at_), value});
  starts_line_ = false;
}

void Lexer::report(Code code, std::size_t begin, std::size_t end, std::string message, std::string help,
                   std::vector<Fix> fixes, std::vector<Fact> facts, std::string rule) {
  diagnostics_.report({.code = code,
                       .span = span(begin, end),
                       .message = std::move(message),
                       .help = std::move(help),
                       .facts = std::move(facts),
                       .rule = std::move(rule),
                       .fixes = std::move(fixes)});
}

Tokens lex(const SourceSet& sources, SourceId source, Diagnostics& diagnostics) {
  return Lexer(sources[source].text, source, diagnostics).run();
}

}  // namespace wale
