#pragma once

#include <array>
#include <map>
#include <string>

#include "compiler/parse/syntax_tree.hpp"

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

/// Where the hand is and how it moves: m, m/s and m/s^2; and when, in s.
struct HandState {
  double x = 0, y = 0, vx = 0, vy = 0, ax = 0, ay = 0;
  double time = 0, seconds_per_tick = 1.0 / 900;
  bool button = false;
};

/// What cannot be said at this hand: a comparison, a floor or a root closer to its edge than the error bound. The two
/// arithmetics may rightly differ there.
struct Undecided {};

/// The file's only material as it runs, tick by tick. Throws what `force` throws.
class Simulation {
 public:
  /// The tree outlives it.
  explicit Simulation(const SyntaxTree& tree, std::map<std::string, double> parameters = {});
  void enter(const HandState& hand);
  /// The force, by the states as they are; then the states go on.
  Quantity tick(const HandState& hand);
  const std::map<std::string, Quantity>& states() const { return states_; }

 private:
  Quantity tick(const HandState& hand, bool entering);

  const SyntaxTree& tree_;
  std::map<std::string, double> parameters_;
  std::map<std::string, Quantity> states_;
};

/// The force of the file's only material at a hand, its parameters at `parameters` or else at their defaults. Throws
/// std::runtime_error for dimensions that do not fit or for what the evaluator does not know.
Quantity force(const SyntaxTree& tree, const HandState& hand, const std::map<std::string, double>& parameters);

}  // namespace wale::reference
