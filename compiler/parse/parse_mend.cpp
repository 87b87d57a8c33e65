// Fixes for text that the parser cannot read. They look at the tokens around the current place.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/parser.hpp"
#include "compiler/text/characters.hpp"

namespace wale {
namespace {

bool begins_value(TokenKind kind) {
  switch (kind) {
    case TokenKind::name:
    case TokenKind::number:
    case TokenKind::text:
    case TokenKind::minus:
    case TokenKind::left_parenthesis:
    case TokenKind::word_if: return true;
    default: return false;
  }
}

/// The blanks at the beginning of the line that contains the byte `at`.
std::string_view indentation(std::string_view text, std::size_t at) {
  const std::size_t newline = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  std::size_t end = begin;
  while (end < at && (text[end] == ' ' || text[end] == '\t')) ++end;
  return text.substr(begin, end - begin);
}

/// The line ending of the text, "\n" or "\r\n", so that a fix keeps it.
std::string_view line_end(std::string_view text) {
  const std::size_t newline = text.find('\n');
  return newline != std::string_view::npos && newline > 0 && text[newline - 1] == '\r' ? "\r\n" : "\n";
}

}  // namespace

/// Whether the token is the first of an argument of a call that is open.
bool Parser::begins_argument(std::size_t index) const {
  if (open_parentheses_.empty() || index == 0) return false;
  const std::size_t open = open_parentheses_.back();
  const bool is_call = open > 0 && kind(open - 1) == TokenKind::name;
  return is_call && (index - 1 == open || kind(index - 1) == TokenKind::comma);
}

/// Whether the innermost open parenthesis is that of a call, in which values are parted by commas.
bool Parser::is_in_call() const {
  if (open_parentheses_.empty()) return false;
  const std::size_t open = open_parentheses_.back();
  return open > 0 && kind(open - 1) == TokenKind::name;
}

/// The same name twice, side by side: `period period`.
bool Parser::is_doubled() const {
  return at_ > 0 && kind(at_) == TokenKind::name && kind(at_ - 1) == TokenKind::name && !here().starts_line &&
         spelling(here()) == spelling(token(at_ - 1));
}

/// `0.1 in`, where no range can follow.
bool Parser::is_inch_here() const { return at(TokenKind::word_in) && at_ > 0 && kind(at_ - 1) == TokenKind::number; }

/// `lateral ridges` in a force, with a height of this file: heights make forces in functions alone.
bool Parser::is_call_without_parentheses() const {
  if (!in_force_ || at_ == 0 || kind(at_ - 1) != TokenKind::name || !at(TokenKind::name)) return false;
  bool is_height = false;
  for (std::size_t i = 0; i + 1 < at_; ++i) {
    if (kind(i) != TokenKind::name || kind(i + 1) != TokenKind::name) continue;
    constexpr std::string_view values[] = {"let", "param", "height", "state"};
    if (std::ranges::find(values, spelling(token(i))) == std::end(values)) continue;
    if (spelling(token(i + 1)) == spelling(token(at_ - 1))) return false;
    is_height = is_height || (spelling(token(i)) == "height" && spelling(token(i + 1)) == spelling(here()));
  }
  return is_height;
}

/// `force = lateral(h) where h = …`, and `with`, as other languages name a part of a formula behind it.
bool Parser::is_where_clause() const {
  if (!open_parentheses_.empty() || !(is_word(at_, "where") || is_word(at_, "with") || is_word(at_, "let"))) return false;
  return !here().starts_line && kind(at_ + 1) == TokenKind::name && kind(at_ + 2) == TokenKind::equals;
}

/// `like brick`, where a material is expected.
bool Parser::is_like(std::size_t index) const {
  if (!in_origin_ || !is_word(index, "like") || ends_statement(index + 1)) return false;
  return kind(index + 1) == TokenKind::name || kind(index + 1) == TokenKind::text;
}

/// The text of the value that begins at the token, or of its first part: a number with its unit.
std::string_view Parser::value_at(std::size_t index) const {
  const TokenKind next = kind(index + 1);
  const bool has_unit = kind(index) == TokenKind::number && (next == TokenKind::name || next == TokenKind::percent) &&
                        !ends_statement(index + 1);
  return text_.substr(token(index).begin, token(index + (has_unit ? 1 : 0)).end - token(index).begin);
}

/// The text from the token to the end of its statement.
std::string_view Parser::rest_of_statement(std::size_t index) const {
  std::size_t last = index;
  while (!ends_statement(last + 1)) ++last;
  return text_.substr(token(index).begin, token(last).end - token(index).begin);
}

/// The text of the value that ends before the token, or of its last part: a number with its unit.
std::string_view Parser::value_before(std::size_t index) const {
  const std::size_t last = index == 0 ? 0 : index - 1;
  const bool has_unit = (kind(last) == TokenKind::name || kind(last) == TokenKind::percent) && last > statement_begin_ &&
                        kind(last - 1) == TokenKind::number;
  return text_.substr(token(last - (has_unit ? 1 : 0)).begin, token(last).end - token(last - (has_unit ? 1 : 0)).begin);
}

/// What limits a force under another name, or inside of it.
std::string Parser::mend_limit() const {
  if (!in_force_ || !at(TokenKind::name)) return {};
  if (is_word(at_, "limit"))
    return fmt::format("`limit` ends a force and limits all of it: write `limit {}` at the end of the line, or give this "
                       "part a force of its own",
                       begins_number(at_ + 1) ? value_at(at_ + 1) : "…");
  constexpr std::string_view others[] = {"max", "maximum", "most", "cap", "capped", "upto", "saturate"};
  if (std::ranges::find(others, spelling(here())) == std::end(others) || !begins_number(at_ + 1)) return {};
  return fmt::format("a force is limited with `limit`: write `limit {}`", value_at(at_ + 1));
}

/// `wale = 1.2 mm` and `wale 1.2 mm` in the parentheses of a call.
std::string Parser::mend_argument() const {
  if (at_ == 0 || kind(at_ - 1) != TokenKind::name || !begins_argument(at_ - 1)) return {};
  const std::string_view name = spelling(token(at_ - 1));
  if (at(TokenKind::equals) && begins_value(kind(at_ + 1)))
    return fmt::format("arguments are named with `:`, as in `{}: {}`", name, value_at(at_ + 1));
  if (!at(TokenKind::number)) return {};
  const std::string named = fmt::format("`{}: {}`", name, value_at(at_));
  if (in_origin_) return "arguments are named with `:`, as in " + named;
  return fmt::format("to multiply, write `{} * {}`; to name an argument, {}", name, value_at(at_), named);
}

/// A material with its weight behind it, with a title that nothing weighs, or with `like` before it.
std::string Parser::mend_origin() const {
  if (!in_origin_ || at_ == 0 || !open_parentheses_.empty()) return {};
  const Token& previous = token(at_ - 1);
  if (is_like(at_)) return fmt::format("leave out `like`: write `{} {}`", spelling(previous), spelling(token(at_ + 1)));
  if (is_like(at_ - 1)) return fmt::format("leave out `like`: write `= {}`", spelling(here()));
  const bool is_weight = previous.kind == TokenKind::number || previous.kind == TokenKind::percent;
  if (at(TokenKind::text) && is_weight)
    return fmt::format("a title is weighed with `*`, as in `{} * {}`",
                       value_at(previous.kind == TokenKind::percent && at_ > 1 ? at_ - 2 : at_ - 1), spelling(here()));
  if (at(TokenKind::number) && previous.kind == TokenKind::name)
    return fmt::format("the weight stands first: write `{} {}`", spelling(here()), spelling(previous));
  if (at(TokenKind::name) && previous.kind == TokenKind::name)
    return fmt::format("to mix materials, write `0.5 {} + 0.5 {}`", spelling(previous), spelling(here()));
  return {};
}

/// What other languages write behind a value: a condition, the bounds of a range, inches as `"`.
std::string Parser::mend_other_order() const {
  if (at_ == 0 || !open_parentheses_.empty()) return {};
  const Token& previous = token(at_ - 1);
  if (at(TokenKind::word_if) && !here().starts_line) return "the condition comes first: write `if … then … else …`";
  const bool bounds = at(TokenKind::word_from) || is_word(at_, "from") || is_word(at_, "between") ||
                      is_word(at_, "min") || is_word(at_, "range");
  if (bounds && begins_number(at_ + 1)) return "a range is written `in 1 mm .. 5 mm`";
  // `0.1" in …`: the text begins at the sign for inches.
  const Token& text = previous.kind == TokenKind::text || at_ < 2 ? previous : token(at_ - 2);
  const std::size_t number = text.begin == previous.begin ? at_ - 2 : at_ - 3;
  if (text.kind == TokenKind::text && number < tokens_.size() && kind(number) == TokenKind::number &&
      token(number).end == text.begin)
    return fmt::format("for inches write `{} inch`", spelling(token(number)));
  return {};
}

std::vector<Fix> Parser::fix_argument() const {
  const Span behind_name = {tree_.source, token(at_ - 1).end, here().end};
  if (at(TokenKind::equals)) return {replace(behind_name, ":")};
  if (in_origin_) return {insert_after(span_of(token(at_ - 1)), ":")};
  return {insert_after(span_of(token(at_ - 1)), " *", "multiply with `*`", false)};
}

std::vector<Fix> Parser::fix_origin() const {
  const Token& previous = token(at_ - 1);
  const auto leave_out = [&](std::size_t like) {
    return replace(Span{tree_.source, token(like).begin, token(like + 1).begin}, "", "leave out `like`");
  };
  if (is_like(at_)) return {leave_out(at_)};
  if (is_like(at_ - 1)) return {leave_out(at_ - 1)};
  if (at(TokenKind::text)) return {insert_after(span_of(previous), " *", "multiply with `*`")};
  return {replace(Span{tree_.source, previous.begin, here().end},
                  fmt::format("{} {}", spelling(here()), spelling(previous)), {}, false)};
}

/// Whether a parenthesis opens here directly behind `curve(…)`.
bool Parser::is_call_of_curve() const {
  if (!at(TokenKind::left_parenthesis) || at_ == 0 || kind(at_ - 1) != TokenKind::right_parenthesis) return false;
  int depth = 0;
  for (std::size_t i = at_ - 1; i > 0; --i) {
    depth += kind(i) == TokenKind::right_parenthesis;
    depth -= kind(i) == TokenKind::left_parenthesis;
    if (depth == 0) return is_word(i - 1, "curve");
  }
  return false;
}

/// The text of the parentheses that open there, "(x)"; "(…)" if they do not close in their line.
std::string_view Parser::parentheses_at(std::size_t open) const {
  const std::size_t close = token(open).value;
  if (!closes_in_line(open) || close <= open) return "(…)";
  return text_.substr(token(open).begin, token(close).end - token(open).begin);
}

/// Whether the parenthesis that opens there closes in its line.
bool Parser::closes_in_line(std::size_t open) const {
  int depth = 0;
  for (std::size_t i = open; i == open || !(token(i).starts_line || kind(i) == TokenKind::end); ++i) {
    depth += kind(i) == TokenKind::left_parenthesis;
    depth -= kind(i) == TokenKind::right_parenthesis;
    if (depth == 0) return true;
  }
  return false;
}

/// Fixes for the cases of `mend_here` that a program can mend.
std::vector<Fix> Parser::fixes_here() const {
  if (at_ == 0) return {};
  if (is_doubled())
    return {replace(Span{tree_.source, token(at_ - 1).end, here().end}, "", "leave out the second",
                    kind(at_ + 1) == TokenKind::left_parenthesis || kind(at_ + 1) == TokenKind::colon)};
  if (!mend_argument().empty()) return fix_argument();
  if (!mend_limit().empty())
    return is_word(at_, "limit") ? std::vector<Fix>{} : std::vector{replace(span_of(here()), "limit", {}, false)};
  if (!mend_origin().empty()) return fix_origin();
  if (is_where_clause() || is_call_of_curve()) return {};
  if (at(TokenKind::comma) && in_force_ && open_parentheses_.empty() && is_word(at_ + 1, "limit"))
    return {replace(span_of(here()), "", "drop the comma")};
  const Token& previous = token(at_ - 1);
  const Token& next = here();
  const Token& after = token(at_ + 1);
  const bool number_before = previous.kind == TokenKind::number;
  const bool call = next.kind == TokenKind::name && after.kind == TokenKind::left_parenthesis;
  if (next.kind == TokenKind::name && after.kind == TokenKind::colon && !open_parentheses_.empty())
    return {insert_after(span_of(previous), ",", "part the arguments with a comma", false)};
  switch (next.kind) {
    case TokenKind::name:
    case TokenKind::left_parenthesis:
      if (mend_here().empty()) return {};
      if (begins_another_statement(next, after))
        return {replace(Span{tree_.source, previous.end, next.begin}, "; ", "part them with `;`", false)};
      // `2 sin(x)` and `2 (a + b)` can only be products, unless they are two arguments; `k hand` may lack any operator.
      if (is_in_call()) {
        std::vector<Fix> fixes = {insert_after(span_of(previous), " *", "multiply with `*`", false),
                                  insert_after(span_of(previous), ",", "part the arguments with a comma", false)};
        if (previous.kind == TokenKind::name && begins_argument(at_ - 1))
          fixes.push_back(insert_after(span_of(previous), ":", "name the argument", false));
        return fixes;
      }
      if (is_call_without_parentheses())
        return {replace(Span{tree_.source, previous.end, next.end}, "(" + std::string(spelling(next)) + ")", "call the function", false),
                insert_after(span_of(previous), " *", "multiply with `*`", false)};
      // In `(1 + 2(`, the last `(` is rather a mistyped `)`.
      return {insert_after(span_of(previous), " *", "multiply with `*`",
                           number_before && (call || next.kind == TokenKind::left_parenthesis) &&
                               closes_in_line(call ? at_ + 1 : at_))};
    case TokenKind::comma:
      if (mend_here().empty()) return {};
      if (previous.kind != TokenKind::number) return {replace(span_of(next), " +", "add the forces", false)};
      // Among arguments the comma may really be meant as a comma.
      return {replace(span_of(next), ".", "write a decimal point", open_parentheses_.empty())};
    case TokenKind::word_in: return is_inch_here() ? std::vector{replace(span_of(next), "inch")} : std::vector<Fix>{};
    case TokenKind::right_parenthesis:
      if (!open_parentheses_.empty()) return {};
      return {replace(span_of(next), "", {}, false)};
    default: return {};
  }
}

/// Inserts ` =` between a name and its value, unless the statement has a `=` further on.
std::vector<Fix> Parser::insert_equals() const {
  if (at_ == 0 || ends_statement(at_) || !begins_value(here().kind)) return {};
  for (std::size_t index = at_; !ends_statement(index); ++index)
    if (kind(index) == TokenKind::equals) return {};
  return {insert_after(span_of(token(at_ - 1)), " =", "write `=`")};
}

/// Inserts ` ..` between two numbers after `in`.
std::vector<Fix> Parser::insert_range() const {
  const bool minus = at(TokenKind::minus);
  bool number = at(TokenKind::number) || (minus && followed_by(TokenKind::number));
  // In `0.1 0.1 .. 0.6` the `..` is there, and a number too many.
  std::size_t behind = at_ + (minus ? 2 : 1);
  if (number && (kind(behind) == TokenKind::name || kind(behind) == TokenKind::percent)) ++behind;
  if (number && kind(behind) == TokenKind::range) number = false;
  return number ? std::vector{insert_after(span_of(token(at_ - 1)), " ..", "write `..`")} : std::vector<Fix>{};
}

/// Removes the token here; its neighbours stay separated.
std::vector<Fix> Parser::drop_here() const {
  const std::string what(spelling(here()));
  const Token& previous = token(at_ - 1);
  const Token& next = token(at_ + 1);
  if (ends_statement(at_ + 1)) return {};
  const bool apart = previous.end < here().begin || here().end < next.begin;
  const Span both = {tree_.source, previous.end < here().begin ? previous.end : here().begin, here().end};
  return {replace(apart ? both : span_of(here()), apart && here().end < next.begin ? "" : " ",
                  fmt::format("remove the `{}`", what))};
}

/// Moves an operator at the beginning of a line to the end of the line above, since no statement begins with one.
std::vector<Fix> Parser::move_operator_up() const {
  const Token& next = token(at_ + 1);
  if (at_ == 0 || next.starts_line || !begins_value(next.kind) || kind(at_ - 1) == TokenKind::left_brace) return {};
  // What a parameter is for ends its line, and nothing is added to a text.
  if (kind(at_ - 1) == TokenKind::text) return {};
  Fix fix = insert_after(span_of(token(at_ - 1)), " " + std::string(spelling(here())),
                         "end the line above with the operator");
  fix.edits.push_back({{tree_.source, here().begin, next.begin}, ""});
  return {fix};
}

/// Inserts ` {` at the end of a block's heading.
std::vector<Fix> Parser::insert_opening_brace() const {
  const bool heads_lines = here().starts_line && kind(at_) == TokenKind::name && !begins_declaration(at_);
  return heads_lines ? std::vector{insert_after(span_of(token(at_ - 1)), " {", "open the block")} : std::vector<Fix>{};
}

/// Inserts `}` on a line of its own below the block, or before the next token if that is on the same line.
std::vector<Fix> Parser::insert_brace(std::size_t open) const {
  const std::string_view text = sources_[tree_.source].text;
  const std::size_t last = token(at_ - 1).end;
  const std::size_t newline = std::min(text.find('\n', last), text.size());
  if (here().kind != TokenKind::end && here().begin < newline)
    return {insert_before(span_of(here()), "} ", "close the block")};
  // The end of this line may be inside a comment of several lines.
  if (text.substr(last, newline - last).find("/*") != std::string_view::npos) return {};
  const auto end = static_cast<std::uint32_t>(newline > last && text[newline - 1] == '\r' ? newline - 1 : newline);
  return {insert_before({tree_.source, end, end},
                        fmt::format("{}{}}}", line_end(text), indentation(text, token(open).begin)),
                        "close the block")};
}

/// Removes the quotes around a name; that of a module may be a path.
std::vector<Fix> Parser::unquote(bool is_module) const {
  if (!at(TokenKind::text)) return {};
  std::string name(input_.texts[here().value]);
  if (is_module) {
    constexpr std::string_view extension = ".wale";
    if (name.ends_with(extension)) name.resize(name.size() - extension.size());
    std::ranges::replace(name, '/', '.');
  }
  bool at_begin = true;
  for (const char c : name) {
    const bool fits = at_begin ? begins_name(c) : continues_name(c) || (is_module && c == '.');
    if (!fits) return {};
    at_begin = c == '.';
  }
  if (name.empty() || at_begin) return {};
  return {replace(span_of(here()), name)};
}

/// Inserts `wale 1` above everything else, or replaces an incomplete version. The fix is unsafe if the file does not
/// begin with a declaration, since it may not be a Wale file at all.
std::vector<Fix> Parser::state_version(bool is_wale, bool has_number, bool is_declaration) const {
  const std::string_view text = sources_[tree_.source].text;
  if (!is_wale) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    const std::uint32_t begin = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    return {insert_before({tree_.source, begin, begin}, fmt::format("wale 1{}", line_end(text)),
                          "write `wale 1` in the first line", is_declaration)};
  }
  // It is unknown which version `wale 0` was meant to be.
  const bool known = !has_number || input_.numbers[token(at_ + 1).value] == 1;
  const Span span = {tree_.source, here().begin, has_number ? token(at_ + 1).end : here().end};
  return {replace(span, "wale 1", {}, known)};
}

std::vector<Fix> Parser::respell_here(const std::vector<std::string>& candidates) const {
  return respell(span_of(here()), spelling(here()), candidates);
}

}  // namespace wale
