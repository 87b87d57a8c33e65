// Words and signs that people bring from other languages, and what Wale has instead.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/borrowed.hpp"
#include "compiler/parse/parser.hpp"

namespace wale {
namespace {

constexpr std::string_view for_values[] = {"var",   "const", "val",    "auto",   "float",     "double", "int",
                                           "local", "final", "static", "number", "constexpr", "define", "bool",
                                           "vec2",  "vec3",  "vec4",   "vector", "half",      "real"};
constexpr std::string_view for_params[] = {"uniform", "parameter", "slider",    "input",    "knob",   "control",
                                           "option",  "property",  "attribute", "variable", "varying"};
constexpr std::string_view for_functions[] = {"def", "func", "fn", "fun", "sub", "lambda", "procedure"};
constexpr std::string_view for_imports[] = {"include", "use", "using", "require", "from"};
constexpr std::string_view for_materials[] = {"struct", "object", "type", "interface", "surface", "texture"};
constexpr std::string_view for_origins[] = {"extends", "inherits", "is", "from", "of", "like"};

template <std::size_t count>
bool holds(const std::string_view (&words)[count], std::string_view word) {
  return std::ranges::find(words, word) != std::end(words);
}

}  // namespace

std::optional<std::string> borrowed_declaration(std::string_view word) {
  if (holds(for_values, word)) return "let";
  if (holds(for_functions, word)) return "function";
  if (holds(for_imports, word)) return "import";
  if (holds(for_materials, word)) return "material";
  return std::nullopt;
}

/// `const k = 3`, which is read as `let k = 3`. A new value for what is remembered, `count = count + 1`, is reported.
std::optional<PhysicalKeyword> Parser::borrowed_keyword() {
  const std::string_view word = spelling(here());
  const bool is_param = holds(for_params, word);
  if (followed_by(TokenKind::name) && (is_param || holds(for_values, word))) {
    const std::string ours = is_param ? "param" : "let";
    // `uniform float k = …` and `const float k = …` have a type too.
    const bool typed = holds(for_values, spelling(token(at_ + 1))) && kind(at_ + 2) == TokenKind::name;
    const Span theirs = {tree_.source, here().begin, token(at_ + (typed ? 1 : 0)).end};
    complain_at(Code::unexpected_token, theirs, fmt::format("no statement begins with `{}`", word),
                fmt::format("`{}`", ours), fmt::format("`{}`", word), fmt::format("write `{}`", ours),
                {replace(theirs, ours)});
    if (typed) advance();
    return is_param ? PhysicalKeyword::param : PhysicalKeyword::let;
  }
  const bool is_remembered = std::ranges::find(remembered_, word) != remembered_.end();
  if (!is_remembered || !followed_by(TokenKind::equals)) return std::nullopt;
  complain_at(Code::unexpected_token, span_of(here()), fmt::format("`{}` is remembered from tick to tick", word),
              "`next`", fmt::format("`{}`", word),
              fmt::format("write `next {} = …` for its value in the next tick", word),
              {insert_before(span_of(here()), "next ", {}, false)});
  throw Abandon{};
}

/// What to write instead of a statement that begins with a word of another language; empty for other words.
std::string Parser::mend_borrowed(std::string_view word) const {
  if (followed_by(TokenKind::colon)) {
    const bool quoted = here().kind == TokenKind::text;
    const std::string_view name = quoted ? input_.texts[here().value] : word;
    return fmt::format("{}a value is named as in `let {} = …`, a slider as in `param {} = 2 mm in 1 mm .. 5 mm`",
                       quoted ? "write names without quotes; " : "", name, name);
  }
  if (here().kind == TokenKind::word_if) return "an `if` is a value: write `force = if … then … else …`";
  if (word == "for" || word == "while" || word == "repeat" || word == "loop" || word == "do")
    return "there are no loops: the forces are computed anew in each tick, and a `grating` repeats in space";
  if (word == "return") return "a function is one expression: `function name(…) = …`";
  if (word == "import" || word == "function" || holds(for_functions, word))
    return "it belongs outside the material, in a line of its own";
  if (here().kind == TokenKind::name && followed_by(TokenKind::number))
    return "percepts and their levels belong in `perceptual { … }`";
  return {};
}

/// Reports `soft` or `cell` without the comma before it.
void Parser::missing_comma(std::string_view word) {
  complain(fmt::format("expected a comma before `{}`", word), "`,`", fmt::format("write `, {}`", word),
           {insert_after(span_of(token(at_ - 1)), ",", "write a comma")});
}

/// Goes past the sign or word of another language between a material and the one that it is made from, as in
/// `material m : corduroy` and `material m extends corduroy`, and reports it. False if there is none.
bool Parser::borrowed_origin() {
  const bool colon = at(TokenKind::colon);
  const bool word = (at(TokenKind::name) || at(TokenKind::word_from)) && holds(for_origins, spelling(here()));
  if ((!colon && !word) || !followed_by(TokenKind::name)) return false;
  const Span between = {tree_.source, token(at_ - 1).end, here().end};
  complain(fmt::format("expected `=` before the material that this one is made from, found {}", shown(here())), "`=`",
           fmt::format("write `= {}`", spelling(token(at_ + 1))), {replace(between, " =", "write `=`")});
  advance();
  return true;
}

}  // namespace wale
