#pragma once

#include <array>
#include <map>
#include <string>

#include "compiler/parse/syntax_tree.hpp"

/// A simple evaluator that follows the language reference: a slow walk over the tree in double precision. It shares
/// only the parser with the compiler, and only tests use it.
namespace wale::reference {

/// A quantity in SI units, with a bound on the error of the machine's 32-bit arithmetic.
struct Quantity {
  enum class Type { number, vector, condition };
  Type type = Type::number;
  std::array<double, 2> value{};      ///< a number and a condition use the first
  std::array<double, 2> error{};      ///< absolute
  std::array<double, 3> dimension{};  ///< exponents of m, kg and s
};

/// The position and motion of the hand, in m, m/s and m/s^2, and the time in s.
struct HandState {
  double x = 0, y = 0, vx = 0, vy = 0, ax = 0, ay = 0;
  double time = 0, seconds_per_tick = 1.0 / 900;
  bool button = false;
};

/// Thrown if a comparison, a floor or a root at this hand is closer to its edge than the error bound. There the two
/// arithmetics may differ without a fault.
struct Undecided {};

/// Runs the file's only material tick by tick. Throws the same as `force`.
class Simulation {
 public:
  /// The tree must outlive the object.
  explicit Simulation(const SyntaxTree& tree, std::map<std::string, double> parameters = {});
  void enter(const HandState& hand);
  /// Returns the force with the current states, then advances the states.
  Quantity tick(const HandState& hand);
  const std::map<std::string, Quantity>& states() const { return states_; }

 private:
  Quantity tick(const HandState& hand, bool entering);

  const SyntaxTree& tree_;
  std::map<std::string, double> parameters_;
  std::map<std::string, Quantity> states_;
};

/// The force of the file's only material at a hand. Parameters not in `parameters` have their defaults. Throws
/// std::runtime_error for dimensions that do not fit, and for constructs that the evaluator does not know.
Quantity force(const SyntaxTree& tree, const HandState& hand, const std::map<std::string, double>& parameters);

}  // namespace wale::reference
