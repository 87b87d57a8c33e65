#include <fmt/format.h>

#include <algorithm>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/parser.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

constexpr std::string_view sections[] = {"representative", "perceptual", "physical"};
const std::vector<std::string> section_names(std::begin(sections), std::end(sections));

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
  if (followed_by(TokenKind::left_brace) && holds(sections, spelling(here()))) {
    complain_at(Code::unexpected_token, span_of(here()), fmt::format("`{}` belongs in a material", spelling(here())),
                "a setting", shown(here()), "begin the declaration with `material`");
    throw Abandon{};
  }
  setting.key = take_word();
  in_setting_ = true;
  if (at(TokenKind::equals) || at(TokenKind::colon)) {
    const Token& next = token(at_ + 1);
    complain(fmt::format("a setting has no {} after its name", shown(here())), "a value",
             fmt::format("write `{} {}`", setting.key.text, value_at(at_ + 1)),
             // Before a parenthesis it may be a formula whose setting has lost its name.
             next.kind == TokenKind::left_parenthesis ? std::vector<Fix>{} : drop_here());
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
    in_origin_ = in_origin_ || in_placed_;  // `colour "#c04020" = brick`
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

/// Reports the heading of a section as it is in JSON and YAML, `"physical": {` and `physical: {`; it is read all
/// the same. Nothing for another heading.
std::optional<std::string_view> Parser::section_of_other_languages() {
  const bool quoted = here().kind == TokenKind::text, colon = followed_by(TokenKind::colon);
  const std::string_view name = quoted ? std::string_view(input_.texts[here().value]) : spelling(here());
  const std::size_t brace = at_ + (colon ? 2 : 1);
  if ((!quoted && !colon) || !holds(sections, name) || kind(brace) != TokenKind::left_brace) return std::nullopt;
  const Span heading = {tree_.source, here().begin, token(brace - 1).end};
  complain_at(Code::unexpected_token, heading,
              fmt::format("the name of a section has no {}", quoted && colon ? "quotes and no `:`"
                                                             : quoted        ? "quotes"
                                                                             : "`:`"),
              fmt::format("`{} {{`", name), shown(here()), fmt::format("write `{} {{`", name),
              {replace(heading, std::string(name))});
  return name;
}

/// Reads `representative { … }`, `perceptual { … }` or `physical { … }`.
void Parser::material_section(MaterialDecl& material, bool& misplaced) {
  const auto other = section_of_other_languages();
  std::string_view section = other.value_or(spelling(here()));
  const bool opens = kind(at_ + 1) == TokenKind::left_brace;
  if (!other && (here().kind != TokenKind::name || !holds(sections, section))) {
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
  if (at(TokenKind::colon) && followed_by(TokenKind::left_brace)) advance();  // reported
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
      here().kind == TokenKind::name && (physical_keyword_named(spelling(here())) || kind(at_ + 1) == TokenKind::prime);
  const bool is_level = kind(at_ + 1) == TokenKind::number;
  const bool is_said = is_word(at_, "title") || is_word(at_, "called") || is_word(at_, "kind") || is_word(at_, "like");
  if (misplaced) {
    reported_ = true;
  } else {
    complain_at(Code::unexpected_token, span_of(here()),
                fmt::format("{} is outside the sections of the material", shown(here())),
                "`representative`, `perceptual` or `physical`", shown(here()),
                physical   ? "put it into `physical { … }`"
                : is_said  ? "put it into `representative { … }`"
                : is_level ? "put it into `perceptual { … }`"
                           : "put it into the section to which it belongs");
  }
  misplaced = true;
  if (!physical) throw Abandon{};
  material.physical.push_back(physical_statement());
  end_statement();
}

/// `roughness 0.5, stickiness 0.3` and `roughness 0.5 stickiness 0.3`. The second is read as a number with a unit.
void Parser::second_percept(std::size_t level) {
  // `roughness fine 0.3`: two levels of one percept.
  if (at_ == level + 1 && kind(level) == TokenKind::name && at(TokenKind::number)) {
    const Span both = {tree_.source, token(level).begin, here().end};
    complain_at(Code::unexpected_token, both, "a level is a name or a number, and here are both", "one level",
                fmt::format("`{}`", sources_.text(both)),
                fmt::format("write `{0} {1}` or `{0} {2}`", spelling(token(level - 1)), spelling(token(level)),
                            spelling(here())));
    throw Abandon{};
  }
  const bool comma = at(TokenKind::comma);
  const bool is_unit = at(TokenKind::number) && at_ > 0 && kind(at_ - 1) == TokenKind::name;
  const std::size_t name = comma ? at_ + 1 : is_unit ? at_ - 1 : at_;
  const bool has_level = kind(name + 1) == TokenKind::number || kind(name + 1) == TokenKind::name;
  if (kind(name) != TokenKind::name || !has_level || is_evidence(name + 1) || ends_statement(name + 1)) return;
  const Span between = {tree_.source, token(name - 1).end, token(name).begin};
  const Span second = {tree_.source, token(name).begin, token(name + 1).end};
  // `roughness roughness 0.5` is one percept, written twice.
  const bool is_other = spelling(token(name)) != spelling(token(name - 1)) || comma;
  complain_at(Code::unexpected_token, second, "a line asks for one percept", "the end of the line",
              fmt::format("`{}`", sources_.text(second)),
              fmt::format("put `{}` into a line of its own", sources_.text(second)),
              {replace(comma ? Span{tree_.source, here().begin, token(name).begin} : between, "; ",
                       "part them with `;`", is_other)});
  throw Abandon{};
}

/// Reports `force = firm()` and other statements of physics among percepts.
void Parser::no_physics_here() {
  if (!physical_keyword_named(spelling(here()))) return;
  const bool named = followed_by(TokenKind::name) && !ends_statement(at_ + 1);
  const TokenKind behind = kind(at_ + (named ? 2 : 1));
  if (behind != TokenKind::equals && !(named && behind == TokenKind::colon)) return;
  complain_at(Code::unexpected_token, span_of(here()), fmt::format("a `{}` is no percept", spelling(here())),
              "a percept, as in `roughness 0.6`", shown(here()),
              fmt::format("a `{}` belongs in `physical {{ … }}`", spelling(here())));
  throw Abandon{};
}

/// Reports slips in a level that its parts alone do not show: quotes around it, `+/-`, and words of evidence that are
/// misspelt, which would be taken for units.
void Parser::mistyped_level() {
  if (ends_statement(at_)) return;
  if (at(TokenKind::text)) {
    const std::string quoted(input_.texts[here().value]);
    const bool is_number = !quoted.empty() && quoted.find_first_not_of("0123456789.") == std::string::npos;
    std::vector<Fix> fixes = is_number ? std::vector{replace(span_of(here()), quoted)} : unquote(false);
    if (!fixes.empty())
      fail("a level has no quotes", "a level from 0 to 1, or its name", fmt::format("write `{}`", quoted), std::move(fixes));
  }
  for (std::size_t index = at_ + 1; !ends_statement(index); ++index) {
    const bool signs = (kind(index) == TokenKind::plus && kind(index + 2) == TokenKind::minus) ||
                       (kind(index) == TokenKind::minus && kind(index + 2) == TokenKind::plus);
    if (signs && kind(index + 1) == TokenKind::slash && !ends_statement(index + 2)) {
      const Span sign = {tree_.source, token(index).begin, token(index + 2).end};
      complain_at(Code::unexpected_token, sign, "a tolerance is written with `±`", "`±` or `+-`",
                  fmt::format("`{}`", sources_.text(sign)), "write `±` or `+-`", {replace(sign, "+-")});
      throw Abandon{};
    }
    const bool behind_value = kind(index - 1) == TokenKind::number || kind(index - 1) == TokenKind::percent ||
                              (index == at_ + 1 && kind(at_) == TokenKind::name);
    if (kind(index) != TokenKind::name || !behind_value || is_evidence(index)) continue;
    const bool ends = ends_statement(index + 1) || kind(index + 1) == TokenKind::plus_minus ||
                      kind(index + 1) == TokenKind::comma;
    const std::string_view word = spelling(token(index));
    const std::vector<std::string> words = words_of_evidence();
    constexpr std::size_t telling = 5;  // letters
    const auto meant = ends && word.size() >= telling ? nearest_spelling(std::string(word), words) : std::nullopt;
    if (!meant) continue;
    complain_at(Code::unexpected_token, span_of(token(index)), fmt::format("no evidence is called `{}`", word),
                fmt::format("`{}`", *meant), fmt::format("`{}`", word), fmt::format("did you mean `{}`?", *meant),
                respell(span_of(token(index)), word, words), {}, {{"meant", *meant}});
    throw Abandon{};
  }
}

PerceptStatement Parser::percept_statement() {
  const std::size_t begin = at_;
  PerceptStatement percept;
  if (is_word(at_, "essential") && followed_by(TokenKind::name)) {
    percept.essential = true;
    advance();
  }
  if (here().kind != TokenKind::name) {
    const bool quoted = here().kind == TokenKind::text;
    complain_at(
        Code::unexpected_token, span_of(here()), "expected the name of a percept", "a percept, as in `roughness 0.6`",
        shown(here()), quoted ? "write names without quotes" : "",
        quoted ? std::vector{replace(span_of(here()), std::string(input_.texts[here().value]))} : std::vector<Fix>{});
    throw Abandon{};
  }
  no_physics_here();
  percept.name = take_word();
  if (at(TokenKind::equals) || at(TokenKind::colon)) {
    complain(fmt::format("a percept's level has no {} before it", shown(here())), "a level",
             fmt::format("write `{} {}`", percept.name.text, value_at(at_ + 1)), drop_here());
    advance();
  }
  in_setting_ = true;
  mistyped_level();
  const std::size_t level = at_;
  const bool alone = ends_statement(at_ + 1) || kind(at_ + 1) == TokenKind::plus_minus ||
                     kind(at_ + 1) == TokenKind::comma || is_evidence(at_ + 1);
  const bool ends_behind = ends_statement(at_ + 2) || kind(at_ + 2) == TokenKind::plus_minus;
  if (at(TokenKind::name) && alone) {
    percept.level_name = take_word();
  } else if (at(TokenKind::name) && kind(at_ + 1) == TokenKind::name && !ends_statement(at_ + 1) && ends_behind &&
             spelling(here()) != percept.name.text && spelling(here()) != spelling(token(at_ + 1))) {
    // `very coarse`: whoever knows the percept's levels says which there are.
    const Word first = take_word(), second = take_word();
    percept.level_name = Word{text_.substr(first.span.begin, second.span.end - first.span.begin),
                              {tree_.source, first.span.begin, second.span.end}};
  } else if (ends_statement(at_)) {
    // Whoever knows the percepts says which one is meant.
    complain("expected a level" + after_previous(), "a level from 0 to 1, or its name",
             fmt::format("if `{0}` is a percept, write `{0} 0.5`; if it is a level, write its percept before it, as in "
                         "`hardness hard`",
                         percept.name.text));
    percept.level_name = Word{{}, place_here()};
    percept.value = erroneous(begin);
  } else {
    percept.value = expression();
  }
  const auto evidence = [&] {
    while (is_evidence(at_)) {
      if (percept.evidence)
        once("the evidence of a level", [&] { advance(); });
      else
        percept.evidence = take_word();
    }
  };
  evidence();
  if (at(TokenKind::plus_minus)) {
    advance();
    percept.tolerance = expression();
    evidence();
    while (at(TokenKind::plus_minus)) once("a tolerance", [&] { advance(), expression(); });
  }
  if (at(TokenKind::comma) && is_word(at_ + 1, "by") && kind(at_ + 2) == TokenKind::name) {
    advance();
    advance();
    percept.by = take_word();
    while (at(TokenKind::comma) && is_word(at_ + 1, "by") && kind(at_ + 2) == TokenKind::name)
      once("the map of a percept", [&] { advance(), advance(), advance(); });
  }
  if (!ends_statement(at_)) second_percept(level);
  percept.span = since(begin);
  if (at(TokenKind::range)) {
    complain("a level must be one number, with or without a tolerance", "`±`, or the end of the line",
             "write `0.5 ± 0.1`");
    skip_statement();
    percept.value = erroneous(begin);
  }
  return percept;
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
  if (in_placed_ && is_word(at_, "patch") && kind(at_ + 1) == TokenKind::name && kind(at_ + 2) == TokenKind::equals)
    return true;
  return in_section && here().kind == TokenKind::name && kind(at_ + 1) == TokenKind::left_brace &&
         holds(sections, spelling(here()));
}

/// Whether the declaration whose blocks are open ends further down, with all its braces: what begins here is then
/// inside it, and no `}` is missing.
bool Parser::is_inside_closed_declaration() const {
  return !open_blocks_.empty() && !brace_missing_ && kind(open_blocks_.front()) == TokenKind::left_brace &&
         token(open_blocks_.front()).value > at_;
}

/// Reports a declaration inside another one. A function is read all the same, so that its name is known.
void Parser::misplaced_declaration() {
  const bool exported = is_word(at_, "export");
  const std::size_t begin = at_, keyword = at_ + (exported ? 1 : 0);
  const std::string word(spelling(token(keyword)));
  const Span heading = {tree_.source, token(begin).begin, token(keyword + 1).end};
  const std::size_t closes = token(open_blocks_.front()).value;
  const bool is_function = word == "function";
  // Its own mistakes are reported first: one whose end is unknown cannot be moved.
  if (is_function) {
    at_ = keyword;
    function(exported);
    if (!ends_statement(at_)) end_statement();
  }
  const SecondarySpan end = {span_of(token(closes)), "the declaration around it ends here"};
  complain_at(Code::unexpected_token, heading, fmt::format("a {} cannot be declared inside another declaration", word),
              "a statement", fmt::format("`{}`", word), fmt::format("put the {} below this `}}`", word),
              is_function ? move_behind_declaration(begin) : std::vector<Fix>{}, {end});
  if (!is_function) throw Abandon{};
  if (here().kind == TokenKind::semicolon) advance();
}

/// Whether some tokens use a name that the open declaration gives to a value, which nothing outside it knows.
bool Parser::names_of_block_in(std::size_t begin, std::size_t end) const {
  const std::size_t closes = token(open_blocks_.front()).value;
  const auto gives = [&](std::size_t index) {
    return is_word(index, "param") || is_word(index, "let") || is_word(index, "height") || is_word(index, "state") ||
           is_word(index, "memory");
  };
  for (std::size_t given = open_blocks_.front(); given < closes; ++given) {
    if (!gives(given) || kind(given + 1) != TokenKind::name) continue;
    for (std::size_t index = begin; index < end; ++index)
      if (kind(index) == TokenKind::name && spelling(token(index)) == spelling(token(given + 1))) return true;
  }
  return false;
}

/// Moves the tokens from `begin` on behind the `}` of the open declaration. Nothing if they need names of it.
std::vector<Fix> Parser::move_behind_declaration(std::size_t begin) const {
  if (names_of_block_in(begin, at_)) return {};
  const Span brace = span_of(token(token(open_blocks_.front()).value));
  Span moved = since(begin);
  const std::string text(text_.substr(moved.begin, moved.end - moved.begin));
  const std::size_t newline = std::min(text_.find('\n', moved.end), text_.size());
  const bool crlf = newline < text_.size() && newline > 0 && text_[newline - 1] == '\r';
  const bool ends_line = text_.find_first_not_of(" \t\r", moved.end) == newline;
  if (token(begin).starts_line && ends_line && newline < text_.size()) {  // the whole line goes
    while (text_[moved.begin - 1] == ' ' || text_[moved.begin - 1] == '\t') --moved.begin;
    moved.end = static_cast<std::uint32_t>(newline + 1);
  }
  Fix fix = replace(moved, "", "move it below", false);
  const std::string_view line_end = crlf ? "\r\n" : "\n";
  fix.edits.push_back({{brace.source, brace.end, brace.end}, fmt::format("{0}{0}{1}", line_end, text)});
  return {fix};
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
