#include "tests/reference/bounded_arithmetic.hpp"

#include <algorithm>
#include <cmath>

#include "tests/reference/evaluator.hpp"

namespace wale::reference {

Component rounded(double value, double error, double by) {
  // Beyond these a float is infinite or flushed to zero.
  if (!std::isfinite(value) || !std::isfinite(error) || std::abs(value) > 1e37) throw Undecided{};
  if (value != 0 && std::abs(value) < 1e-36) throw Undecided{};
  return {value, error + by * std::abs(value)};
}

Component add(Component a, Component b) { return rounded(a.value + b.value, a.error + b.error); }
Component negated(Component a) { return {-a.value, a.error}; }
Component multiply(Component a, Component b) {
  return rounded(a.value * b.value, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error);
}

Component divide(Component a, Component b) {
  const double least = std::abs(b.value) - b.error;
  if (least <= 0.1 * std::abs(b.value)) throw Undecided{};
  return rounded(a.value / b.value, (a.error + std::abs(a.value / b.value) * b.error) / least);
}

Component square_root(Component a) {
  if (a.value <= 2 * a.error) throw Undecided{};
  return rounded(std::sqrt(a.value), a.error / std::sqrt(a.value - a.error));
}

Component smooth(double value, Component argument, double slope) {
  return rounded(value, argument.error * slope + function_rounding, function_rounding);
}

Component exponential(Component a, double base) {
  const double log_base = std::log(base), value = std::pow(base, a.value);
  return rounded(
      value, value * std::expm1(std::abs(log_base) * a.error + function_rounding * (1 + std::abs(a.value * log_base))));
}

Component logarithm(Component a, double base) {
  if (a.value <= 2 * a.error) throw Undecided{};
  const double value = std::log(a.value) / std::log(base);
  return rounded(value, a.error / (a.value - a.error) / std::log(base) + function_rounding, 2 * function_rounding);
}

bool less(Component a, Component b) {
  if (std::abs(a.value - b.value) <= a.error + b.error) throw Undecided{};
  return a.value < b.value;
}

Component smaller(Component a, Component b) {
  if (a.value + a.error < b.value - b.error) return a;
  if (b.value + b.error < a.value - a.error) return b;
  return {std::min(a.value, b.value), std::max(a.error, b.error)};
}

Component larger(Component a, Component b) { return negated(smaller(negated(a), negated(b))); }
Component floor_of(Component a) {
  const double up = std::ceil(a.value) - a.value, down = a.value - std::floor(a.value);
  if (std::min(up, down) <= a.error && a.error > 0) throw Undecided{};
  return {std::floor(a.value), 0};
}

}  // namespace wale::reference
