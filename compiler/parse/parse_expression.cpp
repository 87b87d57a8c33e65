#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/parser.hpp"

namespace wale {
namespace {

struct InfixOperator {
  TokenKind token;
  BinaryOperator op;
  int precedence = 0;  ///< 0 for tokens that are not infix operators
};

/// Higher binds tighter. `not` is between `and` and the comparisons. A power binds tightest, and to the right: see
/// `raised`.
constexpr int disjunction_precedence = 1, conjunction_precedence = 2, comparison_precedence = 3, sum_precedence = 4,
              product_precedence = 5;
constexpr InfixOperator infix_operators[] = {
    {TokenKind::word_or, BinaryOperator::disjunction, disjunction_precedence},
    {TokenKind::word_and, BinaryOperator::conjunction, conjunction_precedence},
    {TokenKind::less, BinaryOperator::less, comparison_precedence},
    {TokenKind::less_equal, BinaryOperator::less_equal, comparison_precedence},
    {TokenKind::greater, BinaryOperator::greater, comparison_precedence},
    {TokenKind::greater_equal, BinaryOperator::greater_equal, comparison_precedence},
    {TokenKind::plus, BinaryOperator::add, sum_precedence},
    {TokenKind::minus, BinaryOperator::subtract, sum_precedence},
    {TokenKind::star, BinaryOperator::multiply, product_precedence},
    {TokenKind::slash, BinaryOperator::divide, product_precedence},
};

/// By kind of token.
constexpr auto infix = [] {
  std::array<InfixOperator, static_cast<std::size_t>(TokenKind::unreadable) + 1> table{};
  for (const InfixOperator& each : infix_operators) table[static_cast<std::size_t>(each.token)] = each;
  return table;
}();

/// In declarations these words after a number say how well it is known; they are not units.
constexpr std::string_view evidence_words[] = {"measured",    "published", "estimated", "recalled",
                                               "transferred", "simulated", "assumed"};

std::vector<Fact> limit_fact(std::size_t limit) { return {{"limit", NumberWithUnit{static_cast<double>(limit), ""}}}; }

}  // namespace

/// Reads a whole expression. An unreadable one becomes `Erroneous`, so that the name it defines is still declared.
ExprId Parser::expression() {
  const std::size_t begin = at_;
  const std::size_t nesting = nesting_;
  try {
    last_expression_ = operation(0);
  } catch (const Abandon&) {
    nesting_ = nesting;
    skip_statement();
    last_expression_ = erroneous(begin);
  }
  return *last_expression_;
}

ExprId Parser::operation(int least_precedence) {
  int most_precedence = product_precedence;
  ExprId left;
  if (here().kind == TokenKind::word_not && least_precedence <= comparison_precedence && !ends_statement(at_)) {
    left = complement();
    most_precedence = conjunction_precedence;
  } else {
    left = signed_operand();
  }
  for (;;) {
    const InfixOperator& found = infix[static_cast<std::size_t>(here().kind)];
    if (found.precedence == 0 || found.precedence < least_precedence || found.precedence > most_precedence) break;
    if (ends_statement(at_)) break;
    advance();
    const ExprId right = operation(found.precedence + 1);
    left = add(Binary{found.op, left, right}, joined(tree_.span(left), tree_.span(right)), {left, right});
    // `a < b < c` would compare a condition with a number, which nobody means.
    if (found.precedence <= comparison_precedence) most_precedence = conjunction_precedence;
  }
  return left;
}

void Parser::nested_too_deep() {
  complain_at(Code::nested_too_deep, span_of(here()),
              fmt::format("an expression nested more than {} deep", deepest_nesting), {}, {},
              "name parts of it with `let`", {}, {}, limit_fact(deepest_nesting));
  throw Abandon{};
}

/// Reads a `not` and its operand: `not a < b` means `not (a < b)`.
ExprId Parser::complement() {
  nest();
  const std::size_t begin = at_;
  advance();
  const ExprId operand = operation(comparison_precedence);
  --nesting_;
  return add(Unary{UnaryOperator::complement, operand}, joined(span_of(token(begin)), tree_.span(operand)), {operand});
}

/// Reads an operand with its sign. Everything else that nests passes through here, so depth is counted here.
ExprId Parser::signed_operand() {
  nest();
  const TokenKind sign = here().kind;
  const bool is_signed = (sign == TokenKind::minus || sign == TokenKind::plus) && !ends_statement(at_);
  const ExprId result = is_signed ? negated() : power();
  --nesting_;
  return result;
}

/// Reads a sign and its operand.
ExprId Parser::negated() {
  const std::size_t begin = at_;
  const UnaryOperator op = at(TokenKind::minus) ? UnaryOperator::negate : UnaryOperator::plus;
  advance();
  const ExprId operand = signed_operand();
  return add(Unary{op, operand}, joined(span_of(token(begin)), tree_.span(operand)), {operand});
}

ExprId Parser::power() {
  const ExprId base = operand();
  const TokenKind next = here().kind;
  const bool goes_on = next == TokenKind::caret || next == TokenKind::part_x || next == TokenKind::part_y;
  return goes_on ? raised(base) : base;
}

/// Reads what follows a value: a part of a vector, an exponent. `-2^2` is -4, `2^-1` is 0.5, `2^3^2` is 2^9.
ExprId Parser::raised(ExprId base) {
  while (at(TokenKind::part_x) || at(TokenKind::part_y)) {
    const char part = at(TokenKind::part_x) ? 'x' : 'y';
    const Span span = joined(tree_.span(base), span_of(here()));
    advance();
    base = add(Part{base, part}, span, {base});
  }
  if (!at(TokenKind::caret)) return base;
  advance();
  const ExprId exponent = signed_operand();
  return add(Binary{BinaryOperator::power, base, exponent}, joined(tree_.span(base), tree_.span(exponent)),
             {base, exponent});
}

ExprId Parser::operand() {
  const bool next_statement = here().starts_line && begins_statement(at_);
  if (!ends_statement(at_) && !next_statement) {
    switch (here().kind) {
      case TokenKind::number: return number();
      case TokenKind::text: return text();
      case TokenKind::name: return followed_by(TokenKind::left_parenthesis) ? call() : name();
      case TokenKind::left_parenthesis: return parenthesised();
      case TokenKind::word_if: return conditional();
      default: break;
    }
  }
  no_operand(next_statement);
}

/// Reports the token here, where a value was expected.
void Parser::no_operand(bool next_statement) {
  const std::string message = "expected a value" + after_previous();
  std::string help;
  std::vector<Fix> fixes;
  if (at_ > 1 && kind(at_ - 1) == TokenKind::word_in && kind(at_ - 2) == TokenKind::number) {
    help = fmt::format("a range follows `in`; for inches write `{} inch`", spelling(token(at_ - 2)));
    fixes = {replace(span_of(token(at_ - 1)), "inch", {}, false)};
  }
  if (next_statement) {
    const Span end = span_of(token(at_ - 1));
    complain_at(Code::unexpected_token, {end.source, end.end, end.end}, message, "a value", "the end of the line",
                std::move(help), std::move(fixes));
    throw Abandon{};
  }
  if (!help.empty()) fail(message, "a value", std::move(help), std::move(fixes));
  switch (here().kind) {
    case TokenKind::left_bracket:
      help = at_ > 0 && kind(at_ - 1) == TokenKind::word_in ? "a range is written `in 1 mm .. 5 mm`"
                                                            : "write vectors as `vector(a, b)`";
      break;
    case TokenKind::left_brace: help = "write vectors as `vector(a, b)`"; break;
    case TokenKind::prime: help = "texts stand in straight double quotes: `\"…\"`"; break;
    case TokenKind::word_not: help = "put `not` and its condition in parentheses"; break;
    case TokenKind::star:
    case TokenKind::slash: help = "an operator needs a value on both sides; the one before it is missing"; break;
    case TokenKind::plus_minus: help = "write `-`, or `+` and a space before the `-`"; break;
    case TokenKind::word_in:
    case TokenKind::word_on:
    case TokenKind::word_from:
    case TokenKind::word_then:
    case TokenKind::word_else:
      help = fmt::format("`{}` is a word of the language, not a name", spelling(here()));
      break;
    default:
      if (!open_parentheses_.empty() && token(open_parentheses_.back()).value == 0) help = unclosed_parenthesis();
  }
  fail(message, "a value", std::move(help));
}

ExprId Parser::number() {
  const std::size_t begin = at_;
  NumberLiteral literal{input_.numbers[here().value], {static_cast<std::uint32_t>(tree_.suffix_factors.size()), 0}};
  advance();
  while (suffix_factor()) ++literal.suffix.count;
  return add(literal, since(begin));
}

/// Whether the token may be a unit after a number. `check` decides whether it is one.
bool Parser::is_suffix_name(std::size_t index) const {
  if (ends_statement(index)) return false;
  if (kind(index) == TokenKind::percent) return true;
  if (kind(index) != TokenKind::name) return false;
  if (token(index).starts_line && begins_statement(index)) return false;
  if (in_force_ && is_word(index, "limit")) return false;
  if (in_range_ && (is_word(index, "soft") || is_word(index, "cell") || is_word(index, "to")) &&
      begins_number(index + 1))
    return false;
  if (is_like(index)) return false;
  const TokenKind next = kind(index + 1);
  if (!ends_statement(index + 1) && (next == TokenKind::left_parenthesis || next == TokenKind::colon)) return false;
  return !in_setting_ || !is_evidence(index);
}

std::vector<std::string> Parser::words_of_evidence() {
  return {std::begin(evidence_words), std::end(evidence_words)};
}

bool Parser::is_evidence(std::size_t index) const {
  return !ends_statement(index) &&
         std::ranges::any_of(evidence_words, [&](std::string_view word) { return is_word(index, word); });
}

/// Reads one of the names after a number: `N`, `/ s`, `m^2`, `s^-1`. `/ x^2.5` is an ordinary division and not read.
bool Parser::suffix_factor() {
  const TokenKind first = here().kind;
  if (first != TokenKind::name && first != TokenKind::slash && first != TokenKind::percent) return false;
  const bool divides = at(TokenKind::slash);
  const std::size_t name = at_ + (divides ? 1 : 0);
  if (!is_suffix_name(name)) return false;
  SuffixFactor factor{{spelling(token(name)), span_of(token(name))}, divides, 1};
  std::size_t next = name + 1;
  if (kind(next) == TokenKind::caret && !ends_statement(next)) {
    const bool negative = kind(next + 1) == TokenKind::minus;
    const Token& digits = token(next + (negative ? 2 : 1));
    constexpr double largest_exponent = 99;
    const double exponent = digits.kind == TokenKind::number ? input_.numbers[digits.value] : 0.5;
    const bool whole = exponent == std::floor(exponent) && exponent <= largest_exponent;
    if (!whole && divides) return false;
    if (!whole) {
      at_ = next + 1;
      fail(fmt::format("the power of `{}` after a number must be a whole number", factor.name.text), "a whole number",
           fmt::format("if `{0}` is not a unit, write `* {0}^…`", factor.name.text));
    }
    factor.exponent = static_cast<int>(negative ? -exponent : exponent);
    next += negative ? 3 : 2;
  }
  tree_.suffix_factors.push_back(factor);
  at_ = next;
  return true;
}

ExprId Parser::text() {
  // `"wet glass"(roughness: 0.3)`: a material has its arguments behind whichever of its names is written.
  if (followed_by(TokenKind::left_parenthesis)) return call();
  const std::size_t begin = at_;
  const TextLiteral literal{input_.texts[here().value]};
  advance();
  return add(literal, since(begin));
}

ExprId Parser::name() {
  const Word name = take_word();
  return add(NameUse{name.text}, name.span);
}

ExprId Parser::call() {
  const std::size_t begin = at_;
  Call call{{}, {}, at(TokenKind::text)};
  if (call.quoted) {
    call.callee = {input_.texts[here().value], span_of(here())};
    advance();
  } else {
    call.callee = take_word();
  }
  const std::size_t first_argument = open_arguments_.size();
  open_parentheses_.push_back(at_);
  advance();
  std::size_t highest = 0;
  ExprId highest_argument = 0;
  bool named = false;
  while (!at(TokenKind::right_parenthesis)) {
    const std::size_t argument_begin = at_;
    const Argument last = argument();
    open_arguments_.push_back(last);
    if (named && !last.name) {
      const std::size_t after = at_;
      at_ = argument_begin - 1;  // the comma, for it may have been meant as a decimal point
      std::string help = mend_here();
      std::vector<Fix> fixes = fixes_here();
      if (help.empty() && kind(after) == TokenKind::equals) {  // `duty = 0.5`
        at_ = after;
        help = mend_argument();
        fixes = fixes_here();
      }
      if (help.empty()) help = "put it before those with a name, or give it a name too";
      at_ = after;
      complain_at(Code::unexpected_token, tree_.span(last.value),
                  "arguments without a name must come before those with one", "`name: value`",
                  shown(token(argument_begin)), std::move(help), std::move(fixes));
      throw Abandon{};
    }
    named = named || last.name;
    if (heights_[last.value] > highest) highest = heights_[last.value], highest_argument = last.value;
    if (!at(TokenKind::comma)) break;
    advance();
  }
  close_parenthesis("`,` or `)`");
  const auto arguments = open_arguments_.begin() + static_cast<std::ptrdiff_t>(first_argument);
  call.arguments = {static_cast<std::uint32_t>(tree_.call_arguments.size()),
                    static_cast<std::uint32_t>(open_arguments_.end() - arguments)};
  tree_.call_arguments.insert(tree_.call_arguments.end(), arguments, open_arguments_.end());
  open_arguments_.erase(arguments, open_arguments_.end());
  const Span span = since(begin);
  if (highest == 0) return add(call, span);
  return add(call, span, {highest_argument});
}

Argument Parser::argument() {
  if (!at(TokenKind::name) || !followed_by(TokenKind::colon)) return {std::nullopt, operation(0)};
  const Word name = take_word();
  advance();
  return {name, operation(0)};
}

ExprId Parser::parenthesised() {
  const std::size_t begin = at_;
  open_parentheses_.push_back(at_);
  advance();
  const ExprId inner = operation(0);
  if (at(TokenKind::comma)) {
    fail("expected `)`" + after_previous(), "`)`",
         mend_here().empty() ? "write vectors as `vector(a, b)`" : mend_here(),
         mend_here().empty() ? std::vector{insert_before(span_of(token(begin)), "vector", {}, false)} : fixes_here());
  }
  close_parenthesis("`)`");
  tree_.expr_spans[inner] = since(begin);
  return inner;
}

void Parser::close_parenthesis(std::string_view expected) {
  if (!at(TokenKind::right_parenthesis)) {
    const std::string message = fmt::format("expected {}{}", expected, after_previous());
    const bool closed_later = token(open_parentheses_.back()).value > 0;
    if (here().starts_line && (begins_statement(at_) || !closed_later)) {
      const Span end = span_of(token(at_ - 1));
      complain_at(Code::unexpected_token, {end.source, end.end, end.end}, message, std::string(expected),
                  "the end of the line", unclosed_parenthesis(), {insert_after(end, ")", {}, false)},
                  {{span_of(token(open_parentheses_.back())), "opened here"}});
      throw Abandon{};
    }
    std::string help = mend_here();
    if (here().starts_line && closed_later) help = "separate arguments by commas";
    if (help.empty()) help = unclosed_parenthesis();
    const bool is_argument = here().kind == TokenKind::name && expected.starts_with("`,`");
    if (is_argument && kind(at_ + 1) != TokenKind::colon) help += ", and commas between arguments";
    const bool parts = here().kind == TokenKind::semicolon && closed_later && expected.starts_with("`,`");
    if (parts) help = "arguments are parted by commas";
    fail(message, std::string(expected), std::move(help),
         parts ? std::vector{replace(span_of(here()), ",")} : fixes_here(),
         {{span_of(token(open_parentheses_.back())), "opened here"}});
  }
  advance();
  open_parentheses_.pop_back();
}

std::string Parser::unclosed_parenthesis() const {
  const LineColumn opened = sources_.place(span_of(token(open_parentheses_.back())));
  return fmt::format("close the `(` in line {}, column {}", opened.line, opened.column);
}

/// Whether a value begins at the token, in this statement.
bool Parser::begins_operand(std::size_t index) const {
  if (ends_statement(index)) return false;
  switch (kind(index)) {
    case TokenKind::name: return !(token(index).starts_line && begins_statement(index));
    case TokenKind::number:
    case TokenKind::left_parenthesis:
    case TokenKind::word_if: return true;
    default: return false;
  }
}

/// Whether the `then` or the `else` of the `if` that is being read comes further on. Others belong to an `if` inside.
bool Parser::has_word_for_this_if(TokenKind word) const {
  std::size_t conditions = 0, values = 0;  // of `if` inside: that have no `then` yet, and no `else`
  for (std::size_t index = at_; !ends_statement(index) && kind(index) != TokenKind::end; ++index) {
    if (token(index).starts_line && begins_statement(index)) return false;
    switch (kind(index)) {
      case TokenKind::left_parenthesis:
        if (token(index).value == 0) return false;
        index = token(index).value;
        break;
      case TokenKind::right_parenthesis:
      case TokenKind::comma: return false;
      case TokenKind::word_if: ++conditions; break;
      case TokenKind::word_then:
        if (conditions == 0) return word == TokenKind::word_then;
        --conditions, ++values;
        break;
      case TokenKind::word_else:
        if (values == 0) return word == TokenKind::word_else;
        --values;
        break;
      default: break;
    }
  }
  return false;
}

ExprId Parser::conditional() {
  const std::size_t begin = at_;
  advance();
  const ExprId condition = operation(0);
  if (!at(TokenKind::word_then)) {
    // The last name before an `else` may be the value, read as a unit of the condition: `if x < 5 mm k else 0 N`.
    const bool is_unit =
        at(TokenKind::word_else) && kind(at_ - 1) == TokenKind::name && kind(at_ - 2) == TokenKind::name;
    const std::size_t value = at_ - (is_unit ? 1 : 0);
    const bool lacks_then = (is_unit || begins_operand(at_)) && !has_word_for_this_if(TokenKind::word_then);
    std::string help = lacks_then ? fmt::format("write `then` before `{}`", spelling(token(value))) : mend_here();
    if (help.empty()) help = "a conditional is written `if … then … else …`";
    fail("expected `then`" + after_previous(), "`then`", std::move(help),
         lacks_then ? std::vector{insert_before(span_of(token(value)), "then ", {}, !is_unit)} : fixes_here());
  }
  advance();
  const ExprId yes = operation(0);
  if (!at(TokenKind::word_else)) {
    const bool chained = is_word(at_, "elif") || is_word(at_, "elseif") || is_word(at_, "elsif");
    if (chained)
      fail("expected `else`" + after_previous(), "`else`", "write `else if`", {replace(span_of(here()), "else if")});
    if (begins_operand(at_) && !has_word_for_this_if(TokenKind::word_else))
      fail("expected `else`" + after_previous(), "`else`", fmt::format("write `else` before `{}`", spelling(here())),
           {insert_before(span_of(here()), "else ", {}, false)});
    if (begins_operand(at_)) fail("expected `else`" + after_previous(), "`else`", mend_here(), fixes_here());
    fail("expected `else`" + after_previous(), "`else`",
         "an `if` needs a value for the other case: `if … then … else …`");
  }
  advance();
  const ExprId no = operation(0);
  return add(Conditional{condition, yes, no}, since(begin), {condition, yes, no});
}

void Parser::grown_too_high(Span span) {
  complain_at(Code::nested_too_deep, span,
              fmt::format("an expression of more than {} steps in a row", highest_expression), {}, {},
              "name parts of it with `let`", {}, {}, limit_fact(highest_expression));
  throw Abandon{};
}

}  // namespace wale
