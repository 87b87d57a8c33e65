#include "compiler/format/lines.hpp"

#include <algorithm>
#include <optional>

#include "compiler/format/format.hpp"
#include "compiler/parse/parser.hpp"

namespace wale::formatting {
namespace {

/// How well a line may be broken after a token, best first; empty if it may not be broken there.
std::optional<int> bond(TokenKind kind) {
  switch (kind) {
    case TokenKind::comma: return 0;
    case TokenKind::equals: return 1;
    case TokenKind::range: return 2;
    case TokenKind::word_or: return 4;
    case TokenKind::word_and: return 5;
    case TokenKind::less:
    case TokenKind::less_equal:
    case TokenKind::greater:
    case TokenKind::greater_equal:
    case TokenKind::plus_minus: return 6;
    case TokenKind::plus:
    case TokenKind::minus: return 7;
    case TokenKind::star:
    case TokenKind::slash: return 8;
    default: return std::nullopt;
  }
}
constexpr int bond_of_conditional = 3;

/// Lays out one row; pieces `begin` .. `end` of it are a line.
class RowSetter {
 public:
  RowSetter(const Row& row, const Roles& roles, std::vector<Line>& lines) : row_(row), roles_(roles), lines_(lines) {}

  void run() {
    std::size_t begin = 0;
    while (begin < row_.pieces.size()) {
      std::size_t end = begin + 1;
      while (end < row_.pieces.size() && row_.pieces[end].newlines == 0) ++end;
      indentation_ = indentation_at(begin);
      while (const auto at = place_to_break(begin, end)) end = *at;
      set(begin, end);
      begin = end;
    }
  }

 private:
  std::size_t indentation_at(std::size_t begin) const {
    const std::size_t base = 2 * row_.depth;
    const Piece& first = row_.pieces[begin];
    if (!open_.empty()) return first.is(TokenKind::right_parenthesis) ? open_.back() : open_.back() + 2;
    return begin == 0 || first.is(TokenKind::left_brace) ? base : base + 2;
  }

  /// Separates the comments at the end of a line from its text, unless the line is only a comment.
  std::size_t end_of_code(std::size_t begin, std::size_t end) const {
    std::size_t code = end;
    while (code > begin && row_.pieces[code - 1].is_comment()) --code;
    return code > begin ? code : end;
  }

  std::string text(std::size_t begin, std::size_t end, Line* line = nullptr) const {
    std::string result;
    std::size_t parentheses = open_.size();
    for (std::size_t i = begin; i < end; ++i) {
      const Piece& piece = row_.pieces[i];
      if (i > begin && spaced(row_.pieces, i, parentheses, roles_)) result += ' ';
      if (line != nullptr) mark_description(i, parentheses, result.size(), *line);
      result += piece.text;
      if (line != nullptr && i == last_of_name_) line->value = {result.size(), width_of(name_), kind_};
      if (piece.is(TokenKind::left_parenthesis)) ++parentheses;
      if (piece.is(TokenKind::right_parenthesis) && parentheses > 0) --parentheses;
    }
    return result;
  }

  /// Finds the name of a setting, or of a declaration whose `=` or `:` may be aligned with its neighbours'.
  void find_name() {
    const auto& pieces = row_.pieces;
    if (pieces[0].is_comment()) return;
    if (roles_.setting_keys.count(pieces[0].token.begin) > 0) {
      last_of_name_ = 0;
      name_ = pieces[0].text;
      kind_ = setting;
      return;
    }
    std::size_t after = 0;
    while (after < pieces.size() && (pieces[after].is(TokenKind::name) || pieces[after].is(TokenKind::percent)))
      ++after;
    if (after < 2 || after == pieces.size()) return;
    if (!pieces[after].is(TokenKind::equals) && !pieces[after].is(TokenKind::colon)) return;
    last_of_name_ = after - 1;
    name_ = pieces[after - 1].text;
    for (std::size_t i = 0; i + 1 < after; ++i) kind_ += pieces[i].text + " ";
  }

  void mark_description(std::size_t index, std::size_t parentheses, std::size_t at, Line& line) const {
    const Piece& piece = row_.pieces[index];
    if (kind_.ends_with("param ") && index + 1 == row_.pieces.size() && piece.is(TokenKind::text) && parentheses == 0)
      line.description = {at, 0, kind_};
  }

  /// Where a line of these pieces is broken if it is too long: in the outermost parentheses that can be broken, there
  /// at the loosest bond, there as far to the right as fits. Returns the piece that begins the next line.
  std::optional<std::size_t> place_to_break(std::size_t begin, std::size_t end) const {
    const std::size_t code = end_of_code(begin, end);
    const auto fits = [&](std::size_t until) { return indentation_ + width_of(text(begin, until)) <= format_columns; };
    if (fits(code)) return std::nullopt;
    struct Candidate {
      std::size_t depth;
      int bond;
      std::size_t at;
    };
    std::vector<Candidate> candidates;
    std::size_t depth = open_.size();
    for (std::size_t i = begin; i + 1 < code; ++i) {
      const Piece &piece = row_.pieces[i], &next = row_.pieces[i + 1];
      if (piece.is(TokenKind::left_brace)) break;  // a block on one line fits
      if (piece.is(TokenKind::left_parenthesis)) ++depth;
      if (piece.is(TokenKind::right_parenthesis) && depth > 0) --depth;
      if (piece.is_comment()) continue;
      const bool conditional = next.is(TokenKind::word_then) || next.is(TokenKind::word_else);
      const auto found = conditional ? bond_of_conditional : bond(piece.token.kind);
      if (!found || (!conditional && depth == 0 && !continues(piece.token.kind))) continue;
      if (is_sign(row_.pieces, i, roles_) || next.is(TokenKind::right_parenthesis)) continue;
      if (!conditional && !spaced(row_.pieces, i + 1, depth, roles_)) continue;  // keeps N/m together
      candidates.push_back({depth, *found, i + 1});
    }
    const auto best = std::min_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
      return a.depth != b.depth ? a.depth < b.depth : a.bond < b.bond;
    });
    if (best == candidates.end()) return std::nullopt;
    std::size_t at = best->at;
    for (const Candidate& each : candidates)
      if (each.depth == best->depth && each.bond == best->bond && fits(each.at)) at = each.at;
    return at;
  }

  void set(std::size_t begin, std::size_t end) {
    const std::size_t code = end_of_code(begin, end);
    Line line;
    line.indentation = indentation_;
    line.begins_row = begin == 0;
    line.blank_before = begin == 0 && row_.blank_before;
    line.only_comments = row_.pieces[code - 1].is_comment();
    if (begin == 0) find_name();
    line.text = text(begin, code, begin == 0 ? &line : nullptr);
    for (std::size_t i = code; i < end; ++i) line.comment += (i == code ? "" : " ") + row_.pieces[i].text;
    if (end == row_.pieces.size()) {
      line.comment += (line.comment.empty() || row_.trailing.empty() ? "" : " ") + row_.trailing;
      line.opens_block = row_.pieces.back().is(TokenKind::left_brace);
      line.closes_block = row_.pieces.front().is(TokenKind::right_brace);
    }
    for (std::size_t i = begin; i < end; ++i) {
      if (row_.pieces[i].is(TokenKind::left_parenthesis)) open_.push_back(indentation_);
      if (row_.pieces[i].is(TokenKind::right_parenthesis) && !open_.empty()) open_.pop_back();
    }
    lines_.push_back(std::move(line));
  }

  static constexpr const char* setting = "setting";
  static constexpr std::size_t none = ~std::size_t{0};

  const Row& row_;
  const Roles& roles_;
  std::vector<Line>& lines_;
  std::vector<std::size_t> open_;  ///< indentations of the lines with the open parentheses
  std::size_t indentation_ = 0;
  std::size_t last_of_name_ = none;
  std::string name_, kind_;
};

}  // namespace

std::vector<Line> lines_of(const std::vector<Row>& rows, const Roles& roles) {
  std::vector<Line> lines;
  for (const Row& row : rows) RowSetter(row, roles, lines).run();
  return lines;
}

}  // namespace wale::formatting
