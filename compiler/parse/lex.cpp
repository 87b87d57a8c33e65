#include "compiler/parse/lex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/lexer.hpp"

namespace wale {
namespace {

struct Spelling {
  std::string_view text;
  TokenKind kind;
};

/// Spellings with the same first character are adjacent, the longer ones first, so that `<=` is not read as `<` and
/// `=`.
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

/// By first byte: the index in `punctuation` of the first spelling that begins with it, or the table's size if none
/// does.
constexpr auto first_spelling = [] {
  std::array<std::uint8_t, 256> first{};
  first.fill(std::size(punctuation));
  for (std::size_t i = std::size(punctuation); i-- > 0;)
    first[static_cast<unsigned char>(punctuation[i].text.front())] = static_cast<std::uint8_t>(i);
  return first;
}();

/// By byte: its token, if no longer spelling begins with it; otherwise `unreadable`. A byte that begins a lookalike is
/// such a token only if it is not doubled.
constexpr auto lone_symbols = [] {
  std::array<TokenKind, 256> table{};
  table.fill(TokenKind::unreadable);
  for (const Spelling& each : punctuation) {
    const char first = each.text.front();
    const auto begins_so = [&](const Spelling& other) { return other.text.front() == first; };
    if (each.text.size() == 1 && std::count_if(std::begin(punctuation), std::end(punctuation), begins_so) == 1)
      table[static_cast<unsigned char>(first)] = each.kind;
  }
  return table;
}();

/// By byte: whether it ends the part of a text that can be taken over unchanged: a quote, an escape or the line's end.
constexpr auto ends_plain_text = [] {
  std::array<bool, 256> table{};
  for (const char c : {'"', '\\', '\n', '\0'}) table[static_cast<unsigned char>(c)] = true;
  return table;
}();

constexpr Spelling words[] = {
    {"if", TokenKind::word_if},   {"then", TokenKind::word_then}, {"else", TokenKind::word_else},
    {"in", TokenKind::word_in},   {"on", TokenKind::word_on},     {"from", TokenKind::word_from},
    {"and", TokenKind::word_and}, {"or", TokenKind::word_or},     {"not", TokenKind::word_not},
};

/// The kind of a word: a name, or one of the reserved words, all of which are short.
TokenKind kind_of_word(std::string_view word) {
  constexpr std::size_t longest = 4;
  if (word.size() > longest) return TokenKind::name;
  const auto found = std::ranges::find(words, word, &Spelling::text);
  return found == std::end(words) ? TokenKind::name : found->kind;
}

bool is_bracket(TokenKind kind) { return kind >= TokenKind::left_parenthesis && kind <= TokenKind::right_brace; }

/// The kinds of tokens by their first byte, so that one look-up per token decides.
enum class Beginning : std::uint8_t { other, name, number, symbol, slash, quote };
constexpr auto beginnings = [] {
  std::array<Beginning, 256> table{};
  for (int c = 0; c < 128; ++c) {
    if (lone_symbols[c] != TokenKind::unreadable) table[c] = Beginning::symbol;
    if (begins_name(static_cast<char>(c))) table[c] = Beginning::name;
    if (is_digit(static_cast<char>(c))) table[c] = Beginning::number;
  }
  table['/'] = Beginning::slash;
  table['"'] = Beginning::quote;
  return table;
}();

}  // namespace

bool continues(TokenKind kind) {
  switch (kind) {
    case TokenKind::comma:
    case TokenKind::equals:
    case TokenKind::range:
    case TokenKind::plus:
    case TokenKind::minus:
    case TokenKind::star:
    case TokenKind::slash:
    case TokenKind::caret:
    case TokenKind::less:
    case TokenKind::less_equal:
    case TokenKind::greater:
    case TokenKind::greater_equal:
    case TokenKind::plus_minus:
    case TokenKind::word_and:
    case TokenKind::word_or:
    case TokenKind::word_not:
    case TokenKind::word_if:
    case TokenKind::word_then:
    case TokenKind::word_else: return true;
    default: return false;
  }
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
  for (std::size_t at = 0; at < text_.size();) {
    if (text_[at] > 0) {  // ASCII, as nearly always
      ++at;
      continue;
    }
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
  return true;
}

// Nearly all of a file: names, numbers, symbols of one character, and the space between them.

void Lexer::name() {
  const std::size_t begin = at_;
  do {
    const char* end = text_.data() + at_ + 1;
    while (continues_name(*end)) ++end;
    at_ = static_cast<std::size_t>(end - text_.data());
  } while (is_dot_in_name());
  if (here() < 0 && is_foreign_letter(decode(text_, at_).code)) {
    at_ = begin;
    return foreign_name();
  }
  add(kind_of_word({text_.data() + begin, at_ - begin}), begin);
}

void Lexer::add_symbol(TokenKind kind, std::size_t bytes) {
  const auto index = static_cast<std::uint32_t>(result_.tokens.size());
  at_ += bytes;
  add(kind, at_ - bytes);
  if (is_bracket(kind)) match_brackets(kind, index);
}

void Lexer::next() {
  const char* at = text_.data() + at_;
  for (;; ++at) {
    while (*at == ' ') ++at;
    if (*at != '\n') break;
    starts_line_ = true;
  }
  at_ = static_cast<std::size_t>(at - text_.data());
  if (at_ == text_.size()) return;
  switch (beginnings[static_cast<unsigned char>(*at)]) {
    case Beginning::name: return name();
    case Beginning::number: return number();
    case Beginning::symbol: {
      const auto byte = static_cast<unsigned char>(here());
      if (begins_lookalike[byte] && may_be_lookalike()) break;
      return add_symbol(lone_symbols[byte], 1);
    }
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

Tokens Lexer::run() {
  if (is_readable()) {
    result_.tokens.reserve(text_.size() / 4);  // about as many as there are
    result_.numbers.reserve(text_.size() / 32);
    result_.texts.reserve(text_.size() / 128);
    if (decode(text_, 0).code == 0xFEFF) at_ = 3;  // the byte order mark that some editors write
    while (at_ < text_.size() && !is_full_) next();
  } else {
    at_ = text_.size();
  }
  add(TokenKind::end, at_);
  return std::move(result_);
}

void Lexer::line_comment() {
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  const std::string_view comment = text_.substr(at_, end - at_);
  if (comment.starts_with("///") && !comment.starts_with("////")) {
    std::string_view line = comment.substr(3);
    if (line.starts_with(' ')) line.remove_prefix(1);
    // Only ASCII blanks: the last byte of a UTF-8 letter may equal that of another character.
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
  if (at_ + 1 < text_.size() && text_[at_] == '.' && is_digit(text_[at_ + 1])) return several_points(begin);
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

/// Reads `1.2.3`. What it means is not known, so that nothing else is said of it; groups of three digits are thousands.
void Lexer::several_points(std::size_t begin) {
  bool thousands = text_[begin] != '.';
  for (std::size_t group = text_.find('.', begin); group < text_.size() && text_[group] == '.'; group = at_) {
    if (group + 1 >= text_.size() || !is_digit(text_[group + 1])) break;
    at_ = group + 1;
    digits();
    thousands = thousands && at_ - group == 4;
  }
  std::string without(text_.substr(begin, at_ - begin));
  std::erase(without, '.');
  report(Code::unexpected_character, begin, at_,
         fmt::format("`{}` has more than one point", text_.substr(begin, at_ - begin)),
         thousands ? fmt::format("write `{}`, without points between thousands", without)
                   : std::string("a number has one point, before its decimals"),
         {});
  add(TokenKind::unreadable, begin);
}

void Lexer::digits() {
  while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
}

/// Reads `e-3`. An `e` without digits after it begins a unit's name instead.
void Lexer::exponent() {
  std::size_t at = at_;
  if (at == text_.size() || (text_[at] != 'e' && text_[at] != 'E')) return;
  ++at;
  if (at < text_.size() && (text_[at] == '+' || text_[at] == '-')) ++at;
  if (at == text_.size() || !is_digit(text_[at])) return;
  at_ = at;
  digits();
}

/// Reads a text whose opening quote is `quote_bytes` long. After a typographic quote, a typographic quote may close it.
void Lexer::text(std::size_t quote_bytes) {
  const std::size_t begin = at_, inside = at_ + quote_bytes;
  const bool typographic = quote_bytes > 1;
  at_ = inside;
  while (!typographic && !ends_plain_text[static_cast<unsigned char>(here())]) ++at_;
  if (typographic || here() != '"') return rewritten_text(begin, inside, typographic);
  ++at_;
  add_text(begin, text_.substr(inside, at_ - 1 - inside));  // as nearly always: no escapes
}

/// Reads the rest of a text with escapes, whose value differs from its spelling.
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
    add_symbol(each.kind, each.text.size());
    return true;
  }
  return false;
}

/// Whether a line that begins with such a token begins a statement, rather than continuing the line above.
bool Lexer::is_statement_line(TokenKind kind) const {
  // No statement begins with these, so they may also begin the second line of a long conditional.
  if (kind == TokenKind::word_then || kind == TokenKind::word_else) return false;
  return !result_.tokens.empty() && !continues(result_.tokens.back().kind);
}

/// Whether `.x` here is a part of a vector: it directly follows a `)`.
bool Lexer::is_part() const {
  if (result_.tokens.empty()) return false;
  const Token& last = result_.tokens.back();
  const char next = at_ + 2 < text_.size() ? text_[at_ + 2] : ' ';
  const bool goes_on =
      (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z') || next == '_' || (next >= '0' && next <= '9');
  return last.kind == TokenKind::right_parenthesis && last.end == at_ && !goes_on;
}

/// Finds the matching brackets, for the parser's recovery. A closing brace also ends the parentheses that are open
/// inside its block, so that one forgotten `)` does not swallow the rest of the file.
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
  is_full_ = diagnostics_.all().size() >= error_limit;
}

Tokens lex(const SourceSet& sources, SourceId source, Diagnostics& diagnostics) {
  return Lexer(sources, source, diagnostics).run();
}

}  // namespace wale
