#include "compiler/prove/relations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/prove/rounding.hpp"
#include "runtime/machine/arithmetic.hpp"

namespace wale {
namespace {

/// The relative error of a ratio or a length from a few roundings in float, and the absolute error from flushed
/// squares.
constexpr double roundings = 0x1p-20;
constexpr double flushed_squares = 1e-17;
constexpr float one = 1 + 0x1p-20f;
/// The largest value of the smooth step of fifth power: terms of up to 15 cancel in its polynomial, so some of their
/// last places remain.
constexpr float one_of_cancelling = 1 + 0x1p-18f;
/// Above this length a component whose square is flushed, 1.1e-19 at most, does not count. Below it both components of
/// a unit vector may be 1.
constexpr float exact_above = 1e-15f;
/// How far back vectors are followed, and how many pairs of values are examined.
constexpr int deepest = 16, most_pairs = 64;

}  // namespace

Relations::Relations(const PatchProgram& program, std::span<const Instruction> setup, std::span<const Instruction> tick)
    : registers_(static_cast<ValueNumber>(program.register_count())), last_(program.register_count()) {
  for (ValueNumber number = 0; number < registers_; ++number) last_[number] = number;
  operands_.reserve(setup.size() + tick.size());
  for (std::size_t i = 0; i < setup.size() + tick.size(); ++i) {
    const Instruction& instruction = i < setup.size() ? setup[i] : tick[i - setup.size()];
    const auto operation = static_cast<Operation>(instruction.operation);
    const OperationFacts& known = facts(operation);
    // Operands that are not registers have no value.
    const auto value = [&](int operand, RegisterNumber number) {
      return operand < known.operands ? last_[number] : ValueNumber{0};
    };
    operands_.push_back({operation, {value(0, instruction.a), value(1, instruction.b), value(2, instruction.c)}});
    for (int result = 0; result < known.results; ++result) {
      last_[instruction.destination + result] = static_cast<ValueNumber>(registers_ + 3 * i + result);
    }
  }
}

const Relations::Definition* Relations::definition(ValueNumber value) const {
  return value < registers_ ? nullptr : &operands_[(value - registers_) / 3];
}

const Relations::Definition* Relations::made_by(ValueNumber value, Operation operation) const {
  const Definition* made = definition(value);
  return made != nullptr && made->operation == operation ? made : nullptr;
}

/// Whether a value is a sum of squares only; adds the squared values.
bool Relations::is_square_sum(ValueNumber sum, std::vector<ValueNumber>& components, int depth) const {
  if (depth > deepest) return false;
  if (const Definition* square = made_by(sum, Operation::multiply)) {
    if (square->operands[0] != square->operands[1]) return false;
    components.push_back(square->operands[0]);
    return true;
  }
  const Definition* both = made_by(sum, Operation::add);
  return both != nullptr && is_square_sum(both->operands[0], components, depth + 1) &&
         is_square_sum(both->operands[1], components, depth + 1);
}

std::vector<ValueNumber> Relations::components(ValueNumber length) const {
  std::vector<ValueNumber> found;
  const Definition* root = made_by(length, Operation::square_root);
  if (root == nullptr || !is_square_sum(root->operands[0], found, 0)) return {};
  return found;
}

bool Relations::is_length_of(ValueNumber length, ValueNumber component) const {
  const std::vector<ValueNumber> all = components(length);
  return std::find(all.begin(), all.end(), component) != all.end();
}

/// The quotient if its divisor is at least `least`, which is above 0.
Interval Relations::quotient_above(const Definition& quotient, float least, const KnownRanges& known) const {
  const auto [x, r, unused] = quotient.operands;
  const Interval& divisor = known(r);
  if (divisor.high < least) return known(x);  // the choice is never taken, so any range holds
  const Interval above{std::max(divisor.low, least), divisor.high, false};
  const Interval range = range_of(Operation::divide, known(x), above, {});
  return is_length_of(r, x) ? intersection(range, {-one, one, true}) : range;
}

/// x - p floor(x / p), which is in [0, p] apart from the rounding of the quotient and the product: each is at most a
/// unit in the last place of x.
std::optional<Interval> Relations::remainder(const Definition& difference, const KnownRanges& known) const {
  const ValueNumber x = difference.operands[0];
  const Definition* product = made_by(difference.operands[1], Operation::multiply);
  if (product == nullptr) return {};
  for (const std::size_t i : {0u, 1u}) {
    const ValueNumber period = product->operands[1 - i];
    const Definition* whole = made_by(product->operands[i], Operation::floor);
    const Definition* quotient = whole != nullptr ? made_by(whole->operands[0], Operation::divide) : nullptr;
    if (quotient == nullptr || quotient->operands[0] != x || quotient->operands[1] != period) continue;
    // If the quotient or the product overflows, there is no remainder.
    if (!(known(period).low > 0) || !known(x).is_finite() || !known(whole->operands[0]).is_finite() ||
        !known(difference.operands[1]).is_finite()) {
      continue;
    }
    // A quotient that is flushed to zero has a floor of 0, also if it is negative.
    const double error = known(x).largest() * roundings + flushed_squares +
                         static_cast<double>(known(period).high) * arithmetic::least_normal * (1 + roundings);
    return outward(-error, known(period).high * (1 + roundings) + error, true);
  }
  return {};
}

/// t^3 (t (6 t - 15) + 10).
bool Relations::is_smoother_step(const Definition& product, const KnownRanges& known) const {
  const auto is = [&](ValueNumber value, float number) { return known(value) == Interval::of(number); };
  for (const std::size_t i : {0u, 1u}) {
    const Definition* cube = made_by(product.operands[i], Operation::multiply);
    const Definition* sum = made_by(product.operands[1 - i], Operation::add);
    if (cube == nullptr || sum == nullptr) continue;
    for (const std::size_t j : {0u, 1u}) {
      const ValueNumber t = cube->operands[j];
      const Definition* square = made_by(cube->operands[1 - j], Operation::multiply);
      if (square == nullptr || square->operands[0] != t || square->operands[1] != t) continue;
      if (!(known(t).low >= 0 && known(t).high <= 1)) continue;
      const std::size_t ten = is(sum->operands[1], 10) ? 1 : 0;
      const auto rest = times(sum->operands[1 - ten], t);
      const Definition* less = rest && is(sum->operands[ten], 10) ? made_by(*rest, Operation::subtract) : nullptr;
      const auto six = less != nullptr && is(less->operands[1], 15) ? times(less->operands[0], t) : std::nullopt;
      if (six && is(*six, 6)) return true;
    }
  }
  return false;
}

/// The other factor of `product` if `factor` is one of its two.
std::optional<ValueNumber> Relations::times(ValueNumber product, ValueNumber factor) const {
  const Definition* made = made_by(product, Operation::multiply);
  if (made == nullptr) return {};
  if (made->operands[0] == factor) return made->operands[1];
  if (made->operands[1] == factor) return made->operands[0];
  return {};
}

/// a + t (b - a) is between a and b for t in [0, 1]; outside it is off by as much as t is.
std::optional<Interval> Relations::mixture(const Definition& sum, const KnownRanges& known) const {
  for (const std::size_t i : {0u, 1u}) {
    const ValueNumber from = sum.operands[i];
    const Definition* product = made_by(sum.operands[1 - i], Operation::multiply);
    if (product == nullptr) continue;
    for (const std::size_t j : {0u, 1u}) {
      const Definition* way = made_by(product->operands[j], Operation::subtract);
      if (way == nullptr || way->operands[1] != from) continue;
      const Interval &a = known(from), &b = known(way->operands[0]), &t = known(product->operands[1 - j]),
                     &whole = known(product->operands[j]);
      if (!a.is_finite() || !b.is_finite() || !t.is_finite() || !whole.is_finite()) continue;
      const double beyond = std::max({0.0, static_cast<double>(t.high) - 1, -static_cast<double>(t.low)});
      const double length = whole.largest();
      const double more =
          beyond * length + flushed_squares +
          roundings * (static_cast<double>(a.largest()) + length * (1 + static_cast<double>(t.largest())));
      return outward(std::min(a.low, b.low) - more, std::max(a.high, b.high) + more, true);
    }
  }
  return {};
}

/// u1 v1 + u2 v2 is at most the product of the two lengths, of which one is 1.
std::optional<Interval> Relations::scalar_product(const Definition& sum, const KnownRanges& known) const {
  const Definition* first = made_by(sum.operands[0], Operation::multiply);
  const Definition* second = made_by(sum.operands[1], Operation::multiply);
  if (first == nullptr || second == nullptr) return {};
  const auto direction = [&](ValueNumber u, ValueNumber v) {
    const Definition* made = definition(u);
    if (made == nullptr || definition(v) == nullptr) return false;
    switch (made->operation) {
      case Operation::sine:
      case Operation::cosine: return is_turn(*made, *definition(v), known);
      case Operation::divide:
      case Operation::select: return made->operation == definition(v)->operation;
      default: return false;
    }
  };
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : {0u, 1u}) {
    for (const std::size_t j : {0u, 1u}) {
      const ValueNumber u1 = first->operands[i], u2 = second->operands[j];
      if (!direction(u1, u2)) continue;
      const ValueNumber v1 = first->operands[1 - i], v2 = second->operands[1 - j];
      least = std::min(least, length(u1, u2, known) * length(v1, v2, known));
    }
  }
  if (!(least < std::numeric_limits<float>::max())) return {};
  const double most = least * (1 + roundings) + flushed_squares;
  return outward(-most, most, true);
}

/// The sine and the cosine of one angle that is small enough for their error bounds.
bool Relations::is_turn(const Definition& a, const Definition& b, const KnownRanges& known) const {
  constexpr float largest_angle = 1e4f;
  return a.operands[0] == b.operands[0] && known(a.operands[0]).largest() <= largest_angle &&
         ((a.operation == Operation::sine && b.operation == Operation::cosine) ||
          (a.operation == Operation::cosine && b.operation == Operation::sine));
}

/// The largest g (C / g) with a finite quotient: C, apart from two roundings.
std::optional<double> Relations::cancelled(ValueNumber factor, ValueNumber quotient, const KnownRanges& known) const {
  const Definition* made = made_by(quotient, Operation::divide);
  if (made == nullptr || !known(quotient).is_finite() || !known(made->operands[0]).is_finite()) return {};
  const auto is_negative_of = [&](ValueNumber a, ValueNumber b) {
    const Definition* negative = made_by(a, Operation::negate);
    return negative != nullptr && negative->operands[0] == b;
  };
  const ValueNumber divisor = made->operands[1];
  if (factor != divisor && !is_negative_of(factor, divisor) && !is_negative_of(divisor, factor)) return {};
  return known(made->operands[0]).largest() * (1 + roundings);
}

bool Relations::is_smooth_step(const Definition& product, const KnownRanges& known) const {
  const auto is = [&](ValueNumber value, float number) { return known(value) == Interval::of(number); };
  for (const std::size_t i : {0u, 1u}) {
    const Definition* square = made_by(product.operands[i], Operation::multiply);
    const Definition* rest = made_by(product.operands[1 - i], Operation::subtract);
    if (square == nullptr || rest == nullptr || square->operands[0] != square->operands[1]) continue;
    const Definition* twice = made_by(rest->operands[1], Operation::multiply);
    if (twice == nullptr || !is(rest->operands[0], 3)) continue;
    const ValueNumber t = square->operands[0];
    const auto& [first, second, unused] = twice->operands;
    if (!(first == t && is(second, 2)) && !(second == t && is(first, 2))) continue;
    if (known(t).low >= 0 && known(t).high <= 1) return true;
  }
  return false;
}

/// w / sum or w / max(sum, least), where w is one of the terms of the sum and none of them is negative: a rounded sum
/// is not below any of its terms. A term that is not-a-number would let `least` stand for the sum.
bool Relations::is_share(const Definition& quotient, const KnownRanges& known) const {
  const ValueNumber weight = quotient.operands[0], divisor = quotient.operands[1];
  if (!(known(divisor).low > 0)) return false;
  const auto is_whole = [&](ValueNumber sum) {
    bool found = false;
    std::vector<ValueNumber> waiting{sum};
    for (int left = most_pairs; !waiting.empty(); --left) {
      if (left == 0) return false;
      const ValueNumber term = waiting.back();
      waiting.pop_back();
      const Definition* both = term == weight ? nullptr : made_by(term, Operation::add);
      if (both == nullptr) {
        if (!(known(term).low >= 0) || known(term).maybe_nan) return false;
        found = found || term == weight;
        continue;
      }
      waiting.push_back(both->operands[0]);
      waiting.push_back(both->operands[1]);
    }
    return found;
  };
  if (is_whole(divisor)) return true;
  const Definition* larger = made_by(divisor, Operation::maximum);
  return larger != nullptr && (is_whole(larger->operands[0]) || is_whole(larger->operands[1]));
}

std::optional<Interval> Relations::bound(std::size_t number, const KnownRanges& known) const {
  const Definition& made = operands_[number];
  switch (made.operation) {
    case Operation::divide:
      if (known(made.operands[1]).low > 0 && is_length_of(made.operands[1], made.operands[0])) {
        return Interval{-one, one, true};
      }
      if (is_share(made, known)) return Interval{0, one, true};
      return {};
    case Operation::subtract: {
      const Definition* whole = made_by(made.operands[1], Operation::floor);
      if (whole != nullptr && whole->operands[0] == made.operands[0]) return Interval{0, 1, true};
      return remainder(made, known);
    }
    case Operation::add:
      if (auto range = mixture(made, known)) return range;
      return scalar_product(made, known);
    case Operation::multiply:
      if (is_smooth_step(made, known)) return Interval{0, one, true};
      if (is_smoother_step(made, known)) return Interval{0, one_of_cancelling, true};
      for (const std::size_t i : {0u, 1u}) {
        const Definition* held = made_by(made.operands[1 - i], Operation::limit);
        const auto most = held != nullptr ? cancelled(made.operands[i], held->operands[1], known) : std::nullopt;
        if (most) return outward(-*most, *most, true);
      }
      return {};
    default: return {};
  }
}

std::optional<Relations::Guarded> Relations::guarded(std::size_t number, const KnownRanges& known) const {
  const Definition& choice = operands_[number];
  const Definition* comparison = made_by(choice.operands[0], Operation::less);
  if (comparison == nullptr) return {};
  const auto [first, second, unused] = comparison->operands;
  const auto divided_by = [&](int operand, ValueNumber divisor) {
    const Definition* quotient = made_by(choice.operands[static_cast<std::size_t>(operand)], Operation::divide);
    return quotient != nullptr && quotient->operands[1] == divisor ? quotient : nullptr;
  };
  // bound < divisor ? x / divisor : ..
  if (const Definition* quotient = divided_by(1, second); quotient != nullptr && known(first).low >= 0) {
    return Guarded{1, quotient_above(*quotient, std::max(known(first).low, arithmetic::least_normal), known)};
  }
  // divisor < bound ? .. : x / divisor: the divisor is at least the bound, or one of them is not a number
  if (const Definition* quotient = divided_by(2, first); quotient != nullptr &&
                                                         known(second).low >= arithmetic::least_normal &&
                                                         !known(second).maybe_nan && !known(first).maybe_nan) {
    return Guarded{2, quotient_above(*quotient, known(second).low, known)};
  }
  return {};
}

double length_bound(const Interval& x, const Interval& y) {
  const double a = x.largest(), b = y.largest();
  return std::sqrt(a * a + b * b) * (1 + 0x1p-50);  // two roundings of the sum and one of the root
}

double Relations::length(ValueNumber x, ValueNumber y, const KnownRanges& known) const {
  int left = most_pairs;
  return length(x, y, known, 0, left);
}

/// x = u s and y = v s with s = min(.., A / |(u, v)|), so the vector is no longer than A. If u or v is not a number,
/// `ceiling` must hold the other within A.
std::optional<Relations::Limited> Relations::limited(ValueNumber x, ValueNumber y, std::optional<ValueNumber> ceiling,
                                                     const KnownRanges& known) const {
  const Definition* first = made_by(x, Operation::multiply);
  const Definition* second = made_by(y, Operation::multiply);
  if (first == nullptr || second == nullptr) return {};
  for (const int i : {0, 1}) {
    for (const int j : {0, 1}) {
      const ValueNumber scale = first->operands[static_cast<std::size_t>(i)];
      if (second->operands[static_cast<std::size_t>(j)] != scale) continue;
      const ValueNumber u = first->operands[static_cast<std::size_t>(1 - i)];
      const ValueNumber v = second->operands[static_cast<std::size_t>(1 - j)];
      const Definition* least = made_by(scale, Operation::minimum);
      if (least == nullptr) continue;
      for (const int k : {0, 1}) {
        const Definition* ratio = made_by(least->operands[static_cast<std::size_t>(k)], Operation::divide);
        if (ratio == nullptr) continue;
        const ValueNumber most = ratio->operands[0];
        const std::vector<ValueNumber> all = components(ratio->operands[1]);
        if (std::find(all.begin(), all.end(), u) == all.end() || std::find(all.begin(), all.end(), v) == all.end()) {
          continue;
        }
        const Interval& other = known(least->operands[static_cast<std::size_t>(1 - k)]);
        const bool held = ceiling && *ceiling == most;
        const bool numbers = !known(u).maybe_nan && !known(v).maybe_nan && !known(most).maybe_nan &&
                             known(most).is_finite() && known(most).low >= 0;
        // If the length is zero, the scale is the other operand, and the squares were flushed.
        if (!other.is_finite() || other.low < 0 || other.maybe_nan || (u == v) || (!held && !numbers)) continue;
        return Limited{most, flushed_squares * (1 + static_cast<double>(other.high))};
      }
    }
  }
  return {};
}

double Relations::Limited::length(const KnownRanges& known) const {
  return std::max(0.0, static_cast<double>(known(most).high)) * (1 + roundings) + more;
}

/// g times a vector that is limited to C / g.
std::optional<double> Relations::scaled_back(ValueNumber factor, ValueNumber x, ValueNumber y,
                                             const KnownRanges& known) const {
  const Definition* first = made_by(x, Operation::limit);
  const Definition* second = made_by(y, Operation::limit);
  if (first == nullptr || second == nullptr || first->operands[1] != second->operands[1]) return {};
  const auto most = cancelled(factor, first->operands[1], known);
  const auto held = most ? limited(first->operands[0], second->operands[0], first->operands[1], known) : std::nullopt;
  if (!held || held->most != first->operands[1] || !known(factor).is_finite()) return {};
  return *most * (1 + roundings) + known(factor).largest() * held->more;
}

double Relations::length(ValueNumber x, ValueNumber y, const KnownRanges& known, int depth, int& left) const {
  const double alone = length_bound(known(x), known(y));
  const Definition* first = definition(x);
  const Definition* second = definition(y);
  if (first == nullptr || second == nullptr || depth > deepest || --left < 0) return alone;
  const auto less_of = [alone](double length) {
    const double rounded = length * (1 + roundings) + flushed_squares;
    return rounded < alone ? rounded : alone;  // not for not-a-number
  };
  const auto pair = [&](ValueNumber u, ValueNumber v) { return length(u, v, known, depth + 1, left); };
  // A unit vector if the divisor is not zero.
  const auto unit = [&](const Definition& u, const Definition& v) {
    return u.operation == Operation::divide && v.operation == Operation::divide && u.operands[1] == v.operands[1] &&
           u.operands[0] != v.operands[0] && is_length_of(u.operands[1], u.operands[0]) &&
           is_length_of(v.operands[1], v.operands[0]);
  };
  if (is_turn(*first, *second, known)) return less_of(1);
  if (first->operation != second->operation) return alone;
  const auto& a = first->operands;
  const auto& b = second->operands;
  switch (first->operation) {
    case Operation::limit: {
      // Limiting the components does not make a vector longer.
      double best = pair(a[0], b[0]);
      if (a[1] == b[1]) {
        if (const auto held = limited(a[0], b[0], a[1], known)) best = std::min(best, held->length(known));
      }
      return less_of(best);
    }
    case Operation::negate: return less_of(pair(a[0], b[0]));
    case Operation::add:
    case Operation::subtract:
      return less_of(std::min(pair(a[0], b[0]) + pair(a[1], b[1]), first->operation == Operation::add
                                                                       ? pair(a[0], b[1]) + pair(a[1], b[0])
                                                                       : std::numeric_limits<double>::infinity()));
    case Operation::multiply: {
      double best = alone;
      if (const auto held = limited(x, y, std::nullopt, known)) best = std::min(best, held->length(known));
      for (const std::size_t i : {0u, 1u}) {
        for (const std::size_t j : {0u, 1u}) {
          // Infinity times zero is not-a-number, which counts as zero; infinity times anything else has no bound.
          if (a[i] == b[j] && known(a[i]).is_finite()) {
            best = std::min(best, less_of(known(a[i]).largest() * pair(a[1 - i], b[1 - j])));
            if (const auto back = scaled_back(a[i], a[1 - i], b[1 - j], known)) best = std::min(best, *back);
          }
        }
      }
      return less_of(best);
    }
    case Operation::divide:
      if (unit(*first, *second) && known(a[1]).low >= exact_above) return less_of(1);
      if (a[1] == b[1] && (known(a[1]).low > 0 || known(a[1]).high < 0)) {
        const double least = std::min(std::abs(known(a[1]).low), std::abs(known(a[1]).high));
        return less_of(pair(a[0], b[0]) / least);
      }
      return alone;
    case Operation::select: {
      if (a[0] != b[0]) return alone;
      const Definition* comparison = made_by(a[0], Operation::less);
      const Definition* u = definition(a[1]);
      const Definition* v = definition(b[1]);
      // bound < length ? unit vector : ..
      const bool guarded = comparison != nullptr && u != nullptr && v != nullptr && unit(*u, *v) &&
                           comparison->operands[1] == u->operands[1] && known(comparison->operands[0]).low >= 0;
      const bool exact =
          guarded && std::max(known(u->operands[1]).low, known(comparison->operands[0]).low) >= exact_above;
      const double chosen = exact ? 1.0 : guarded ? std::sqrt(2.0) : pair(a[1], b[1]);
      return less_of(std::max(chosen, pair(a[2], b[2])));
    }
    default: return alone;
  }
}

}  // namespace wale
