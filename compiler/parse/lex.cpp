#include "compiler/parse/lex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/lookalikes.hpp"
#include "compiler/text/characters.hpp"
#include "compiler/text/utf8.hpp"

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

/// Longer spellings first, so that `<=` is not read as `<` and `=`.
constexpr Spelling punctuation[] = {
    {"..", TokenKind::range},
    {".x", TokenKind::part_x},
    {".y", TokenKind::part_y},
    {"<=", TokenKind::less_equal},
    {">=", TokenKind::greater_equal},
    {"+-", TokenKind::plus_minus},
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
    {"+", TokenKind::plus},
    {"-", TokenKind::minus},
    {"*", TokenKind::star},
    {"/", TokenKind::slash},
    {"^", TokenKind::caret},
    {"<", TokenKind::less},
    {">", TokenKind::greater},
    {"±", TokenKind::plus_minus},
    {"'", TokenKind::prime},
    {"%", TokenKind::percent},
};

/// A name of ASCII letters and Greek ones, which become `u`.
std::string with_u(std::string_view name) {
  std::string ascii;
  for (std::size_t at = 0; at < name.size(); at += decode(name, at).bytes)
    ascii += is_micro(decode(name, at).code) ? 'u' : name[at];
  return ascii;
}

/// What stands between the first two backticks: the token in "`^` for a power".
std::string quoted_token(std::string_view text) {
  const std::size_t begin = text.find('`') + 1;
  return std::string(text.substr(begin, text.find('`', begin) - begin));
}

class Lexer {
 public:
  Lexer(std::string_view text, SourceId source, Diagnostics& diagnostics)
      : text_(text), source_(source), diagnostics_(diagnostics) {}

  Tokens run() {
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

 private:
  bool is_readable() {
    if (text_.size() > largest_source) {
      report(Code::too_long, 0, 0,
             fmt::format("this file has {:.1f} MB; Wale reads up to {} MB", text_.size() / 1048576.0,
                         largest_source >> 20),
             "keep measurements in an image or a table of their own, or split the file and `import` its parts", {},
             {{"size", NumberWithUnit{text_.size() / 1048576.0, "MB"}},
              {"limit", NumberWithUnit{largest_source / 1048576.0, "MB"}}});
      return false;
    }
    for (std::size_t at = 0; at < text_.size();) {
      if (text_[at] > 0) {  // ASCII
        ++at;
        continue;
      }
      const Character character = decode(text_, at);
      if (!character.valid || character.code == 0) {
        report(Code::invalid_encoding, at, at + 1,
               character.code == 0
                   ? "a NUL byte: this is not a text file"
                   : fmt::format("the byte {:#04x} is not UTF-8", static_cast<unsigned char>(text_[at])),
               character.code == 0 ? "Wale files are plain text" : "save the file as UTF-8");
        return false;
      }
      at += character.bytes;
    }
    return true;
  }

  void next() {
    const Character character = decode(text_, at_);
    const char c = text_[at_];
    if (c == '\n') {
      starts_line_ = true;
      ++at_;
    } else if (is_blank(character.code)) {
      at_ += character.bytes;
    } else if (starts("//")) {
      line_comment();
    } else if (starts("/*")) {
      block_comment();
    } else if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) {
      number();
    } else if (begins_name(c) || is_foreign_letter(character.code)) {
      name();
    } else if (c == '"') {
      text(1);
    } else if (!(may_be_lookalike() && (quote() || lookalike())) && !symbol()) {
      unknown(character);
    }
  }

  bool starts(std::string_view spelling) const {
    // Tables of spellings are tried one by one: most differ in their first byte.
    return text_[at_] == spelling.front() && text_.substr(at_).starts_with(spelling);
  }

  void line_comment() {
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

  void block_comment() {
    const std::size_t end = text_.find("*/", at_ + 2);
    if (end == std::string_view::npos) {
      report(Code::unterminated_text, at_, at_ + 2, "this comment does not end", "close it with `*/`");
      at_ = text_.size();
      return;
    }
    if (text_.substr(at_, end - at_).find('\n') != std::string_view::npos) starts_line_ = true;
    at_ = end + 2;
  }

  void number() {
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

  /// A `0` before the point, unless it would become part of the word that touches it.
  std::vector<Fix> leading_zero(std::size_t begin) const {
    if (begin > 0 && (continues_name(text_[begin - 1]) || text_[begin - 1] == '.')) return {};
    return {insert_before(span(begin, at_), "0")};
  }

  void digits() {
    while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
  }

  /// `e-3`; an `e` that no digits follow is the beginning of a unit's name.
  void exponent() {
    std::size_t at = at_;
    if (at == text_.size() || (text_[at] != 'e' && text_[at] != 'E')) return;
    ++at;
    if (at < text_.size() && (text_[at] == '+' || text_[at] == '-')) ++at;
    if (at == text_.size() || !is_digit(text_[at])) return;
    at_ = at;
    digits();
  }

  void out_of_range(std::size_t begin, std::string_view digits) {
    // from_chars leaves the value alone; strtod says in which direction it went out of range.
    const double size = std::strtod(std::string(digits).c_str(), nullptr);
    report(Code::number_out_of_range, begin, at_,
           std::isinf(size) ? "this number is too large to hold" : "this number is too close to zero to hold",
           "use a unit of another size", {},
           {{"least", NumberWithUnit{1e-300, ""}}, {"greatest", NumberWithUnit{1e300, ""}}},
           "numbers reach from 1e-300 to 1e300");
    add(TokenKind::unreadable, begin);
  }

  void hexadecimal() {
    const std::size_t begin = at_;
    at_ += 2;
    while (at_ < text_.size() && std::isxdigit(static_cast<unsigned char>(text_[at_]))) ++at_;
    const double value = std::strtod(std::string(text_.substr(begin, at_ - begin)).c_str(), nullptr);
    report(Code::unexpected_character, begin, at_, "numbers are written in decimal", fmt::format("write `{}`", value),
           {replace(span(begin, at_), fmt::format("{}", value))});
    add(TokenKind::number, begin, add_number(value));
  }

  void name() {
    const std::size_t begin = at_;
    bool micro = false, foreign = false;
    while (at_ < text_.size()) {
      if (continues_name(text_[at_]) || is_dot_in_name()) {
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
    for (const Spelling& reserved : reserved_words) {
      if (word.front() == reserved.text.front() && word == reserved.text) return add(reserved.kind, begin);
    }
    add(TokenKind::name, begin);
  }

  /// `fabric.denim` is one name; the dots of `low..high` are none of it.
  bool is_dot_in_name() const { return text_[at_] == '.' && at_ + 1 < text_.size() && begins_name(text_[at_ + 1]); }

  /// Lookalikes are not ASCII, or else doubled, or `!=`; the rest need not be held against all of them.
  bool may_be_lookalike() const {
    const char c = text_[at_], next = at_ + 1 < text_.size() ? text_[at_ + 1] : ' ';
    const bool ascii = static_cast<unsigned char>(c) < 0x80;
    return !ascii || next == c || (c == '!' && next == '=');
  }

  bool quote() {
    for (const std::string_view mark : typographic_quotes) {
      if (starts(mark)) {
        const std::size_t begin = at_;
        text(mark.size());
        report(Code::unexpected_character, begin, begin + mark.size(), "a typographic quotation mark",
               "texts stand between straight quotes: write `\"`", quote_fixes(begin, begin + mark.size()));
        return true;
      }
    }
    return false;
  }

  /// Straight quotes for the text that has just been read, if it ends as it began. One that a straight quote ends may
  /// hold that quote rather than end there.
  std::vector<Fix> quote_fixes(std::size_t begin, std::size_t inside) const {
    Fix fix = replace(span(begin, inside), "\"", "write straight quotes");
    for (const std::string_view closing : typographic_quotes) {
      if (!text_.substr(inside, at_ - inside).ends_with(closing)) continue;
      fix.edits.push_back({span(at_ - closing.size(), at_), "\""});
      return {fix};
    }
    return {};
  }

  /// A text whose opening quote is `quote_bytes` long; one that opens typographically may close so.
  void text(std::size_t quote_bytes) {
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
      value += text_[at_++];
    }
    if (at_ > begin && text_[at_ - 1] == '\r') --at_;
    if (!typographic) {
      report(Code::unterminated_text, begin, at_, "this text does not end", "close it with `\"` on the same line");
    }
    add_text(begin, std::move(value));
  }

  char escape() {
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

  bool lookalike() {
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
        result_.texts.emplace_back(each.meant);
        add(TokenKind::name, begin, static_cast<std::uint32_t>(result_.texts.size()));
      }
      return true;
    }
    return false;
  }

  /// One that may mean several things is left to its author.
  std::vector<Fix> lookalike_fixes(const Lookalike& each, std::size_t begin) const {
    if (each.kind == TokenKind::unreadable) return {};
    return {replace(span(begin, at_), quoted_token(each.meant))};
  }

  bool symbol() {
    for (const Spelling& each : punctuation) {
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
  bool is_part() const {
    if (result_.tokens.empty()) return false;
    const Token& last = result_.tokens.back();
    const char next = at_ + 2 < text_.size() ? text_[at_ + 2] : ' ';
    const bool goes_on =
        (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z') || next == '_' || (next >= '0' && next <= '9');
    return last.kind == TokenKind::right_parenthesis && last.end == at_ && !goes_on;
  }

  /// Finds which bracket closes which, for the parser's recovery. A brace ends the parentheses that are open inside it:
  /// one forgotten `)` must not swallow the rest of the file.
  void match_brackets(TokenKind kind, std::uint32_t index) {
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

  /// A run of the same character is one mistake.
  void unknown(const Character& character) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && decode(text_, at_).code == character.code) at_ += character.bytes;
    const bool visible = character.code > ' ' && !(character.code >= 0x7F && character.code < 0xA0) &&
                         !(character.code >= 0x200B && character.code <= 0x206F) && character.code != 0xFEFF;
    report(Code::unexpected_character, begin, at_,
           visible ? fmt::format("Wale does not use the character `{}`", text_.substr(begin, character.bytes))
                   : fmt::format("the invisible character U+{:04X}", static_cast<std::uint32_t>(character.code)),
           help_for(text_[begin], visible), unknown_fixes(begin, visible));
    add(TokenKind::unreadable, begin);
  }

  /// What nobody sees is removed; a `#` at the beginning of a line begins a comment in many languages.
  std::vector<Fix> unknown_fixes(std::size_t begin, bool visible) const {
    if (!visible) return {replace(span(begin, at_), "")};
    if (text_[begin] == '#' && starts_line_) return {replace(span(begin, at_), "//")};
    return {};
  }

  static std::string help_for(char c, bool visible) {
    switch (c) {
      case '#': return "comments begin with `//`";
      case '!': return "values are compared with `<`, `<=`, `>` and `>=`; `if … then … else …` chooses";
      case '?': return "write `if … then … else …`";
      case '\\': return "a line goes on by itself after an operator, a comma, `=` or `..`, and inside parentheses";
      case '`': return "texts stand between straight quotes: write `\"`";
      default: return visible ? "remove it, or put it into a text or a comment" : "delete it";
    }
  }

  void add_text(std::size_t begin, std::string value) {
    result_.texts.push_back(std::move(value));
    add(TokenKind::text, begin, static_cast<std::uint32_t>(result_.texts.size() - 1));
  }

  std::uint32_t add_number(double value) {
    result_.numbers.push_back(value);
    return static_cast<std::uint32_t>(result_.numbers.size() - 1);
  }

  void add(TokenKind kind, std::size_t begin, std::uint32_t value = 0) {
    result_.tokens.push_back(
        {kind, starts_line_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(at_), value});
    starts_line_ = false;
  }

  Span span(std::size_t begin, std::size_t end) const {
    return {source_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }

  void report(Code code, std::size_t begin, std::size_t end, std::string message, std::string help,
              std::vector<Fix> fixes = {}, std::vector<Fact> facts = {}, std::string rule = {}) {
    diagnostics_.report({.code = code,
                         .span = span(begin, end),
                         .message = std::move(message),
                         .help = std::move(help),
                         .facts = std::move(facts),
                         .rule = std::move(rule),
                         .fixes = std::move(fixes)});
  }

  std::string_view text_;
  SourceId source_;
  Diagnostics& diagnostics_;
  Tokens result_;
  std::size_t at_ = 0;
  bool starts_line_ = true;
  std::vector<std::uint32_t> open_;  ///< brackets not yet closed
  std::set<std::string, std::less<>> reported_names_;
};

}  // namespace

Tokens lex(const SourceSet& sources, SourceId source, Diagnostics& diagnostics) {
  return Lexer(sources[source].text, source, diagnostics).run();
}

}  // namespace wale
