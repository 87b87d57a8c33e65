#include "compiler/format/lines.hpp"

#include <algorithm>
#include <compare>
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
      if (begin == 0 || row_.pieces[begin].newlines > 0) measure(begin, end);
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

  /// How well a line may be broken before a piece: in the outermost parentheses, there at the loosest bond.
  struct Break {
    std::size_t depth = ~std::size_t{0};
    int bond = 0;
    auto operator<=>(const Break&) const = default;
  };

  /// Finds the widths and the breaks of the pieces `begin` .. `end`, of which several lines may be made: a long sum has
  /// thousands.
  void measure(std::size_t begin, std::size_t end) {
    const std::size_t code = end_of_code(begin, end);
    const auto& pieces = row_.pieces;
    from_ = begin;
    widths_.assign(1, 0);
    spaces_.assign(1, false);
    breaks_.assign(code - begin + 1, {});
    std::size_t depth = open_.size();
    bool in_block = false;  // a block on one line fits
    for (std::size_t i = begin; i < code; ++i) {
      const Piece& piece = pieces[i];
      widths_.push_back(widths_.back() + (spaces_.back() ? 1 : 0) + width_of(piece.text));
      if (piece.is(TokenKind::left_parenthesis)) ++depth;
      if (piece.is(TokenKind::right_parenthesis) && depth > 0) --depth;
      spaces_.push_back(i + 1 < code && spaced(pieces, i + 1, depth, roles_));
      in_block = in_block || piece.is(TokenKind::left_brace);
      if (i + 1 == code || in_block || piece.is_comment()) continue;
      const Piece& next = pieces[i + 1];
      const bool conditional = next.is(TokenKind::word_then) || next.is(TokenKind::word_else);
      const auto found = conditional ? bond_of_conditional : bond(piece.token.kind);
      if (!found || (!conditional && depth == 0 && !continues(piece.token.kind))) continue;
      if (is_sign(pieces, i, roles_) || next.is(TokenKind::right_parenthesis)) continue;
      if (!conditional && !spaces_.back()) continue;  // keeps N/m together
      breaks_[i + 1 - begin] = {depth, *found};
    }
    best_ = breaks_;
    for (std::size_t i = best_.size() - 1; i-- > 0;) best_[i] = std::min(best_[i], best_[i + 1]);
  }

  /// Where a line of these pieces is broken if it is too long: at the best break, there as far to the right as fits.
  /// Returns the piece that begins the next line.
  std::optional<std::size_t> place_to_break(std::size_t begin, std::size_t end) const {
    const std::size_t code = end_of_code(begin, end);
    if (begin - from_ + 1 >= best_.size()) return std::nullopt;  // only comments are left
    const std::size_t before = widths_[begin - from_] + (spaces_[begin - from_] ? 1 : 0);
    const auto fits = [&](std::size_t until) {
      return indentation_ + widths_[until - from_] - before <= format_columns;
    };
    if (fits(code)) return std::nullopt;
    const auto first = breaks_.begin() + static_cast<std::ptrdiff_t>(begin + 1 - from_);
    const bool whole = code + 1 == from_ + breaks_.size();
    const Break best = whole ? best_[begin + 1 - from_]
                       : begin + 1 == code
                           ? Break{}
                           : *std::min_element(first, first + static_cast<std::ptrdiff_t>(code - begin - 1));
    if (best == Break{}) return std::nullopt;
    std::optional<std::size_t> at;
    for (std::size_t i = begin + 1; i < code && (!at || fits(i)); ++i)
      if (breaks_[i - from_] == best) at = i;
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
  std::size_t from_ = 0;              ///< the piece with which the measured ones begin
  std::vector<std::size_t> widths_;   ///< of the text up to each of them, and of all
  std::vector<bool> spaces_;          ///< whether there is a space before each
  std::vector<Break> breaks_, best_;  ///< before each; the best before it or a later one
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
