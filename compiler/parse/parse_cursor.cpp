#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/parser.hpp"

namespace wale {

namespace {

bool ends_value(TokenKind kind) {
  return kind == TokenKind::name || kind == TokenKind::part_x || kind == TokenKind::part_y ||
         kind == TokenKind::number || kind == TokenKind::right_parenthesis || kind == TokenKind::percent;
}

}  // namespace

bool Parser::is_word(std::size_t index, std::string_view word) const {
  const Token& candidate = token(index);
  return candidate.kind == TokenKind::name && candidate.end - candidate.begin == word.size() &&
         text_.substr(candidate.begin, word.size()) == word;
}

/// Whether a line that begins with the token can only be a new statement. Used after an incomplete expression, so that
/// an error in one line does not swallow the next.
bool Parser::begins_statement(std::size_t index) const {
  if (kind(index) != TokenKind::name) return false;
  const TokenKind next = kind(index + 1);
  if (next == TokenKind::prime) return kind(index + 2) == TokenKind::equals;
  if (next == TokenKind::equals) return is_word(index, "force");
  if (is_word(index, "force") && next == TokenKind::name) return kind(index + 2) == TokenKind::equals;
  if (next == TokenKind::number) return is_word(index, "patch");
  if (next == TokenKind::left_brace) {
    return is_word(index, "representative") || is_word(index, "perceptual") || is_word(index, "physical");
  }
  if (next != TokenKind::name || token(index + 1).starts_line) return false;
  for (const std::string_view word : {"param", "let", "height", "state", "memory", "next", "show", "essential"}) {
    if (is_word(index, word)) return true;
  }
  return begins_declaration(index);
}

/// Whether a declaration certainly begins at the token, even inside a block without its `}`.
bool Parser::begins_declaration(std::size_t index) const {
  if (kind(index) != TokenKind::name || kind(index + 1) != TokenKind::name) return false;
  if (is_word(index, "export")) return token(index + 1).starts_line == false;
  // The token after the two names is checked first: then few words remain to be compared.
  const auto is_one_of = [&](std::initializer_list<std::string_view> words) {
    return std::ranges::any_of(words, [&](std::string_view word) { return is_word(index, word); });
  };
  switch (kind(index + 2)) {
    case TokenKind::equals: return is_word(index, "material");
    case TokenKind::left_parenthesis: return is_word(index, "function");
    case TokenKind::word_from: return is_word(index, "map");
    case TokenKind::left_brace:
      return is_one_of({"material", "map", "percept", "threshold", "rule", "class", "device", "levels", "hand",
                        "workspace", "movie", "keys", "groups", "experiment"});
    default: return false;
  }
}

/// Reads the name that a declaration gives. `declares` is its keyword, "param", "state" and the like, for messages.
Word Parser::declared_name(std::string_view declares) {
  const bool reserved = here().kind >= TokenKind::word_if && here().kind <= TokenKind::word_not;
  if (reserved && !ends_statement(at_)) {
    complain(fmt::format("`{}` is a word of the language and cannot be a name", spelling(here())), "a name",
             fmt::format("call the {} something else", declares));
    return take_word();
  }
  if (!at(TokenKind::name)) {
    std::string help;
    if (at(TokenKind::number)) help = "names must begin with a letter";
    if (at(TokenKind::text)) help = "write names without quotes";
    // `height = grating(…)`: `height` was meant as the name, or the name was left out.
    if (at(TokenKind::equals) && at_ > 0)
      help = fmt::format("give it a name: `{} NAME = …`", spelling(token(at_ - 1)));
    fail(fmt::format("expected the name of the {}{}", declares, after_previous()), "a name", std::move(help),
         unquote(false));
  }
  // `param param k`
  if (is_doubled() && followed_by(TokenKind::name)) {
    complain(fmt::format("`{}` is written twice", spelling(here())), "a name", "leave one out", fixes_here());
    advance();
  }
  const Word name = take_word();
  if (name.text.find('.') != std::string_view::npos) {
    complain_at(Code::unexpected_token, name.span, fmt::format("the name of a {} cannot have dots", declares),
                "a plain name", fmt::format("`{}`", name.text),
                "dots are for names in other modules; write `_` instead");
  }
  const bool hyphen = at(TokenKind::minus) && followed_by(TokenKind::name) && here().begin == name.span.end &&
                      token(at_ + 1).begin == here().end;
  std::size_t behind = at_;
  while (kind(behind) == TokenKind::name && !token(behind).starts_line) ++behind;
  const bool ends_heading =
      kind(behind) == TokenKind::left_brace || (kind(behind) == TokenKind::equals && !token(behind).starts_line);
  const bool may_name_dimension = declares == "state" || declares == "memory";  // `state p position`, without its `:`
  const bool is_origin = declares == "material" && followed_by(TokenKind::name) &&
                         (is_word(at_, "extends") || is_word(at_, "inherits") || is_word(at_, "is") ||
                          is_word(at_, "of") || is_word(at_, "like"));
  const bool second_word = behind > at_ && ends_heading && !may_name_dimension && !is_origin;
  return hyphen || second_word ? joined_name(declares, name) : name;
}

/// A name of several words, `my cord` or `my-cord`, is reported and read as one.
Word Parser::joined_name(std::string_view declares, const Word& first) {
  const bool hyphen = at(TokenKind::minus);
  std::string text(first.text);
  Span span = first.span;
  while (at(TokenKind::name) || (at(TokenKind::minus) && followed_by(TokenKind::name))) {
    if (at(TokenKind::minus)) advance();
    const Word next = take_word();
    text += "_" + std::string(next.text);
    span.end = next.span.end;
  }
  const std::string written(text_.substr(span.begin, span.end - span.begin));
  // Other places of the file may use the name as it was written.
  complain_at(Code::unexpected_token, span,
              fmt::format("the name of a {} is one word{}", declares, hyphen ? " without `-`" : ""), "one name",
              fmt::format("`{}`", written), fmt::format("write `{}`", text), {replace(span, text, {}, false)});
  return {input_.rewrite(std::move(text)), span};
}

void Parser::missing(std::string_view spelling, std::string help, std::vector<Fix> fixes) {
  if (here().kind == TokenKind::unreadable && !ends_statement(at_)) throw Abandon{};
  complain(fmt::format("expected {}{}", spelling, after_previous()), std::string(spelling), std::move(help),
           std::move(fixes));
}

void Parser::complain_again(std::string_view what, std::size_t begin) {
  const Span again = since(begin), with_blanks = {again.source, token(begin - 1).end, again.end};
  complain_at(Code::unexpected_token, again, fmt::format("{} is given twice", what), "the end of the line",
              shown(token(begin)), "give it once", {replace(with_blanks, "", "leave out the second", false)});
}

/// A token as messages quote it; long texts are cut short.
std::string Parser::shown(const Token& token) const {
  constexpr std::size_t longest = 40;
  std::string text(spelling(token));
  if (text.size() > longest) {
    std::size_t cut = longest;
    while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0) == 0x80) --cut;
    text = text.substr(0, cut) + "…";
  }
  return "`" + text + "`";
}

std::string Parser::found_here() const {
  if (here().kind == TokenKind::end) return "the end of the file";
  const bool brace_here = here().kind == TokenKind::right_brace && !here().starts_line;
  if (!ends_statement(at_) || brace_here) return shown(here());
  return here().kind == TokenKind::semicolon ? "`;`" : "the end of the line";
}

std::string Parser::after_previous() const { return at_ == 0 ? "" : " after " + shown(token(at_ - 1)); }

std::string_view Parser::documentation_here() {
  auto found = input_.documentation.find(at_);
  // The comment of an exported declaration is above the word `export`.
  if (found == input_.documentation.end() && at_ > 0 && is_word(at_ - 1, "export"))
    found = input_.documentation.find(at_ - 1);
  return found == input_.documentation.end() ? std::string_view() : input_.rewrite(found->second);
}

/// The place of what is missing here: behind the last token of a line, else at the token here.
Span Parser::place_here() const {
  Span span = span_of(here());
  const bool after_last = here().starts_line || here().kind == TokenKind::end;
  if (ends_statement(at_) && after_last && at_ > 0) span.begin = span.end = token(at_ - 1).end;
  return span;
}

void Parser::complain(std::string message, std::string expected, std::string help, std::vector<Fix> fixes,
                      std::vector<SecondarySpan> secondary) {
  complain_at(Code::unexpected_token, place_here(), std::move(message), std::move(expected), found_here(), std::move(help),
              std::move(fixes), std::move(secondary));
}

void Parser::complain_at(Code code, Span span, std::string message, std::string expected, std::string found,
                         std::string help, std::vector<Fix> fixes, std::vector<SecondarySpan> secondary,
                         std::vector<Fact> facts) {
  // The lexer has reported unreadable tokens.
  if (here().kind == TokenKind::unreadable) reported_ = true;
  if (reported_) return;
  reported_ = true;
  diagnostics_.report({.code = code,
                       .span = span,
                       .message = std::move(message),
                       .expected = std::move(expected),
                       .found = std::move(found),
                       .help = std::move(help),
                       .secondary = std::move(secondary),
                       .facts = std::move(facts),
                       .fixes = std::move(fixes)});
  // After this many errors the rest of the file is skipped.
  if (diagnostics_.all().size() >= error_limit) {
    give_up();
  }
}

/// Skips the rest of the file and reports nothing more.
void Parser::give_up() {
  at_ = tokens_.size() - 1;
  brace_missing_ = true;
  throw Abandon{};
}

void Parser::count_statement() {
  statements_ += in_placed_ ? 1 : settings_per_statement;
  if (statements_ <= most_statements * settings_per_statement) return;
  reported_ = false;
  diagnostics_.report({.code = Code::too_long,
                       .span = span_of(here()),
                       .message = fmt::format("this file has more than {} statements", most_statements),
                       .help = "keep measurements in an image or a table of their own, or split the file and `import` "
                               "its parts",
                       .facts = {{"limit", NumberWithUnit{static_cast<double>(most_statements), ""}}}});
  give_up();
}

void Parser::fail(std::string message, std::string expected, std::string help, std::vector<Fix> fixes,
                  std::vector<SecondarySpan> secondary) {
  complain(std::move(message), std::move(expected), std::move(help), std::move(fixes), std::move(secondary));
  throw Abandon{};
}

/// Whether a word of the language stands here with what follows it at the beginning of a statement: `active 1 W`,
/// `material p`. The names of values may be the same words: `2 height`.
bool Parser::begins_another_statement(const Token& word, const Token& after) const {
  static constexpr std::string_view before_a_name[] = {"material", "param",    "let",     "height", "force",
                                                       "state",    "memory",   "next",    "show",   "import",
                                                       "unit",     "function", "percept", "device", "export"};
  static constexpr std::string_view before_a_number[] = {"active", "patch"};
  if (word.kind != TokenKind::name || ends_statement(at_ + 1)) return false;
  const auto holds = [&](std::span<const std::string_view> words) {
    return std::ranges::find(words, spelling(word)) != words.end();
  };
  return (after.kind == TokenKind::name && holds(before_a_name)) ||
         (after.kind == TokenKind::number && holds(before_a_number));
}

/// What to write instead of the token here, which cannot follow a complete value.
std::string Parser::mend_here() const {
  const Token& next = here();
  const Token& previous = token(at_ == 0 ? 0 : at_ - 1);
  const Token& after = token(at_ + 1);
  const bool touching = previous.end == next.begin;
  if (is_doubled()) return fmt::format("`{}` is written twice; leave one out", spelling(next));
  if (const std::string argument = mend_argument(); !argument.empty()) return argument;
  if (is_where_clause())
    return fmt::format("names are declared in lines of their own: write `{} {} = …` above",
                       in_force_ ? "height` or `let" : "let", spelling(after));
  if (const std::string origin = mend_origin(); !origin.empty()) return origin;
  if (const std::string other = mend_other_order(); !other.empty()) return other;
  switch (next.kind) {
    case TokenKind::name:
    case TokenKind::number:
    case TokenKind::left_parenthesis:
      if (!ends_value(previous.kind)) return {};
      if (next.kind == TokenKind::name && after.kind == TokenKind::colon && !open_parentheses_.empty())
        return fmt::format("put a comma before `{}`", spelling(next));
      if (const std::string limit = mend_limit(); !limit.empty()) return limit;
      // `at 10 mm 20 mm` of a patch of a workspace: nothing is multiplied there.
      if (in_placed_ && !in_origin_ && open_parentheses_.empty() && next.kind == TokenKind::number)
        return fmt::format("two values are parted by a comma: write `{}, {}`", value_before(at_), value_at(at_));
      if (begins_another_statement(next, after)) return fmt::format("put `{}` on a line of its own", spelling(next));
      if (is_call_of_curve())
        return fmt::format("give the curve a name: `let c = curve(…)`, then `c{}`", parentheses_at(at_));
      if (next.kind == TokenKind::left_parenthesis)
        return fmt::format("to multiply, write `{} * (…)`", spelling(previous));
      if (is_call_without_parentheses())
        return fmt::format("to call a function, write `{0}({1})`; to multiply, `{0} * {1}`", spelling(previous), spelling(next));
      return fmt::format("to multiply, write `{} * {}{}`", spelling(previous), spelling(next),
                         after.kind == TokenKind::left_parenthesis ? "(…)" : "") +
             (previous.kind == TokenKind::name && after.kind == TokenKind::left_parenthesis
                  ? fmt::format("; to call a function, `{}({}(…))`", spelling(previous), spelling(next))
                  : "");
    case TokenKind::comma:
      if (in_force_ && open_parentheses_.empty() && is_word(at_ + 1, "limit"))
        return "`limit` follows the force without a comma: drop it";
      if (previous.kind == TokenKind::number && touching && after.kind == TokenKind::number &&
          after.begin == next.end) {
        return fmt::format("write decimals with a point: `{}.{}`", spelling(previous), spelling(after));
      }
      return in_force_ && open_parentheses_.empty() ? "forces are added with `+`" : "";
    case TokenKind::percent:
      if (previous.kind != TokenKind::name && previous.kind != TokenKind::right_parenthesis) return {};
      return previous.kind == TokenKind::name && !ends_statement(at_ + 1)
                 ? fmt::format("the remainder is a function: write `modulo({}, {})`", spelling(previous),
                               value_at(at_ + 1))
                 : "the remainder is a function: `modulo(value, divisor)`";
    case TokenKind::text:
      if (previous.kind != TokenKind::text) return {};
      return fmt::format("texts are parted by commas: write `{}, {}`", spelling(previous), spelling(next));
    case TokenKind::left_bracket: return "the parts of a vector are `.x` and `.y`; Wale has no lists";
    case TokenKind::equals: return "`=` defines; compare values with `<`, `<=`, `>` and `>=`";
    case TokenKind::less:
    case TokenKind::less_equal:
    case TokenKind::greater:
    case TokenKind::greater_equal: return "comparisons cannot be chained; join two of them with `and`";
    case TokenKind::plus_minus: return "a tolerance belongs to a percept; to subtract, write `-`";
    case TokenKind::range: return "a range follows `in`: `in 1 mm .. 5 mm`";
    case TokenKind::colon:
      if (previous.kind == TokenKind::name && after.kind == TokenKind::name && open_parentheses_.empty())
        return fmt::format("nothing is assigned with `:`; write `{}(…)` to call it", spelling(previous));
      return "named arguments belong in the parentheses of a call";
    case TokenKind::right_parenthesis: return "it closes no `(`; remove it";
    case TokenKind::word_then:
    case TokenKind::word_else: return "write a conditional as `if … then … else …`";
    case TokenKind::word_in: return is_inch_here() ? fmt::format("for inches write `{} inch`", spelling(previous)) : "";
    default: return {};
  }
}

void Parser::end_statement() {
  if (!ends_statement(at_)) {
    // The value read so far is not the one that was meant: `2` in `2 sin(x)`.
    if (last_expression_) tree_.exprs[*last_expression_] = Erroneous{};
    fail("expected the end of the line" + after_previous(), "the end of the line", mend_here(), fixes_here());
  }
  if (here().kind == TokenKind::semicolon) advance();
}

/// Whether the `}` here is a typing error: the line continues after it in a way that is impossible after a block.
bool Parser::is_stray_brace() const {
  const Token& next = token(at_ + 1);
  if (here().starts_line || next.starts_line) return false;
  switch (next.kind) {
    case TokenKind::end:
    case TokenKind::semicolon:
    case TokenKind::right_brace: return false;
    case TokenKind::name:
      return token(at_ + 2).starts_line || (kind(at_ + 2) != TokenKind::left_brace && kind(at_ + 2) != TokenKind::name);
    default: return true;
  }
}

/// Goes to the end of an erroneous statement: past its parentheses if they are closed, past its block if it has one,
/// and to the next line.
void Parser::skip_statement() {
  const bool at_next = here().starts_line && at_ > statement_begin_ && begins_statement(at_);
  if (!open_parentheses_.empty() && !at_next) {
    at_ = std::max<std::size_t>(at_, token(open_parentheses_.front()).value);
  }
  open_parentheses_.clear();
  for (;; advance()) {
    switch (here().kind) {
      case TokenKind::end:
      case TokenKind::semicolon: return;
      case TokenKind::right_brace:
        if (is_stray_brace()) continue;
        return;
      case TokenKind::left_brace:
        at_ = here().value > 0 ? here().value : tokens_.size() - 1;
        advance();
        return;
      default: break;
    }
    const bool next_line = here().starts_line && at_ > statement_begin_;
    if (next_line && (ends_statement(at_) || begins_statement(at_))) return;
    const bool opens = here().kind == TokenKind::left_parenthesis || here().kind == TokenKind::left_bracket;
    if (opens && here().value > 0) at_ = here().value;
  }
}

}  // namespace wale
