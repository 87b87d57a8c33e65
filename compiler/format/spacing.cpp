#include "compiler/format/spacing.hpp"

#include "compiler/parse/parse.hpp"
#include "compiler/text/embedded_files.hpp"

namespace wale::formatting {
namespace {

void add_units(const SyntaxTree& tree, std::set<std::string>& units) {
  for (const Declaration& declaration : tree.declarations)
    if (const auto* unit = std::get_if<UnitDecl>(&declaration)) units.emplace(unit->name.text);
}

std::set<std::string> units_of_every_file() {
  std::set<std::string> units;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.common) continue;
    SourceSet sources;
    Diagnostics ignored;
    add_units(parse(sources, sources.add(std::string(file.name), std::string(file.text)), ignored), units);
  }
  return units;
}

bool ends_value(const Piece& piece) {
  switch (piece.token.kind) {
    case TokenKind::name:
    case TokenKind::number:
    case TokenKind::text:
    case TokenKind::percent:
    case TokenKind::prime:
    case TokenKind::part_x:
    case TokenKind::part_y:
    case TokenKind::right_bracket:
    case TokenKind::right_parenthesis: return true;
    default: return false;
  }
}

bool is_plus_or_minus(const Piece& piece) { return piece.is(TokenKind::minus) || piece.is(TokenKind::plus); }

/// `N/m` and `24/256` have no spaces; `10 N / 512` and `5 N / mass` have them. A `/` before a unit is tight; before
/// another name of a suffix, or between two numbers, it stays as written.
bool is_tight_slash(const std::vector<Piece>& pieces, std::size_t slash, const Roles& roles) {
  if (!pieces[slash].is(TokenKind::slash) || slash == 0 || slash + 1 >= pieces.size()) return false;
  const Piece &before = pieces[slash - 1], &after = pieces[slash + 1];
  const bool written_so = pieces[slash].touches && after.touches;
  if (before.is(TokenKind::number) && after.is(TokenKind::number)) return written_so;
  if (after.is_comment() || roles.divisors.count(after.token.begin) == 0) return false;
  return written_so || roles.units.count(after.text) > 0;
}

}  // namespace

Roles roles_of(const SyntaxTree& tree) {
  static const std::set<std::string> known_units = units_of_every_file();
  Roles roles;
  roles.units = known_units;
  add_units(tree, roles.units);
  for (std::size_t i = 0; i < tree.exprs.size(); ++i) {
    if (std::holds_alternative<Unary>(tree.exprs[i])) roles.signs.insert(tree.expr_spans[i].begin);
    if (const auto* call = std::get_if<Call>(&tree.exprs[i])) roles.called.insert(call->callee.span.begin);
    if (const auto* number = std::get_if<NumberLiteral>(&tree.exprs[i]))
      for (const SuffixFactor& factor : tree.suffix(*number))
        if (factor.divides) roles.divisors.insert(factor.name.span.begin);
  }
  for (const Declaration& declaration : tree.declarations) {
    const auto add_keys = [&](const std::vector<Setting>& settings) {
      for (const Setting& setting : settings) roles.setting_keys.insert(setting.key.span.begin);
    };
    if (const auto* function = std::get_if<FunctionDecl>(&declaration)) roles.called.insert(function->name.span.begin);
    if (const auto* record = std::get_if<RecordDecl>(&declaration)) add_keys(record->settings);
    if (const auto* material = std::get_if<MaterialDecl>(&declaration)) add_keys(material->representative);
    if (const auto* workspace = std::get_if<WorkspaceDecl>(&declaration))
      for (const PlacedStatement& placed : workspace->placed)
        std::visit([&](const auto& each) { add_keys(each.settings); }, placed);
  }
  return roles;
}

bool is_sign(const std::vector<Piece>& pieces, std::size_t index, const Roles& roles) {
  if (!is_plus_or_minus(pieces[index])) return false;
  std::size_t before = index;
  while (before > 0 && pieces[before - 1].is_comment()) --before;
  return before == 0 || !ends_value(pieces[before - 1]) || roles.signs.count(pieces[index].token.begin) > 0;
}

bool spaced(const std::vector<Piece>& pieces, std::size_t index, std::size_t parentheses, const Roles& roles) {
  const Piece &previous = pieces[index - 1], &piece = pieces[index];
  if (previous.is_comment() || piece.is_comment()) return true;
  if (previous.is(TokenKind::left_brace) && piece.is(TokenKind::right_brace)) return false;
  switch (piece.token.kind) {
    case TokenKind::comma:
    case TokenKind::prime:
    case TokenKind::part_x:
    case TokenKind::part_y:
    case TokenKind::right_bracket:
    case TokenKind::right_parenthesis:
    case TokenKind::caret: return false;
    case TokenKind::colon: return parentheses == 0;  // `state p : position`, but `period: 2 mm`
    case TokenKind::left_parenthesis:
      // After the key of a setting, where values are aligned, it has the space of an argument.
      if (roles.setting_keys.count(previous.token.begin) > 0) return true;
      if (previous.is(TokenKind::text)) return roles.called.count(previous.token.begin) == 0;
      if (previous.is(TokenKind::name)) return roles.called.count(previous.token.begin) == 0 && !piece.touches;
      break;
    case TokenKind::slash:
      if (is_tight_slash(pieces, index, roles)) return false;
      break;
    default: break;
  }
  switch (previous.token.kind) {
    case TokenKind::left_bracket:
    case TokenKind::left_parenthesis:
    case TokenKind::caret: return false;
    case TokenKind::slash: return !is_tight_slash(pieces, index - 1, roles);
    case TokenKind::minus:
    case TokenKind::plus:
      // `+-` would be read as a tolerance.
      return is_plus_or_minus(piece) || !is_sign(pieces, index - 1, roles);
    default: return true;
  }
}

}  // namespace wale::formatting
