#include <fmt/format.h>

#include <algorithm>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/parser.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

constexpr std::string_view sections[] = {"representative", "perceptual", "physical"};
const std::vector<std::string> section_names(std::begin(sections), std::end(sections));

/// The keywords of physical statements, in the order of `PhysicalKeyword`; `x' = …` has no keyword.
const std::vector<std::string> physical_words = {"param",  "let",   "height", "force", "patch",
                                                 "active", "state", "memory", "next",  "show"};

std::optional<PhysicalKeyword> physical_keyword_named(std::string_view word) {
  const auto found = std::ranges::find(physical_words, word);
  if (found == physical_words.end()) return std::nullopt;
  return static_cast<PhysicalKeyword>(found - physical_words.begin());
}

template <class List>
bool holds(const List& list, std::string_view word) {
  for (const auto& each : list) {
    if (each == word) return true;
  }
  return false;
}

}  // namespace

/// Reads a setting such as `valid amplitude 9 pu .. 194 pu, period 0.7 mm .. 10 mm`.
Setting Parser::setting() {
  const std::size_t begin = at_;
  const bool is_key = here().kind == TokenKind::name || here().kind == TokenKind::word_on;
  if (!is_key) {
    // The statement begins here, so this token belongs to it although it begins a line.
    complain_at(Code::unexpected_token, span_of(here()), "a setting must begin with its name", "a name", shown(here()),
                {});
    throw Abandon{};
  }
  Setting setting;
  setting.key = take_word();
  in_setting_ = true;
  if (at(TokenKind::equals) || at(TokenKind::colon)) {
    const Token& next = token(at_ + 1);
    complain(fmt::format("a setting has no {} after its name", shown(here())), "a value",
             fmt::format("write `{} {}`", setting.key.text, spelling(next)), drop_here());
    advance();
  }
  setting.items.push_back(setting_item());
  while (at(TokenKind::comma)) {
    advance();
    setting.items.push_back(setting_item());
  }
  if (at(TokenKind::word_on)) {
    advance();
    if (!at(TokenKind::name)) fail("expected the name of a device" + after_previous(), "a name", {});
    setting.on = take_word();
  }
  setting.span = since(begin);
  return setting;
}

/// Whether a name is a leading word, not part of a value: it is not called, and no operator follows it. A sign belongs
/// to the next value: `amplitude -3 N .. 3 N`.
bool Parser::is_leading_word() const {
  if (!at(TokenKind::name)) return false;
  for (const TokenKind operation :
       {TokenKind::left_parenthesis, TokenKind::star, TokenKind::slash, TokenKind::caret, TokenKind::range}) {
    if (followed_by(operation)) return false;
  }
  return true;
}

/// `title "x" called "y"`: no text follows the words after a text, so another setting begins here.
void Parser::next_setting() {
  const Token& before = token(at_ - 1);
  complain_at(Code::unexpected_token, span_of(here()), "expected the end of the line" + after_previous(),
              "`;`, or the end of the line", shown(here()),
              fmt::format("write `;` or a new line before {}", shown(here())),
              {replace(Span{tree_.source, before.end, here().begin}, "; ", "part them with `;`")});
  throw Abandon{};
}

SettingItem Parser::setting_item() {
  const std::size_t begin = at_;
  SettingItem item;
  while (is_leading_word()) item.words.push_back(take_word());
  const bool has_value =
      !ends_statement(at_) && !at(TokenKind::comma) && !at(TokenKind::word_on) && !at(TokenKind::equals);
  if (has_value) {
    item.value = expression();
    if (at(TokenKind::range)) {
      advance();
      item.range_end = expression();
    }
  }
  if (item.words.empty() && !item.value)
    fail("expected a value" + after_previous(), "a value", mend_here(), fixes_here());
  if (at(TokenKind::equals)) {
    advance();
    item.equals = expression();
  }
  if (item.value && at(TokenKind::name) && followed_by(TokenKind::text) &&
      std::holds_alternative<TextLiteral>(tree_.expr(*item.value)))
    next_setting();
  while (at(TokenKind::name)) item.trailing.push_back(take_word());
  item.span = since(begin);
  return item;
}

/// Whether the sections of a material follow although the `{` is missing here.
bool Parser::has_sections_below() const {
  std::size_t index = at_;
  while (!token(index).starts_line && kind(index) != TokenKind::left_brace && kind(index) != TokenKind::end) ++index;
  return kind(index) == TokenKind::left_brace ||
         (kind(index) == TokenKind::name && kind(index + 1) == TokenKind::left_brace &&
          holds(sections, spelling(token(index))));
}

/// Reads `representative { … }`, `perceptual { … }` or `physical { … }`.
void Parser::material_section(MaterialDecl& material, bool& misplaced) {
  std::string_view section = spelling(here());
  const bool opens = kind(at_ + 1) == TokenKind::left_brace;
  if (here().kind != TokenKind::name || !holds(sections, section)) {
    const auto meant = opens ? nearest_spelling(std::string(section), section_names) : std::nullopt;
    if (!meant) return stray_statement(material, misplaced);
    complain_at(Code::unexpected_token, span_of(here()), fmt::format("a material has no `{}`", section),
                "`representative`, `perceptual` or `physical`", fmt::format("`{}`", section),
                fmt::format("did you mean `{}`?", *meant), respell_here(section_names), {}, {{"meant", *meant}});
    section = *std::ranges::find(sections, *meant);
  }
  if ((section == "perceptual" && material.perceptual_span) || (section == "physical" && material.physical_span))
    complain_at(Code::declared_twice, span_of(here()), fmt::format("a material can have only one `{}` block", section),
                "", "", "put all its statements into one block", {},
                {{section == "physical" ? *material.physical_span : *material.perceptual_span, "the first one"}});
  advance();
  if (section == "representative") {
    block(true, [&] {
      material.representative.push_back(setting());
      end_statement();
    });
  } else if (section == "perceptual") {
    material.perceptual_span = block(true, [&] {
      material.perceptual.push_back(percept_statement());
      end_statement();
    });
  } else {
    material.physical.reserve(32);  // few materials have more statements
    material.physical_span = block(true, [&] {
      material.physical.push_back(physical_statement());
      end_statement();
    });
  }
}

/// Reads a statement outside the sections of a material. Only the first such statement is reported, since they were
/// probably all meant for the same section, or a section ended too early. A physical statement is read all the same.
void Parser::stray_statement(MaterialDecl& material, bool& misplaced) {
  const bool physical =
      here().kind == TokenKind::name && (holds(physical_words, spelling(here())) || kind(at_ + 1) == TokenKind::prime);
  if (misplaced) {
    reported_ = true;
  } else {
    complain_at(Code::unexpected_token, span_of(here()),
                fmt::format("{} is outside the sections of the material", shown(here())),
                "`representative`, `perceptual` or `physical`", shown(here()),
                physical ? "put it into `physical { … }`" : "put it into the section to which it belongs");
  }
  misplaced = true;
  if (!physical) throw Abandon{};
  material.physical.push_back(physical_statement());
  end_statement();
}

/// `roughness 0.5, stickiness 0.3` and `roughness 0.5 stickiness 0.3`. The second is read as a number with a unit.
void Parser::second_percept() {
  const bool comma = at(TokenKind::comma);
  const bool is_unit = at(TokenKind::number) && at_ > 0 && kind(at_ - 1) == TokenKind::name;
  const std::size_t name = comma ? at_ + 1 : is_unit ? at_ - 1 : at_;
  const bool has_level = kind(name + 1) == TokenKind::number || kind(name + 1) == TokenKind::name;
  if (kind(name) != TokenKind::name || !has_level || ends_statement(name + 1)) return;
  const Span between = {tree_.source, token(name - 1).end, token(name).begin};
  const Span second = {tree_.source, token(name).begin, token(name + 1).end};
  complain_at(
      Code::unexpected_token, second, "a line asks for one percept", "the end of the line",
      fmt::format("`{}`", sources_.text(second)), fmt::format("put `{}` into a line of its own", sources_.text(second)),
      {replace(comma ? Span{tree_.source, here().begin, token(name).begin} : between, "; ", "part them with `;`")});
  throw Abandon{};
}

PerceptStatement Parser::percept_statement() {
  const std::size_t begin = at_;
  PerceptStatement percept;
  if (is_word(at_, "essential") && followed_by(TokenKind::name)) {
    percept.essential = true;
    advance();
  }
  if (here().kind != TokenKind::name) {
    complain_at(Code::unexpected_token, span_of(here()), "expected the name of a percept",
                "a percept, as in `roughness 0.6`", shown(here()), {});
    throw Abandon{};
  }
  percept.name = take_word();
  if (at(TokenKind::equals) || at(TokenKind::colon)) {
    const Token& next = token(at_ + 1);
    complain(fmt::format("a percept's level has no {} before it", shown(here())), "a level",
             fmt::format("write `{} {}`", percept.name.text, spelling(next)), drop_here());
    advance();
  }
  const bool alone =
      ends_statement(at_ + 1) || kind(at_ + 1) == TokenKind::plus_minus || kind(at_ + 1) == TokenKind::comma;
  if (at(TokenKind::name) && alone) {
    percept.level_name = take_word();
  } else if (ends_statement(at_)) {
    complain("expected a level" + after_previous(), "a level from 0 to 1, or its name",
             fmt::format("write `{} 0.5`", percept.name.text));
    percept.value = erroneous(begin);
  } else {
    percept.value = expression();
  }
  if (at(TokenKind::plus_minus)) {
    advance();
    percept.tolerance = expression();
  }
  if (at(TokenKind::comma) && is_word(at_ + 1, "by") && kind(at_ + 2) == TokenKind::name) {
    advance();
    advance();
    percept.by = take_word();
  }
  if (!ends_statement(at_)) second_percept();
  percept.span = since(begin);
  if (at(TokenKind::range)) {
    complain("a level must be one number, with or without a tolerance", "`±`, or the end of the line",
             "write `0.5 ± 0.1`");
    skip_statement();
    percept.value = erroneous(begin);
  }
  return percept;
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
              shown(here()), operation ? "to continue on the next line, end the line above with the operator" : "",
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
  if (!take(TokenKind::equals)) missing("`=`", "write `force = …`", insert_equals());
  in_force_ = true;
  force.value = expression();
  if (at(TokenKind::name) && is_word(at_, "limit")) {
    advance();
    force.limit = expression();
  }
  return force;
}

/// Reads `param wale = 2.5 mm in 1 mm .. 5 mm "distance between ribs"`.
ParamStatement Parser::param() {
  ParamStatement param;
  param.documentation = documentation_here();
  advance();
  param.name = declared_name("parameter");
  if (!take(TokenKind::equals)) missing("`=`", fmt::format("write `param {} = …`", param.name.text), insert_equals());
  param.value = expression();
  param.range = optional_range();
  if (at(TokenKind::comma) && is_word(at_ + 1, "soft")) {
    advance();
    advance();
    param.soft_range = range();
  }
  if (at(TokenKind::text)) {
    param.description = input_.texts[here().value];
    advance();
  }
  return param;
}

/// Reads `state p : position = hand in -60 mm .. 60 mm`.
StateStatement Parser::state() {
  advance();
  StateStatement state;
  state.name = declared_name("state");
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
  memory.dimension = optional_dimension();
  if (!take(TokenKind::equals)) missing("`=`", fmt::format("write `memory {} = …`", memory.name.text));
  memory.value = expression();
  memory.range = optional_range();
  if (!at(TokenKind::comma) || !is_word(at_ + 1, "cell"))
    fail("expected `, cell`" + after_previous(), "`, cell` and a length",
         "give the width of its cells, as in `memory track = 0 in 0 .. 1, cell 1 mm`");
  advance();
  advance();
  memory.cell = expression();
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

PatchStatement Parser::patch() {
  advance();
  if (at(TokenKind::equals)) {
    complain("the size of the patch has no `=` before it", "a length",
             fmt::format("write `patch {}`", spelling(token(at_ + 1))), drop_here());
    advance();
  }
  PatchStatement patch{{expression()}};
  while (at(TokenKind::comma)) {
    advance();
    patch.sizes.push_back(expression());
  }
  return patch;
}

ActiveStatement Parser::active() {
  advance();
  if (at(TokenKind::equals)) {
    complain("the active power has no `=` before it", "a power",
             fmt::format("write `active {}`", spelling(token(at_ + 1))), drop_here());
    advance();
  }
  return {expression()};
}

std::optional<Range> Parser::optional_range() {
  if (!at(TokenKind::word_in)) return std::nullopt;
  advance();
  return range();
}

Range Parser::range() {
  Range range{};
  range.low = expression();
  if (!take(TokenKind::range)) missing("`..`", "a range is written `in 1 mm .. 5 mm`", insert_range());
  range.high = expression();
  return range;
}

/// Goes past the `{` of a block. If it is missing, the block is read from the next line on, since otherwise each of its
/// statements would be reported as misplaced. A block with an extra `{` is read too.
void Parser::open_block() {
  if (here().kind == TokenKind::left_brace) {
    advance();
    if (here().kind != TokenKind::left_brace) return;
    complain_at(Code::unexpected_token, span_of(here()), "a second `{`", "a statement", "`{`",
                "a block has only one; remove it", {replace(span_of(here()), "")});
    return advance();
  }
  complain("expected `{`" + after_previous(), "`{`", "a block needs braces", insert_opening_brace());
  while (here().kind != TokenKind::left_brace && here().kind != TokenKind::right_brace &&
         here().kind != TokenKind::end && !here().starts_line)
    advance();
  if (here().kind == TokenKind::left_brace) return advance();
  brace_missing_ = true;  // the right number of closing braces is now unknown
}

/// Whether the block was evidently meant to end before this token although the `}` is missing.
bool Parser::ends_block_by_mistake(bool in_section) const {
  if (here().kind == TokenKind::end || begins_declaration(at_)) return true;
  return in_section && here().kind == TokenKind::name && kind(at_ + 1) == TokenKind::left_brace &&
         holds(sections, spelling(here()));
}

void Parser::missing_brace(std::size_t open) {
  if (brace_missing_) return;
  brace_missing_ = true;
  reported_ = false;
  const LineColumn opened = sources_.place(span_of(token(open)));
  const std::string owner = open > 0 ? shown(token(open - 1)) : "";
  const bool at_end = here().kind == TokenKind::end;
  const Span last = span_of(token(at_ - 1));
  complain_at(
      Code::unexpected_token, at_end ? Span{last.source, last.end, last.end} : span_of(here()),
      at_end ? "expected `}` before the end of the file" : fmt::format("expected `}}` before {}", shown(here())), "`}`",
      at_end ? "the end of the file" : shown(here()),
      fmt::format("close the `{{` after {} in line {}, column {}", owner, opened.line, opened.column),
      insert_brace(open), {{span_of(token(open)), "opened here"}});
}

}  // namespace wale
