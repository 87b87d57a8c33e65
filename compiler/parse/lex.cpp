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

/// By first byte: whether a reserved word begins with it.
constexpr auto begins_reserved_word = [] {
  std::array<bool, 256> table{};
  for (const Spelling& each : reserved_words) table[static_cast<unsigned char>(each.text.front())] = true;
  return table;
}();

TokenKind kind_of_word(std::string_view word) {
  if (word.size() > longest_reserved_word || !begins_reserved_word[static_cast<unsigned char>(word.front())])
    return TokenKind::name;
  const auto found = std::ranges::find(reserved_words, word, &Spelling::text);
  return found == std::end(reserved_words) ? TokenKind::name : found->kind;
}

bool is_bracket(TokenKind kind) { return kind >= TokenKind::left_parenthesis && kind <= TokenKind::right_brace; }

/// What a token can be that begins with a byte, so that each byte is asked about once.
enum class Beginning : std::uint8_t { other, newline, name, number, slash, quote };
constexpr auto beginnings = [] {
  std::array<Beginning, 256> table{};
  for (int c = 0; c < 128; ++c) {
    if (begins_name(static_cast<char>(c))) table[c] = Beginning::name;
    if (is_digit(static_cast<char>(c))) table[c] = Beginning::number;
  }
  table['\n'] = Beginning::newline;
  table['/'] = Beginning::slash;
  table['"'] = Beginning::quote;
  return table;
}();

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
  while (here() == ' ') ++at_;
  if (at_ == text_.size()) return;
  switch (beginnings[static_cast<unsigned char>(here())]) {
    case Beginning::newline:
      starts_line_ = true;
      ++at_;
      return;
    case Beginning::name: return name();
    case Beginning::number: return number();
    case Beginning::quote: return text(1);
    case Beginning::slash:
      if (after() == '/') return line_comment();
      if (after() == '*') return block_comment();
      break;
    case Beginning::other:
      if (here() == '.' && is_digit(after())) return number();
      break;
  }
  if (!may_be_lookalike() && symbol()) return;
  const Character character = decode(text_, at_);
  if (is_blank(character.code)) {
    at_ += character.bytes;
  } else if (is_foreign_letter(character.code)) {
    foreign_name();
  } else if (!(may_be_lookalike() && (quote() || lookalike())) && !symbol()) {
    unknown(character);
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
  do {
    ++at_;
    while (continues_name(here())) ++at_;
  } while (is_dot_in_name());
  if (here() < 0 && is_foreign_letter(decode(text_, at_).code)) {
    at_ = begin;
    return foreign_name();
  }
  add(kind_of_word(text_.substr(begin, at_ - begin)), begin);
}

/// A text whose opening quote is `quote_bytes` long; one that opens typographically may close so.
void Lexer::text(std::size_t quote_bytes) {
  const std::size_t begin = at_, inside = at_ + quote_bytes;
  const bool typographic = quote_bytes > 1;
  at_ = inside;
  while (!typographic && here() != '"' && here() != '\\' && here() != '\n' && at_ < text_.size()) ++at_;
  if (typographic || here() != '"') return rewritten_text(begin, inside, typographic);
  ++at_;
  add_text(begin, text_.substr(inside, at_ - 1 - inside));  // as nearly always: what stands there
}

/// The rest of a text that is not what stands between its quotes.
void Lexer::rewritten_text(std::size_t begin, std::size_t inside, bool typographic) {
  std::string value(text_.substr(inside, at_ - inside));
  while (at_ < text_.size() && text_[at_] != '\n') {
    if (text_[at_] == '"') {
      ++at_;
      return add_text(begin, result_.rewrite(std::move(value)));
    }
    if (text_[at_] == '\\') {
      value += escape();
      continue;
    }
    if (typographic) {
      for (const std::string_view mark : typographic_quotes) {
        if (!starts(mark)) continue;
        at_ += mark.size();
        return add_text(begin, result_.rewrite(std::move(value)));
      }
    }
    value += text_[at_++];
  }
  if (at_ > begin && text_[at_ - 1] == '\r') --at_;
  if (!typographic) {
    report(Code::unterminated_text, begin, at_, "this text does not end", "close it with `\"` on the same line");
  }
  add_text(begin, result_.rewrite(std::move(value)));
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
    if (each.text.size() > 1 && !starts(each.text)) continue;
    if ((each.kind == TokenKind::part_x || each.kind == TokenKind::part_y) && !is_part()) continue;
    const std::size_t begin = at_;
    at_ += each.text.size();
    const auto index = static_cast<std::uint32_t>(result_.tokens.size());
    add(each.kind, begin);
    if (is_bracket(each.kind)) match_brackets(each.kind, index);
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

void Lexer::add_text(std::size_t begin, std::string_view value) {
  result_.texts.push_back(value);
  add(TokenKind::text, begin, static_cast<std::uint32_t>(result_.texts.size() - 1));
}

std::uint32_t Lexer::add_number(double value) {
  result_.numbers.push_back(value);
  return static_cast<std::uint32_t>(result_.numbers.size() - 1);
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
  return Lexer(sources, source, diagnostics).run();
}

}  // namespace wale
