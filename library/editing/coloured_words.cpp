#include <algorithm>

#include "compiler/parse/lex.hpp"
#include "library/editing/proposals.hpp"

namespace wale {
namespace {

/// The comments between two tokens.
void add_comments(std::string_view text, std::size_t begin, std::size_t end, std::vector<ColouredWord>& words) {
  while (begin < end) {
    const std::string_view rest = text.substr(begin, end - begin);
    const bool is_line = rest.starts_with("//");
    if (!is_line && !rest.starts_with("/*")) {
      ++begin;
      continue;
    }
    const std::size_t close = is_line ? rest.find('\n') : rest.find("*/", 2);
    const std::size_t length = close == std::string_view::npos ? rest.size() : close + (is_line ? 0 : 2);
    words.push_back({begin, begin + length, rest.starts_with("///") ? WordKind::documentation : WordKind::comment});
    begin += length;
  }
}

bool is_reserved(TokenKind kind) { return kind >= TokenKind::word_if && kind <= TokenKind::word_not; }

}  // namespace

std::vector<ColouredWord> coloured_words(std::string_view text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const Tokens tokens = lex(sources, sources.add("text", std::string(text)), diagnostics);
  std::vector<ColouredWord> words;
  std::size_t behind = 0;
  bool in_suffix = false, divides = false, begins = true;
  for (const Token& token : tokens.tokens) {
    const std::size_t end = std::min<std::size_t>(token.end, text.size());
    const std::size_t begin = std::min<std::size_t>(token.begin, end);
    add_comments(text, behind, token.kind == TokenKind::end ? text.size() : begin, words);
    if (token.kind == TokenKind::end) break;
    behind = end;
    begins = begins || token.starts_line;
    WordKind kind = WordKind::symbol;
    if (token.kind == TokenKind::number) kind = WordKind::number;
    else if (token.kind == TokenKind::text) kind = WordKind::text;
    else if (token.kind == TokenKind::percent) kind = WordKind::unit;
    else if (is_reserved(token.kind)) kind = WordKind::keyword;
    else if (token.kind == TokenKind::name)
      kind = (in_suffix || divides) && !token.starts_line                   ? WordKind::unit
             : begins && is_statement_word(text.substr(begin, end - begin)) ? WordKind::keyword
                                                                            : WordKind::name;
    // `120 N/m^2`: names behind a number, and those behind a `/` there, are units.
    divides = token.kind == TokenKind::slash && in_suffix;
    in_suffix = token.kind == TokenKind::number || (kind == WordKind::unit && token.kind == TokenKind::name);
    begins = token.kind == TokenKind::left_brace || token.kind == TokenKind::right_brace ||
             token.kind == TokenKind::semicolon;
    words.push_back({begin, end, kind});
  }
  return words;
}

}  // namespace wale
