#pragma once

#include <set>
#include <string>

#include "compiler/format/pieces.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale::formatting {

/// What the tokens alone do not tell, as the bytes at which they begin.
struct Roles {
  std::set<std::uint32_t> signs;         ///< `-` and `+` that belong to the value behind them
  std::set<std::uint32_t> called;        ///< names before their `(`
  std::set<std::uint32_t> divisors;      ///< names behind a `/` that is part of a number's suffix
  std::set<std::uint32_t> setting_keys;  ///< names that begin a setting
  std::set<std::string> units;           ///< declared in this file or known to every file
};

Roles roles_of(const SyntaxTree& tree);

/// Whether `pieces[index]` is a sign rather than an operator between two values.
bool is_sign(const std::vector<Piece>& pieces, std::size_t index, const Roles& roles);

/// Whether a space stands before `pieces[index]` in a line that `pieces[index - 1]` does not end. `parentheses` is how
/// many are open.
bool spaced(const std::vector<Piece>& pieces, std::size_t index, std::size_t parentheses, const Roles& roles);

}  // namespace wale::formatting
