#pragma once

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/parse/lex.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// Thrown where a statement cannot be read any further, caught before the next one. Never leaves the parser.
struct Abandon {};

/// How deep parentheses, calls, signs, powers and conditionals may be nested.
constexpr std::size_t deepest_nesting = 200;
/// The greatest height of an expression's tree, which grows also with the terms of a sum: later stages recurse into it.
constexpr std::size_t highest_expression = 1000;

/// The most statements of one file. People write hundreds; later stages compare each name with all others. Ten thousand
/// patches of a workspace must fit, so a setting of a patch counts as a tenth.
constexpr std::size_t most_statements = 16000;
constexpr std::size_t settings_per_statement = 10;

/// The beginning of a physical statement: its keyword, the prime of `x' = …`, or a `=` if the keyword is missing.
enum class PhysicalKeyword { param, let, height, force, patch, active, state, memory, next, show, prime, equals };

/// The kind of statement that begins with a word; empty if none does.
std::optional<PhysicalKeyword> physical_keyword_named(std::string_view word);

/// Recursive descent over the tokens of one file, by the grammar in schema/wale.grammar. Call it through `parse.hpp`.
///
/// At most one error is reported for a statement, since after the first one the rest is guesswork.
class Parser {
 public:
  Parser(const SourceSet& sources, Tokens& input, SyntaxTree& tree, Diagnostics& diagnostics)
      : sources_(sources),
        text_(input.source->text),
        input_(input),
        tokens_(input.tokens),
        tree_(tree),
        diagnostics_(diagnostics) {
    heights_.reserve(tree.exprs.capacity());
    open_arguments_.reserve(few);
    open_parentheses_.reserve(few);
  }

  void file();
  std::vector<ExprId> expression_list();

 private:
  // parse.cpp: declarations
  bool version();
  void declaration();
  bool ends_lostness() const;
  void import_module();
  void dimension(bool exported);
  void unit(bool exported);
  void constant(bool exported);
  void function(bool exported);
  FormalParameter formal_parameter();
  void record(bool exported);
  void material();

  bool borrowed_origin();

  // parse_workspace.cpp
  void workspace();
  PlacedStatement placed_statement();
  PatchPlacing placed_patch();
  PicturePlacing placed_picture();
  std::vector<Setting> placed_settings();

  // parse_block.cpp: blocks in braces
  Setting setting();
  [[noreturn]] void next_setting();
  SettingItem setting_item();
  bool is_leading_word() const;
  std::optional<std::string_view> section_of_other_languages();
  void material_section(MaterialDecl& material, bool& misplaced);
  bool has_sections_below() const;
  [[gnu::cold]] void stray_statement(MaterialDecl& material, bool& misplaced);
  PerceptStatement percept_statement();
  [[gnu::cold]] void second_percept(std::size_t level);
  void no_physics_here();
  void mistyped_level();
  // parse_physical.cpp: statements of a physical block
  PhysicalStatement physical_statement();
  PhysicalKeyword physical_keyword();
  std::pair<Word, ExprId> definition(PhysicalKeyword keyword);
  ForceStatement force();
  ParamStatement param();
  StateStatement state();
  MemoryStatement memory();
  std::optional<Word> optional_dimension();
  UpdateStatement update();
  void no_equals(const char* keyword, const char* what, const char* expected);
  void two_lengths(std::size_t first);
  void no_comma(const char* what);
  PatchStatement patch();
  ActiveStatement active();
  std::optional<Range> optional_range();
  template <class Read>
  void once(std::string_view what, Read read);
  Range range();
  // parse_block.cpp again
  void open_block();
  [[gnu::cold]] void missing_brace(std::size_t open);
  bool ends_block_by_mistake(bool in_section) const;
  bool is_inside_closed_declaration() const;
  [[gnu::cold]] void misplaced_declaration();
  bool names_of_block_in(std::size_t begin, std::size_t end) const;
  std::vector<Fix> move_behind_declaration(std::size_t begin) const;
  template <class Body>
  Span block(bool in_section, Body body);

  // parse_expression.cpp
  ExprId expression();
  ExprId operation(int least_precedence);
  ExprId complement();
  ExprId signed_operand();
  ExprId negated();
  void nest() {
    if (++nesting_ > deepest_nesting) nested_too_deep();
  }
  [[noreturn, gnu::cold]] void nested_too_deep();
  [[noreturn, gnu::cold]] void no_operand(bool next_statement);
  ExprId power();
  ExprId raised(ExprId base);
  ExprId operand();
  ExprId number();
  ExprId text();
  ExprId name();
  ExprId call();
  Argument argument();
  ExprId parenthesised();
  bool begins_operand(std::size_t index) const;
  bool has_word_for_this_if(TokenKind word) const;
  ExprId conditional();
  bool suffix_factor();
  bool is_suffix_name(std::size_t index) const;
  bool begins_number(std::size_t index) const {
    return kind(index) == TokenKind::number ||
           (kind(index) == TokenKind::minus && kind(index + 1) == TokenKind::number);
  }
  void close_parenthesis(std::string_view expected);
  std::string unclosed_parenthesis() const;
  template <class Node>
  ExprId add(const Node& node, Span span, std::initializer_list<ExprId> children = {});
  [[noreturn, gnu::cold]] void grown_too_high(Span span);

  // parse_mend.cpp: fixes
  bool begins_argument(std::size_t index) const;
  bool is_in_call() const;
  bool is_doubled() const;
  bool is_inch_here() const;
  bool is_like(std::size_t index) const;
  bool is_where_clause() const;
  bool closes_in_line(std::size_t open) const;
  bool is_call_of_curve() const;
  std::string_view parentheses_at(std::size_t open) const;
  std::string_view value_at(std::size_t index) const;
  std::string_view rest_of_statement(std::size_t index) const;
  static std::vector<std::string> words_of_evidence();
  std::string_view value_before(std::size_t index) const;
  std::string mend_limit() const;
  std::string mend_argument() const;
  std::string mend_other_order() const;
  std::string mend_origin() const;
  std::vector<Fix> fix_argument() const;
  std::vector<Fix> fix_origin() const;
  std::vector<Fix> fixes_here() const;
  std::vector<Fix> insert_equals() const;
  std::vector<Fix> insert_range() const;
  std::vector<Fix> drop_here() const;
  std::vector<Fix> move_operator_up() const;
  std::vector<Fix> insert_opening_brace() const;
  std::vector<Fix> insert_brace(std::size_t open) const;
  std::vector<Fix> unquote(bool is_module) const;
  std::vector<Fix> state_version(bool is_wale, bool has_number, bool is_declaration) const;
  std::vector<Fix> respell_here(const std::vector<std::string>& candidates) const;

  // parse_borrowed.cpp: words of other languages
  [[gnu::cold]] std::optional<PhysicalKeyword> borrowed_keyword();
  [[gnu::cold]] std::string mend_borrowed(std::string_view word) const;
  [[gnu::cold]] void missing_comma(std::string_view word);

  // parse_cursor.cpp: the current place, messages, recovery
  const Token& here() const { return tokens_[at_]; }
  const Token& token(std::size_t index) const { return tokens_[std::min(index, tokens_.size() - 1)]; }
  TokenKind kind(std::size_t index) const { return token(index).kind; }
  /// Whether the current token has that kind and belongs to this statement.
  bool at(TokenKind kind) const { return here().kind == kind && !ends_statement(at_); }
  bool followed_by(TokenKind next) const { return kind(at_ + 1) == next && !ends_statement(at_ + 1); }
  bool is_word(std::size_t index, std::string_view word) const;
  /// Whether a word there says how well a figure is known, as in `0.35 estimated`.
  bool is_evidence(std::size_t index) const;
  bool ends_statement(std::size_t index) const {
    const StatementEnd ends = token(index).ends_statement;
    return ends != StatementEnd::no && (ends == StatementEnd::yes || open_parentheses_.empty());
  }
  bool begins_statement(std::size_t index) const;
  bool begins_declaration(std::size_t index) const;
  void advance() { at_ += at_ + 1 < tokens_.size() ? 1 : 0; }
  Word take_word() {
    const Token& taken = here();
    advance();
    return {spelling(taken), span_of(taken)};
  }
  Word declared_name(std::string_view declares);
  [[gnu::cold]] Word joined_name(std::string_view declares, const Word& first);
  /// Consumes the current token if it has that kind and belongs to this statement.
  bool take(TokenKind kind) {
    if (!at(kind)) return false;
    advance();
    return true;
  }
  /// Reports that a token is missing here; the caller continues as if it were there.
  /// Reports a part of a statement, from a token up to the current one, that may be there only once.
  [[gnu::cold]] void complain_again(std::string_view what, std::size_t begin);
  [[gnu::cold]] void missing(std::string_view spelling, std::string help = {}, std::vector<Fix> fixes = {});

  Span span_of(const Token& token) const { return {tree_.source, token.begin, token.end}; }
  /// The span from `first_token` to the token before the current one, or that of `first_token` alone.
  Span since(std::size_t first_token) const {
    const std::uint32_t begin = tokens_[first_token].begin;
    return {tree_.source, begin, std::max(begin, tokens_[at_ > first_token ? at_ - 1 : first_token].end)};
  }
  Span joined(Span first, Span last) const { return {first.source, first.begin, last.end}; }
  /// A token's spelling: that in the text, or the one that the lexer corrected.
  std::string_view spelling(const Token& token) const {
    if (token.kind == TokenKind::name && token.value > 0) return input_.texts[token.value - 1];
    return {text_.data() + token.begin, token.end - token.begin};
  }
  std::string shown(const Token& token) const;
  std::string found_here() const;
  [[gnu::cold]] std::string after_previous() const;
  std::string_view documentation_here();

  /// Reports an error at the current token, or just after the last token if the statement has ended.
  Span place_here() const;
  [[gnu::cold]] void complain(std::string message, std::string expected, std::string help, std::vector<Fix> fixes = {},
                              std::vector<SecondarySpan> secondary = {});
  [[gnu::cold]] void complain_at(Code code, Span span, std::string message, std::string expected, std::string found,
                                 std::string help, std::vector<Fix> fixes = {},
                                 std::vector<SecondarySpan> secondary = {}, std::vector<Fact> facts = {});
  [[noreturn, gnu::cold]] void fail(std::string message, std::string expected, std::string help,
                                    std::vector<Fix> fixes = {}, std::vector<SecondarySpan> secondary = {});
  ExprId erroneous(std::size_t first_token) { return add(Erroneous{}, since(first_token)); }
  [[gnu::cold]] std::string mend_here() const;
  bool is_call_without_parentheses() const;
  bool begins_another_statement(const Token& word, const Token& after) const;
  void end_statement();
  [[noreturn, gnu::cold]] void give_up();
  void count_statement();
  bool is_stray_brace() const;
  [[gnu::cold]] void skip_statement();
  /// Reads one statement. Afterwards the parser is at the beginning of the next one, even after an error.
  template <class Body>
  void statement(Body body);

  /// Room for the arguments and parentheses that are usually open at once.
  static constexpr std::size_t few = 8;

  const SourceSet& sources_;
  std::string_view text_;  ///< the file's text
  Tokens& input_;
  std::span<const Token> tokens_;
  SyntaxTree& tree_;
  Diagnostics& diagnostics_;
  std::vector<std::uint32_t> heights_;         ///< height of each expression's tree
  std::vector<Argument> open_arguments_;       ///< arguments of the calls that are being read, the innermost last
  std::vector<std::size_t> open_parentheses_;  ///< their tokens; newlines inside are white space
  std::size_t at_ = 0;
  std::size_t statement_begin_ = 0;
  std::size_t nesting_ = 0;
  std::optional<ExprId> last_expression_;  ///< the last one in this statement
  bool reported_ = false;                  ///< an error in this statement has been reported
  bool brace_missing_ = false;             ///< a wrong brace in this declaration has been reported
  std::vector<std::size_t> open_blocks_;   ///< the tokens of the blocks that are being read, the innermost last
  std::size_t statements_ = 0;             ///< in settings
  std::vector<std::string_view> remembered_;  ///< states and memories of the material that is being read
  bool lost_ = false;                         ///< outside all declarations, which has been reported
  bool in_setting_ = false;                   ///< words of evidence end a unit: `0.3 kg assumed`, `roughness 0.3 estimated`
  bool in_force_ = false;                     ///< `limit` ends a unit: `k * 5 mm limit 2 N`
  bool in_range_ = false;   ///< `soft`, `cell` and `to` end a unit: `in 1 mm .. 5 mm soft 2 mm .. 3 mm`
  bool in_placed_ = false;  ///< in the block of a patch of a workspace: `patch NAME =` begins the next patch
  bool in_origin_ = false;  ///< of a material: `= 0.5 corduroy(wale: 1 mm) + 0.5 denim`
};

template <class Node>
ExprId Parser::add(const Node& node, Span span, std::initializer_list<ExprId> children) {
  std::uint32_t height = 1;
  for (const ExprId child : children) height = std::max(height, heights_[child] + 1);
  if (height > highest_expression) grown_too_high(span);
  tree_.exprs.emplace_back(node);
  tree_.expr_spans.push_back(span);
  heights_.push_back(height);
  return static_cast<ExprId>(tree_.exprs.size() - 1);
}

template <class Body>
void Parser::statement(Body body) {
  const std::size_t begin = at_;
  statement_begin_ = begin;
  reported_ = in_setting_ = in_force_ = in_range_ = in_origin_ = false;
  last_expression_.reset();
  open_parentheses_.clear();
  open_arguments_.clear();
  nesting_ = 0;
  try {
    count_statement();
    body();
  } catch (const Abandon&) {
    skip_statement();
  }
  if (at_ == begin) advance();
}

/// Reads a part of a statement that is there again, as a second `limit`; the first one counts.
template <class Read>
void Parser::once(std::string_view what, Read read) {
  const std::size_t begin = at_;
  read();
  complain_again(what, begin);
}

/// Reads `{`, statements, `}`. `body` reads one statement up to its end.
template <class Body>
Span Parser::block(bool in_section, Body body) {
  const std::size_t open = at_;
  open_block();
  open_blocks_.push_back(open);
  for (;;) {
    while (here().kind == TokenKind::semicolon) advance();
    if (here().kind == TokenKind::right_brace) break;
    if (begins_declaration(at_) && is_inside_closed_declaration()) {
      statement([&] { misplaced_declaration(); });
      continue;
    }
    if (ends_block_by_mistake(in_section)) {
      missing_brace(open);
      open_blocks_.pop_back();
      return since(open);
    }
    statement(body);
  }
  open_blocks_.pop_back();
  advance();
  return since(open);
}

}  // namespace wale
