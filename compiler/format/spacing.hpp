#pragma once

#include <set>
#include <string>

#include "compiler/format/pieces.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale::formatting {

/// The roles of tokens that follow from the tree, by the byte at which each token begins.
struct Roles {
  std::set<std::uint32_t> signs;         ///< `-` and `+` that are signs of the value after them
  std::set<std::uint32_t> called;        ///< names before their `(`
  std::set<std::uint32_t> divisors;      ///< names after a `/` that is part of a number's suffix
  std::set<std::uint32_t> setting_keys;  ///< names that begin a setting
  std::set<std::string> units;           ///< declared in this file or known to every file
};

Roles roles_of(const SyntaxTree& tree);

/// Whether `pieces[index]` is a sign rather than an operator between two values.
bool is_sign(const std::vector<Piece>& pieces, std::size_t index, const Roles& roles);

/// Whether a space comes before `pieces[index]` on the line of `pieces[index - 1]`. `parentheses` is the number of open
/// ones.
bool spaced(const std::vector<Piece>& pieces, std::size_t index, std::size_t parentheses, const Roles& roles);

}  // namespace wale::formatting
