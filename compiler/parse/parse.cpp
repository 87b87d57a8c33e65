#include "compiler/parse/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/parse/borrowed.hpp"
#include "compiler/parse/parser.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

constexpr int known_version = 1;

/// Declarations whose blocks hold settings. Later stages know what the settings mean.
const std::vector<std::string> record_words = {"percept", "map",  "threshold", "rule", "class", "device",
                                               "levels",  "hand", "movie",     "keys", "groups",
                                               "experiment"};

const std::vector<std::string> declaration_words = {"material",  "percept", "map",       "threshold", "rule", "class",
                                                    "device",    "levels",  "hand",      "function",  "let",  "unit",
                                                    "dimension", "import",  "workspace", "movie",     "keys", "groups",
                                                    "experiment"};

bool holds(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_record(std::string_view word) { return holds(record_words, word); }

/// Reports the errors of the lexer and the parser in the order of the text.
void report_in_order(const Diagnostics& found, Diagnostics& diagnostics) {
  std::vector<Diagnostic> all = found.all();
  // In a file of a newer version, errors cannot be told from new features, so only the version is reported.
  const auto newer =
      std::find_if(all.begin(), all.end(), [](const auto& each) { return each.code == Code::newer_version; });
  if (newer != all.end()) all = {Diagnostic(*newer)};
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.span.begin < b.span.begin; });
  const bool cut = all.size() >= error_limit;
  const Span last = all.empty() ? Span{} : all.back().span;
  for (Diagnostic& each : all) diagnostics.report(std::move(each));
  if (cut) {
    diagnostics.report({Code::unexpected_token,
                        last,
                        fmt::format("{} errors so far; the rest of this file was not read", error_limit),
                        {},
                        {},
                        {},
                        "correct these first"});
  }
}

}  // namespace

SyntaxTree parse(const SourceSet& sources, SourceId source, Diagnostics& diagnostics) {
  SyntaxTree tree;
  tree.source = source;
  Diagnostics found;
  Tokens tokens = lex(sources, source, found);
  const bool is_text = std::none_of(found.all().begin(), found.all().end(), [](const Diagnostic& each) {
    return each.code == Code::invalid_encoding || each.code == Code::too_long;
  });
  tree.exprs.reserve(tokens.tokens.size() / 2);  // about as many as there will be
  tree.expr_spans.reserve(tokens.tokens.size() / 2);
  tree.suffix_factors.reserve(tokens.tokens.size() / 8);
  tree.call_arguments.reserve(tokens.tokens.size() / 16);
  if (is_text && found.all().size() < error_limit) Parser(sources, tokens, tree, found).file();
  tree.text = tokens.source;
  tree.rewritten = tokens.rewritten;
  report_in_order(found, diagnostics);
  return tree;
}

std::vector<ExprId> parse_expressions(const SourceSet& sources, SourceId source, SyntaxTree& tree,
                                      Diagnostics& diagnostics) {
  tree = SyntaxTree{};
  tree.source = source;
  Diagnostics found;
  Tokens tokens = lex(sources, source, found);
  std::vector<ExprId> expressions;
  if (!found.has_errors()) expressions = Parser(sources, tokens, tree, found).expression_list();
  tree.text = tokens.source;
  tree.rewritten = tokens.rewritten;
  if (found.has_errors()) expressions.clear();
  report_in_order(found, diagnostics);
  return expressions;
}

std::vector<ExprId> Parser::expression_list() {
  std::vector<ExprId> expressions;
  statement([&] {
    expressions.push_back(operation(0));
    while (at(TokenKind::comma)) {
      advance();
      expressions.push_back(operation(0));
    }
    if (here().kind != TokenKind::end)
      fail("expected `,`" + after_previous(), "`,` or the end", mend_here(), fixes_here());
  });
  return expressions;
}

void Parser::file() {
  try {
    if (!version()) return;
  } catch (const Abandon&) {
    skip_statement();
  }
  for (;;) {
    while (here().kind == TokenKind::semicolon) advance();
    if (here().kind == TokenKind::end) return;
    brace_missing_ = false;
    statement([&] { declaration(); });
  }
}

/// Reads `wale 1`. Without it the file is read as the version that this compiler knows; a newer version is not read.
bool Parser::version() {
  if (text_.starts_with("{\\rtf")) {
    complain_at(Code::missing_version, span_of(here()), "this is a document of a word processor, not plain text",
                fmt::format("`wale {}`", known_version), "RTF",
                "in the word processor, save it as plain text (.txt, UTF-8), or copy its text into a new file");
    return false;
  }
  const std::string_view first = spelling(here());
  const bool is_wale = here().kind == TokenKind::name && (first == "wale" || first == "Wale" || first == "WALE");
  const bool has_number = is_wale && kind(at_ + 1) == TokenKind::number && !token(at_ + 1).starts_line;
  const double number = has_number ? input_.numbers[token(at_ + 1).value] : 0;
  const Span span = has_number ? Span{tree_.source, here().begin, token(at_ + 1).end} : span_of(here());
  if (has_number && number > known_version) {
    complain_at(Code::newer_version, span, fmt::format("this file is written in wale {}", number),
                fmt::format("wale {}", known_version), fmt::format("wale {}", number),
                "install a newer Wale, or ask the author for the file in wale 1", {}, {},
                {{"version", NumberWithUnit{number, ""}},
                 {"known_version", NumberWithUnit{static_cast<double>(known_version), ""}}});
    return false;
  }
  if (!has_number || number != known_version || first != "wale") {
    const bool plain_start = !is_wale;
    complain_at(
        Code::missing_version, span,
        has_number && first == "wale" ? fmt::format("there is no version {} of Wale", number)
                                      : "the file does not begin with its version",
        fmt::format("`wale {}`", known_version), here().kind == TokenKind::end ? "the end of the file" : shown(here()),
        fmt::format("write `wale {}` {}", known_version, plain_start ? "in a line above everything else" : "here"),
        state_version(is_wale, has_number, !is_wale && holds(declaration_words, first)));
    lost_ = here().kind == TokenKind::left_brace || here().kind == TokenKind::left_bracket;  // JSON or the like
    if (plain_start) return true;
  }
  advance();
  if (has_number) advance();
  end_statement();
  return true;
}

/// Whether a declaration certainly begins here. An indented `let` may belong to the previous declaration.
bool Parser::ends_lostness() const {
  if (here().kind != TokenKind::name) return false;
  const bool body = is_word(at_, "let") && sources_.place(span_of(here())).column > 1;
  const bool misspelt = kind(at_ + 1) == TokenKind::name && kind(at_ + 2) == TokenKind::left_brace;
  return misspelt || (!body && holds(declaration_words, spelling(here())));
}

void Parser::declaration() {
  open_blocks_.clear();
  // The rest of a declaration that ended too early is not reported again.
  reported_ = lost_ = lost_ && !ends_lostness();
  if (here().kind == TokenKind::right_brace) {
    complain_at(Code::unexpected_token, span_of(here()), "this `}` closes nothing", "a declaration", "`}`",
                "remove it, or look for an extra `}` above", {replace(span_of(here()), "", {}, false)});
    advance();
    return;
  }
  if (lost_) return skip_statement();
  const bool exported = is_word(at_, "export") && kind(at_ + 1) == TokenKind::name && !token(at_ + 1).starts_line;
  const Span exporting = span_of(here());
  if (exported) {
    advance();
    const bool presents = std::ranges::any_of(std::array{"workspace", "movie", "keys", "groups", "experiment"},
                                              [&](const char* word) { return is_word(at_, word); });
    if (is_word(at_, "material") || is_word(at_, "import") || presents) {
      const bool material = is_word(at_, "material"), import = is_word(at_, "import");
      complain_at(Code::unexpected_token, exporting,
                  material ? std::string("a material needs no `export`: every file that imports this one may use it")
                  : import ? std::string("an import cannot be exported")
                           : fmt::format("{} {} cannot be exported: no other file names it",
                                         is_word(at_, "experiment") ? "an" : "a",
                                         is_word(at_, "keys")     ? "set of keys"
                                         : is_word(at_, "groups") ? "sorting into groups"
                                                                  : spelling(here())),
                  "", "`export`", import ? "let the files that need it import it too" : "leave `export` out");
    }
  }
  std::string_view keyword = here().kind == TokenKind::name ? spelling(here()) : "";
  const auto known = [&] { return holds(declaration_words, keyword); };
  if (!known()) {
    auto meant = followed_by(TokenKind::name) && !borrowed_declaration(keyword)
                     ? nearest_spelling(keyword, declaration_words)
                     : std::nullopt;
    std::string help;
    auto borrowed = borrowed_declaration(here().kind == TokenKind::word_from ? "from" : keyword);
    if (borrowed)
      help = *borrowed == "import"     ? "write `import`, and the module with dots: `import fabric.denim`"
             : *borrowed == "function" ? "write `function name(…) = …`, with one expression"
                                       : fmt::format("write `{}`", *borrowed);
    // `float hill(float t) { … }`
    if (borrowed && *borrowed == "let" && followed_by(TokenKind::name) &&
        kind(at_ + 2) == TokenKind::left_parenthesis) {
      help = fmt::format("write `function {}(…) = …`, with one expression", spelling(token(at_ + 1)));
      borrowed = "function";
    }
    if (meant) help = fmt::format("did you mean `{}`?", *meant);
    bool defines = !keyword.empty() && followed_by(TokenKind::equals);
    if (defines) help = fmt::format("write `material {0} = …`, or `let {0} = …` for a value", keyword);
    for (const std::string_view word : {"param", "height", "force", "state", "next", "show", "patch"}) {
      if (keyword != word) continue;
      help = fmt::format("`{}` belongs in the `physical {{ … }}` of a material", word);
      defines = false;
    }
    if (here().kind == TokenKind::left_brace)
      help = "a material is written `material NAME { … }`, without braces around it";
    if (keyword == "wale") {
      help = "the version is stated once, in the first line";
      defines = false;
    }
    complain_at(Code::unexpected_token, span_of(here()), fmt::format("no declaration begins with {}", shown(here())),
                "`material`, `import`, `let`, `function`, `unit`, `dimension`, `percept`, `map`, `threshold`, `rule`, "
                "`class`, `device`, `levels`, `hand`, `workspace`, `movie`, `keys`, `groups` or `experiment`",
                shown(here()), std::move(help),
                // Behind something else in a line it is rather what is left of a mistake there.
                borrowed && *borrowed == "let" && !meant
                    ? std::vector{replace(span_of(here()), *borrowed, {}, here().starts_line)}
                : meant   ? respell_here(declaration_words)
                : defines ? std::vector{insert_before(span_of(here()), "material ", "write `material`", false),
                                        insert_before(span_of(here()), "let ", "write `let`", false)}
                          : std::vector<Fix>{},
                {}, meant ? std::vector<Fact>{{"meant", *meant}} : std::vector<Fact>{});
    // A borrowed `const` or `struct` is read as what was meant; what follows `def` and `from` is not like Wale's.
    const bool reads_on =
        borrowed && !meant && followed_by(TokenKind::name) && (*borrowed == "let" || *borrowed == "material");
    if (reads_on) meant = borrowed;
    lost_ = lost_ || !meant;
    if (lost_ || keyword == "wale") throw Abandon{};
    keyword = input_.rewrite(*meant);
  }
  if (keyword == "material") return material();
  if (keyword == "workspace") return workspace();
  if (is_record(keyword)) return record(exported);
  if (keyword == "import") import_module();
  if (keyword == "dimension") dimension(exported);
  if (keyword == "unit") unit(exported);
  if (keyword == "let") constant(exported);
  if (keyword == "function") function(exported);
  end_statement();
}

/// Reads `import fabric.denim`.
void Parser::import_module() {
  advance();
  if (!at(TokenKind::name)) {
    fail("expected the name of a module" + after_previous(), "a name",
         at(TokenKind::text) ? "write a module's name without quotes, with dots between folders: `import fabric.denim`"
                             : "",
         unquote(true));
  }
  tree_.declarations.push_back(Import{take_word()});
  // Other languages list names here, or give the module another one.
  const bool names_parts = at(TokenKind::left_parenthesis) || at(TokenKind::left_brace) || at(TokenKind::colon) ||
                           (at(TokenKind::name) && is_word(at_, "as"));
  if (!names_parts && !at(TokenKind::comma) && !at(TokenKind::slash)) return;
  fail("expected the end of the line" + after_previous(), "",
       at(TokenKind::slash) ? fmt::format("folders have dots between them: `import {}.{}`", spelling(token(at_ - 1)),
                                          spelling(token(at_ + 1)))
       : at(TokenKind::comma) ? "each import is a line of its own"
                              : "an import names a module and no more: all that it exports is then known by its own name");
}

/// Reads `dimension length` or `dimension force = mass * length / time^2`, with optional bounds for its states.
void Parser::dimension(bool exported) {
  advance();
  DimensionDecl dimension{declared_name("dimension"), {}, {}, exported};
  if (at(TokenKind::equals)) {
    advance();
    dimension.definition = expression();
  }
  dimension.range = optional_range();
  tree_.declarations.push_back(std::move(dimension));
}

/// Reads `unit m : length` or `unit N = 1 kg m/s^2`.
void Parser::unit(bool exported) {
  UnitDecl unit;
  unit.exported = exported;
  unit.documentation = documentation_here();
  advance();
  unit.name = at(TokenKind::percent) ? take_word() : declared_name("unit");
  if (at(TokenKind::colon)) {
    advance();
    if (!at(TokenKind::name)) fail("expected a dimension" + after_previous(), "a dimension, as in `: length`", {});
    unit.dimension = take_word();
  } else if (at(TokenKind::name) && ends_statement(at_ + 1)) {
    complain("expected `:`" + after_previous(), "`:`", fmt::format("write `unit {} : …`", unit.name.text),
             {insert_after(unit.name.span, " :", "write `:`")});
    unit.dimension = take_word();
  } else {
    if (!take(TokenKind::equals))
      missing("`=` or `:`", "write `unit thou = 25.4 um`, or `unit m : length` for a base unit", insert_equals());
    unit.definition = expression();
  }
  tree_.declarations.push_back(std::move(unit));
}

void Parser::constant(bool exported) {
  Constant constant{};
  constant.exported = exported;
  constant.documentation = documentation_here();
  advance();
  constant.name = declared_name("value");
  if (!take(TokenKind::equals)) missing("`=`", fmt::format("write `let {} = …`", constant.name.text), insert_equals());
  constant.value = expression();
  tree_.declarations.push_back(std::move(constant));
}

/// Reads `function grating(along: length, period: length, duty = 0.5) = …`.
void Parser::function(bool exported) {
  FunctionDecl function{};
  function.exported = exported;
  function.documentation = documentation_here();
  advance();
  function.name = declared_name("function");
  if (!at(TokenKind::left_parenthesis)) {
    fail("expected `(`" + after_previous(), "`(`", fmt::format("write `function {}(…) = …`", function.name.text));
  }
  open_parentheses_.push_back(at_);
  advance();
  while (!at(TokenKind::right_parenthesis)) {
    function.parameters.push_back(formal_parameter());
    if (!at(TokenKind::comma)) break;
    advance();
  }
  close_parenthesis("`,` or `)`");
  if (!take(TokenKind::equals))
    missing("`=`", fmt::format("write `function {}(…) = …`", function.name.text), insert_equals());
  function.body = expression();
  tree_.declarations.push_back(std::move(function));
}

FormalParameter Parser::formal_parameter() {
  FormalParameter parameter{declared_name("parameter"), {}, {}};
  parameter.dimension = optional_dimension();
  if (at(TokenKind::equals)) {
    advance();
    parameter.default_value = operation(0);
  }
  return parameter;
}

/// Reads `percept NAME { … }`, `map NAME from NAME { … }` and the like.
void Parser::record(bool exported) {
  const std::size_t begin = at_;
  RecordDecl record;
  record.exported = exported;
  record.documentation = documentation_here();
  record.keyword = take_word();
  if (!is_record(record.keyword.text))
    if (const auto meant = nearest_spelling(record.keyword.text, record_words))
      record.keyword.text = input_.rewrite(*meant);
  record.name = declared_name(record.keyword.text);
  if (record.keyword.text == "map") {
    if (!take(TokenKind::word_from))
      missing("`from`", fmt::format("write `map {} from amplitude {{ … }}`", record.name.text));
    if (!at(TokenKind::name)) fail("expected the name of a quantity" + after_previous(), "a name", {});
    record.from = take_word();
  }
  block(false, [&] {
    record.settings.push_back(setting());
    end_statement();
  });
  record.span = since(begin);
  tree_.declarations.push_back(std::move(record));
}

/// Reads `material NAME { … }`, `material NAME = EXPRESSION`, or both.
void Parser::material() {
  const std::size_t begin = at_;
  MaterialDecl material;
  material.documentation = documentation_here();
  advance();
  material.name = declared_name("material");
  remembered_.clear();
  if (at(TokenKind::equals) || borrowed_origin()) {
    if (at(TokenKind::equals)) advance();
    in_origin_ = true;
    material.derived_from = expression();
  }
  // The brace may be on the next line, since nothing else begins with one.
  const bool has_block = here().kind == TokenKind::left_brace || (!material.derived_from && has_sections_below());
  if (has_block) {
    bool misplaced = false;
    block(false, [&] { material_section(material, misplaced); });
  } else if (!material.derived_from) {
    fail("expected `{` or `=`" + after_previous(), "`{` or `=`",
         fmt::format("write `material {} {{ … }}`", material.name.text));
  }
  material.span = since(begin);
  tree_.declarations.push_back(std::move(material));
  if (!has_block) end_statement();
}

}  // namespace wale
