#include "compiler/format/pieces.hpp"

#include <algorithm>

namespace wale::formatting {
namespace {

std::string_view without_blanks_at_end(std::string_view line) {
  while (!line.empty() && std::string_view(" \t\r\f\v").find(line.back()) != std::string_view::npos)
    line.remove_suffix(1);
  return line;
}

/// Writes `//why` as `// why`; a row of slashes stays as it is.
std::string line_comment(std::string_view text) {
  text = without_blanks_at_end(text);
  const std::size_t slashes = std::min(text.find_first_not_of('/'), text.size());
  std::string result(text.substr(0, slashes));
  const std::string_view rest = text.substr(slashes);
  if (slashes < 4 && !rest.empty() && rest.front() != ' ' && rest.front() != '\t') result += ' ';
  return result.append(rest);
}

std::string block_comment(std::string_view text) {
  std::string result;
  for (;;) {
    const std::size_t newline = text.find('\n');
    result += without_blanks_at_end(text.substr(0, newline));
    if (newline == std::string_view::npos) return result;
    result += '\n';
    text.remove_prefix(newline + 1);
  }
}

bool documents(std::string_view comment) { return comment.starts_with("///") && !comment.starts_with("////"); }

/// Reads the gaps between tokens; everything in them that is not white space is a comment.
class Collector {
 public:
  Collector(std::string_view text, const Tokens& tokens) : text_(text), tokens_(tokens.tokens) {}

  std::vector<Piece> run() {
    for (const Token& token : tokens_) {
      const std::size_t first_comment = pieces_.size();
      gap(token.begin);
      at_ = token.end;
      if (token.kind == TokenKind::semicolon) {
        // A comment before a `;` documents nothing. Without the `;` it would document what comes next.
        for (std::size_t i = first_comment; i < pieces_.size(); ++i)
          if (documents(pieces_[i].text)) pieces_[i].text.erase(0, 1);
        after_semicolon_ = true;
        newlines_before_semicolon_ = std::max(newlines_before_semicolon_, newlines_);
        newlines_ = 0;
        touches_ = false;
      } else if (token.kind != TokenKind::end) {
        const bool tolerance = token.kind == TokenKind::plus_minus;
        add(Piece::Kind::token, tolerance ? "±" : std::string(text_.substr(token.begin, token.end - token.begin)),
            token);
      }
    }
    return std::move(pieces_);
  }

 private:
  void gap(std::size_t end) {
    while (at_ < end) {
      if (text_.substr(at_).starts_with("//")) {
        const std::size_t newline = std::min(text_.find('\n', at_), end);
        add(Piece::Kind::line_comment, line_comment(text_.substr(at_, newline - at_)));
        at_ = newline;
      } else if (text_.substr(at_).starts_with("/*")) {
        const std::size_t close = text_.find("*/", at_ + 2) + 2;
        add(Piece::Kind::block_comment, block_comment(text_.substr(at_, close - at_)));
        at_ = close;
      } else {
        newlines_ += text_[at_++] == '\n';
        touches_ = false;
      }
    }
  }

  void add(Piece::Kind kind, std::string text, Token token = {}) {
    newlines_ = std::max(newlines_, newlines_before_semicolon_);
    pieces_.push_back({kind, token, std::move(text), newlines_, after_semicolon_, touches_});
    newlines_ = newlines_before_semicolon_ = 0;
    after_semicolon_ = false;
    touches_ = true;
  }

  std::string_view text_;
  const std::vector<Token>& tokens_;
  std::vector<Piece> pieces_;
  std::size_t at_ = 0;
  unsigned newlines_ = 0, newlines_before_semicolon_ = 0;
  bool after_semicolon_ = false;
  bool touches_ = false;
};

}  // namespace

std::vector<Piece> pieces_of(std::string_view text, const Tokens& tokens) { return Collector(text, tokens).run(); }

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace wale::formatting
