// The statements of a physical block.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/parser.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

/// The keywords of physical statements, in the order of `PhysicalKeyword`; `x' = …` has no keyword.
const std::vector<std::string> physical_words = {"param",  "let",   "height", "force", "patch",
                                                 "active", "state", "memory", "next",  "show"};

}  // namespace

std::optional<PhysicalKeyword> physical_keyword_named(std::string_view word) {
  const auto found = std::ranges::find(physical_words, word);
  if (found == physical_words.end()) return std::nullopt;
  return static_cast<PhysicalKeyword>(found - physical_words.begin());
}

/// The kind of the statement here, by its first word. A misspelt word is reported and read as the one that was meant.
PhysicalKeyword Parser::physical_keyword() {
  if (here().kind == TokenKind::name) {
    if (followed_by(TokenKind::prime)) return PhysicalKeyword::prime;
    const std::string_view word = spelling(here());
    if (const auto known = physical_keyword_named(word)) return *known;
    const bool defines = followed_by(TokenKind::equals);
    const std::vector<std::string> candidates = defines ? std::vector<std::string>{"force"} : physical_words;
    const auto meant = nearest_spelling(std::string(word), candidates);
    const bool plausible = meant && (defines || followed_by(TokenKind::name) || *meant == "patch");
    if (plausible) {
      complain_at(Code::unexpected_token, span_of(here()), fmt::format("no statement begins with `{}`", word),
                  "`" + *meant + "`", fmt::format("`{}`", word), fmt::format("did you mean `{}`?", *meant),
                  respell_here(candidates), {}, {{"meant", *meant}});
      return *physical_keyword_named(*meant);
    }
    if (const auto borrowed = borrowed_keyword()) return *borrowed;
    if (defines) {
      complain_at(Code::unexpected_token, span_of(here()),
                  fmt::format("the definition of `{}` lacks its keyword", word), "`let`, `param`, `height` or `state`",
                  fmt::format("`{}`", word), fmt::format("write `let {} = …`", word),
                  {insert_before(span_of(here()), "let ", {}, false)});
      return PhysicalKeyword::equals;
    }
  }
  const bool operation = here().kind >= TokenKind::plus && here().kind <= TokenKind::greater_equal;
  complain_at(Code::unexpected_token, span_of(here()), fmt::format("no statement begins with {}", shown(here())),
              "`param`, `let`, `height`, `state`, `memory`, `force`, `patch`, `next`, `show` or `name' = …`",
              shown(here()),
              kind(at_) == TokenKind::minus && kind(at_ + 1) == TokenKind::minus && token(at_ + 1).begin == here().end
                  ? "comments begin with `//`"
              : operation && kind(at_ - 1) == TokenKind::text ? "nothing is added to a text; begin with what this line is"
              : operation ? "to continue on the next line, end the line above with the operator"
                          : mend_borrowed(spelling(here())),
              operation ? move_operator_up() : std::vector<Fix>{});
  throw Abandon{};
}

PhysicalStatement Parser::physical_statement() {
  const std::size_t begin = at_;
  PhysicalStatement result;
  switch (const PhysicalKeyword keyword = physical_keyword()) {
    case PhysicalKeyword::prime:
    case PhysicalKeyword::next: result.what = update(); break;
    case PhysicalKeyword::param: result.what = param(); break;
    case PhysicalKeyword::state: result.what = state(); break;
    case PhysicalKeyword::memory: result.what = memory(); break;
    case PhysicalKeyword::patch: result.what = patch(); break;
    case PhysicalKeyword::active: result.what = active(); break;
    case PhysicalKeyword::force: result.what = force(); break;
    case PhysicalKeyword::show:
      advance();
      result.what = ShowStatement{expression()};
      break;
    case PhysicalKeyword::height: {
      const auto [name, value] = definition(keyword);
      result.what = HeightStatement{name, value};
      break;
    }
    case PhysicalKeyword::let:
    case PhysicalKeyword::equals: {
      const auto [name, value] = definition(keyword);
      result.what = LetStatement{name, value};
      break;
    }
  }
  result.span = since(begin);
  return result;
}

/// Reads `let reach = …` or `height ribs = …`: a name and its value.
std::pair<Word, ExprId> Parser::definition(PhysicalKeyword keyword) {
  const bool is_height = keyword == PhysicalKeyword::height, has_keyword = keyword != PhysicalKeyword::equals;
  if (has_keyword) advance();
  const Word name = has_keyword ? declared_name(is_height ? "height" : "value") : take_word();
  if (!take(TokenKind::equals))
    missing("`=`", fmt::format("write `{} {} = …`", is_height ? "height" : "let", name.text), insert_equals());
  return {name, expression()};
}

/// Reads `force drag = viscous(2 N s/m) limit 3 N`.
ForceStatement Parser::force() {
  advance();
  ForceStatement force{};
  if (at(TokenKind::name) && followed_by(TokenKind::equals)) force.name = declared_name("force");
  // `force drag viscous(…)`, without its `=`: no value follows a value.
  const std::size_t second = at_ + 1;
  if (at(TokenKind::name) && !force.name && !is_doubled() && !ends_statement(second) &&
      (kind(second) == TokenKind::name || kind(second) == TokenKind::number || kind(second) == TokenKind::word_if))
    force.name = declared_name("force");
  const bool adds = at(TokenKind::plus) && followed_by(TokenKind::equals);
  if (adds) {
    complain("forces are added without `+=`", "`=`", "give each force a name: `force drag = …`, `force texture = …`",
             {replace(span_of(here()), "", "leave out the `+`", false)});
    advance();
  }
  if (!take(TokenKind::equals))
    missing("`=`", force.name ? fmt::format("write `force {} = …`", force.name->text) : "write `force = …`",
            insert_equals());
  in_force_ = true;
  force.value = expression();
  if (at(TokenKind::name) && is_word(at_, "limit")) {
    advance();
    if (at(TokenKind::colon) || at(TokenKind::equals)) {
      complain(fmt::format("`limit` has no {} after it", shown(here())), "a force",
               fmt::format("write `limit {}`", value_at(at_ + 1)), drop_here());
      advance();
    }
    force.limit = expression();
    while (at(TokenKind::name) && is_word(at_, "limit")) once("the limit of a force", [&] { advance(), expression(); });
  }
  return force;
}

/// Reads `param wale = 2.5 mm in 1 mm .. 5 mm "distance between ribs"`.
ParamStatement Parser::param() {
  ParamStatement param;
  param.documentation = documentation_here();
  advance();
  param.name = declared_name("parameter");
  if (at(TokenKind::colon) && followed_by(TokenKind::name) && kind(at_ + 2) == TokenKind::equals) {
    const Span dimension = {tree_.source, param.name.span.end, token(at_ + 1).end};
    complain_at(Code::unexpected_token, dimension, "a parameter has the dimension of its default", "`=`", shown(here()),
                fmt::format("write `param {} = …`", param.name.text),
                {replace(dimension, "", "leave out the dimension")});
    advance();
    advance();
  }
  if (!take(TokenKind::equals)) missing("`=`", fmt::format("write `param {} = …`", param.name.text), insert_equals());
  param.value = expression();
  param.range = optional_range();
  if (at(TokenKind::name) && is_word(at_, "soft") && begins_number(at_ + 1)) missing_comma("soft");
  if (at(TokenKind::comma) && is_word(at_ + 1, "soft")) {
    advance();
    advance();
    param.soft_range = range();
    while (at(TokenKind::comma) && is_word(at_ + 1, "soft"))
      once("the usual range", [&] { advance(), advance(), range(); });
  } else if (param.range && at(TokenKind::name) && is_word(at_, "soft")) {
    advance();
    param.soft_range = range();
  }
  if (at(TokenKind::comma) && followed_by(TokenKind::text)) no_comma("the description of a parameter");
  if (at(TokenKind::text)) {
    param.description = input_.texts[here().value];
    advance();
    while (at(TokenKind::text)) once("the description of a parameter", [&] { advance(); });
  }
  return param;
}

/// Reads `state p : position = hand in -60 mm .. 60 mm`.
StateStatement Parser::state() {
  advance();
  StateStatement state;
  state.name = declared_name("state");
  remembered_.push_back(state.name.text);
  state.dimension = optional_dimension();
  if (!take(TokenKind::equals))
    missing("`=`", fmt::format("a state needs an initial value: write `state {} = …`", state.name.text),
            insert_equals());
  state.value = expression();
  state.range = optional_range();
  return state;
}

/// Reads `memory track : length = 0 mm in 0 mm .. 5 mm, cell 1 mm`.
MemoryStatement Parser::memory() {
  advance();
  MemoryStatement memory{};
  memory.name = declared_name("memory");
  remembered_.push_back(memory.name.text);
  memory.dimension = optional_dimension();
  if (!take(TokenKind::equals)) missing("`=`", fmt::format("write `memory {} = …`", memory.name.text));
  memory.value = expression();
  memory.range = optional_range();
  const bool lacks_comma = at(TokenKind::name) && is_word(at_, "cell") && begins_number(at_ + 1);
  if (lacks_comma) missing_comma("cell");
  if (!lacks_comma && (!at(TokenKind::comma) || !is_word(at_ + 1, "cell")))
    fail("expected `, cell`" + after_previous(), "`, cell` and a length",
         "give the width of its cells, as in `memory track = 0 in 0 .. 1, cell 1 mm`");
  if (!lacks_comma) advance();
  advance();
  memory.cell = expression();
  while (at(TokenKind::comma) && is_word(at_ + 1, "cell"))
    once("the width of the cells", [&] { advance(), advance(), expression(); });
  return memory;
}

std::optional<Word> Parser::optional_dimension() {
  if (!at(TokenKind::colon)) return std::nullopt;
  advance();
  if (!at(TokenKind::name)) fail("expected a dimension" + after_previous(), "a dimension, as in `: length`", {});
  return take_word();
}

/// Reads `v' = …` or `next v = …`.
UpdateStatement Parser::update() {
  UpdateStatement update{};
  update.derivative = kind(at_ + 1) == TokenKind::prime;
  if (!update.derivative) advance();
  update.name = update.derivative ? take_word() : declared_name("state");
  if (update.derivative) advance();
  if (!take(TokenKind::equals)) missing("`=`", fmt::format("write `next {} = …`", update.name.text), insert_equals());
  update.value = expression();
  return update;
}

/// Reports and leaves out the `=` in `patch = 95 mm`, if there is one after the keyword.
void Parser::no_equals(const char* keyword, const char* what, const char* expected) {
  if (!at(TokenKind::equals)) return;
  complain(fmt::format("{} has no `=` before it", what), expected,
           fmt::format("write `{} {}`", keyword,
                       kind(at_ + 1) == TokenKind::number ? rest_of_statement(at_ + 1) : spelling(token(at_ + 1))),
           drop_here());
  advance();
}

/// Reports `patch 60 mm x 40 mm` and `patch 60 mm 40 mm`: the width from that token on, and the height here.
void Parser::two_lengths(std::size_t first) {
  const bool joined = is_word(at_ - 1, "x") || is_word(at_ - 1, "by");
  const std::size_t end = joined && at_ - 1 > first ? at_ - 2 : at_ - 1;  // the last token of the width
  const std::string_view height = rest_of_statement(at_);
  std::string width(text_.substr(token(first).begin, token(end).end - token(first).begin));
  // Of `60 x 40 mm` both are in millimetres.
  const bool has_unit = kind(end) != TokenKind::number;
  if (!has_unit && !ends_statement(at_ + 1) && kind(at_ + 1) == TokenKind::name)
    width += fmt::format(" {}", spelling(token(at_ + 1)));
  const std::string found = joined ? fmt::format("`{}`", spelling(token(at_ - 1))) : shown(here());
  complain_at(Code::unexpected_token, span_of(joined ? token(at_ - 1) : here()),
              fmt::format("expected a comma between width and height, found {}", found), "`,`", found,
              fmt::format("write `patch {}, {}`", width, height),
              {replace(Span{tree_.source, token(first).begin, here().begin}, width + ", ", {}, has_unit)});
  throw Abandon{};
}

PatchStatement Parser::patch() {
  advance();
  no_equals("patch", "the size of the patch", "a length");
  const bool in_parentheses = at(TokenKind::left_parenthesis);
  const std::size_t open = at_;
  if (in_parentheses && token(open).value > 0 && kind(token(open).value + 1) != TokenKind::comma) {
    const std::uint32_t close = token(open).value;
    const std::string inside(text_.substr(token(open).end, token(close).begin - token(open).end));
    const bool two = inside.find(',') != std::string::npos && inside.find('(') == std::string::npos;
    complain_at(Code::unexpected_token, {tree_.source, here().begin, token(here().value).end},
                "the size of the patch has no parentheses", "two lengths", shown(here()),
                two ? fmt::format("write `patch {}`", inside) : "write both lengths, as in `patch 95 mm, 95 mm`", {});
    throw Abandon{};
  }
  const std::size_t first = at_;
  PatchStatement patch{{expression()}};
  if (at(TokenKind::number) && !ends_statement(at_)) two_lengths(first);
  while (at(TokenKind::comma)) {
    advance();
    patch.sizes.push_back(expression());
  }
  return patch;
}

ActiveStatement Parser::active() {
  advance();
  no_equals("active", "the active power", "a power");
  return {expression()};
}

/// Reports and leaves out the comma here, before what stands without one.
void Parser::no_comma(const char* what) {
  complain(fmt::format("{} has no comma before it", what), "no comma", "drop the comma",
           {replace(span_of(here()), "", "drop the comma")});
  advance();
}

std::optional<Range> Parser::optional_range() {
  if (at(TokenKind::comma) && followed_by(TokenKind::word_in)) no_comma("a range");
  if (!at(TokenKind::word_in)) return std::nullopt;
  advance();
  const Range first = range();
  while (at(TokenKind::word_in)) once("a range", [&] { advance(), range(); });
  return first;
}

Range Parser::range() {
  Range range{};
  in_range_ = true;
  range.low = expression();
  if (at(TokenKind::name) && is_word(at_, "to") && begins_number(at_ + 1)) {
    complain("a range has `..` between its ends, not `to`", "`..`", "write `..`", {replace(span_of(here()), "..")});
    advance();
  } else if (!take(TokenKind::range)) {
    missing("`..`", "a range is written `in 1 mm .. 5 mm`", insert_range());
  }
  range.high = expression();
  return range;
}

}  // namespace wale
