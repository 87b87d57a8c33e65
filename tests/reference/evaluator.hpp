#pragma once

#include <array>
#include <map>
#include <string>

#include "compiler/syntax_tree.hpp"

/// The language read as plainly as its reference says it: a slow walk over the tree in double precision. Shares nothing
/// with the compiler but the parser, and is used by nothing but tests.
namespace wale::reference {

/// A quantity in SI units with a bound on how far the machine's 32-bit arithmetic may stray from it.
struct Quantity {
  enum class Type { number, vector, condition };
  Type type = Type::number;
  std::array<double, 2> value{};      ///< a number and a condition use the first
  std::array<double, 2> error{};      ///< absolute
  std::array<double, 3> dimension{};  ///< exponents of m, kg and s
};

/// Where the hand is and how it moves: m and m/s.
struct HandState {
  double x = 0, y = 0, vx = 0, vy = 0;
};

/// What cannot be said at this hand: a comparison, a floor or a root closer to its edge than the error bound. The two
/// arithmetics may rightly differ there.
struct Undecided {};

/// The force of the file's only material at a hand, its parameters at `parameters` or else at their defaults. Throws
/// std::runtime_error for dimensions that do not fit or for what the evaluator does not know.
Quantity force(const SyntaxTree& tree, const HandState& hand, const std::map<std::string, double>& parameters);

}  // namespace wale::reference
