#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/parse/lex.hpp"
#include "compiler/parse/lookalikes.hpp"
#include "compiler/text/characters.hpp"
#include "compiler/text/source.hpp"
#include "schema/utf8.hpp"

namespace wale {

/// Cuts the text of one file into tokens. Call it through `lex` in `lex.hpp`.
class Lexer {
 public:
  Lexer(const SourceSet& sources, SourceId source, Diagnostics& diagnostics)
      : source_(source), diagnostics_(diagnostics), is_full_(diagnostics.all().size() >= error_limit) {
    result_.source = sources.kept(source);
    text_ = result_.source->text;
  }

  Tokens run();

 private:
  // lex.cpp: correct tokens
  bool is_readable();
  void next();
  void line_comment();
  void block_comment();
  void number();
  void digits();
  void several_points(std::size_t begin);
  void exponent();
  void name();
  /// `fabric.denim` is one name; the dots of `low..high` do not belong to a name.
  bool is_dot_in_name() const { return here() == '.' && begins_name(after()); }
  void text(std::size_t quote_bytes);
  void rewritten_text(std::size_t begin, std::size_t inside, bool typographic);
  char escape();
  void add_symbol(TokenKind kind, std::size_t bytes);
  bool symbol();
  bool is_part() const;
  void match_brackets(TokenKind kind, std::uint32_t index);
  void add_text(std::size_t begin, std::string_view value);
  std::uint32_t add_number(double value);
  void add(TokenKind kind, std::size_t begin, std::uint32_t value = 0) {
    result_.tokens.push_back({kind, starts_line_, statement_end(kind), static_cast<std::uint32_t>(begin),
                              static_cast<std::uint32_t>(at_), value});
    starts_line_ = false;
  }
  /// Whether a statement ends before a token of that kind here.
  StatementEnd statement_end(TokenKind kind) const {
    if (kind == TokenKind::end || kind == TokenKind::semicolon || kind == TokenKind::right_brace)
      return StatementEnd::yes;
    return starts_line_ && is_statement_line(kind) ? StatementEnd::outside_parentheses : StatementEnd::no;
  }
  bool is_statement_line(TokenKind kind) const;

  // lex_mend.cpp: bytes that form no token, and the tokens that were evidently meant
  std::vector<Fix> leading_zero(std::size_t begin) const;
  void out_of_range(std::size_t begin, std::string_view digits);
  void hexadecimal();
  void foreign_name();
  void add_corrected(std::string name, std::size_t begin);
  bool may_be_lookalike() const;
  bool quote();
  std::vector<Fix> quote_fixes(std::size_t begin, std::size_t inside) const;
  bool lookalike();
  std::vector<Fix> lookalike_fixes(const Lookalike& each, std::size_t begin) const;
  void unknown(const Character& character);
  std::vector<Fix> unknown_fixes(std::size_t begin, bool visible) const;

  /// The current byte and the next one; a NUL at the end of the text and nowhere else.
  char here() const { return text_.data()[at_]; }
  char after() const { return at_ < text_.size() ? text_.data()[at_ + 1] : '\0'; }
  bool starts(std::string_view spelling) const {
    // Called for every spelling of a table; most differ in their first byte.
    if (text_.size() - at_ < spelling.size()) return false;
    for (std::size_t i = 0; i < spelling.size(); ++i)
      if (text_[at_ + i] != spelling[i]) return false;
    return true;
  }
  Span span(std::size_t begin, std::size_t end) const {
    return {source_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }
  [[gnu::cold]] void report(Code code, std::size_t begin, std::size_t end, std::string message, std::string help,
                            std::vector<Fix> fixes = {}, std::vector<Fact> facts = {}, std::string rule = {});

  std::string_view text_;  ///< the text of `result_.source`
  SourceId source_;
  Diagnostics& diagnostics_;
  bool is_full_;  ///< the error limit is reached; the rest is not read
  Tokens result_;
  std::size_t at_ = 0;
  bool starts_line_ = true;
  std::vector<std::uint32_t> open_;  ///< brackets not yet closed
  std::set<std::string, std::less<>> reported_names_;
};

}  // namespace wale
