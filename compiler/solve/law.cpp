#include "compiler/solve/law.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/copy_terms.hpp"

namespace wale {

namespace {

/// For each term, the first term that is the same operation on the same operands, recursively.
std::vector<TermId> first_of_same(const Terms& terms) {
  using Shape = std::tuple<TermKind, Operation, std::uint32_t, std::uint64_t, TermId, TermId, TermId>;
  std::map<Shape, TermId> known;
  std::vector<TermId> first(terms.size());
  for (TermId id = 0; id < terms.size(); ++id) {
    const Term& term = terms[id];
    std::array<TermId, 3> of{};
    for (std::size_t i = 0; i < operands(term).size(); ++i) of[i] = first[operands(term)[i]];
    const auto value = term.kind == TermKind::literal ? std::bit_cast<std::uint64_t>(term.value) : 0;
    first[id] =
        known.emplace(Shape{term.kind, term.operation, term.index, value, of[0], of[1], of[2]}, id).first->second;
  }
  return first;
}

/// Whether each term contains the unknown.
std::vector<bool> speaking_of(const Terms& terms, TermId unknown) {
  std::vector<bool> speaks(terms.size());
  for (TermId id = unknown; id < terms.size(); ++id) {
    speaks[id] = id == unknown;
    for (const TermId operand : operands(terms[id])) speaks[id] = speaks[id] || speaks[operand];
  }
  return speaks;
}

/// c0 + c1 u + c2 u^2, where u is the `atom`, a term that contains the unknown.
struct Polynomial {
  TermId atom = 0;
  std::array<std::optional<TermId>, 3> coefficients;  ///< missing ones are 0

  bool constant() const { return !coefficients[1] && !coefficients[2]; }
};

/// Reads an expression as a polynomial in one function of the unknown; empty if it is not such a polynomial.
class PolynomialReader {
 public:
  PolynomialReader(Terms& terms, TermId unknown)
      : terms_(terms), speaks_(speaking_of(terms, unknown)), first_(first_of_same(terms)) {}

  bool speaks_of_unknown(TermId id) const { return speaks_[id]; }

  /// Reads each term once, however many users it has.
  std::optional<Polynomial> read(TermId id) {
    if (const auto known = known_.find(id); known != known_.end()) return known->second;
    return known_[id] = read_new(id);
  }

 private:
  std::optional<Polynomial> read_new(TermId id) {
    if (!speaks_[id]) return Polynomial{0, {id, {}, {}}};
    const Term term = terms_[id];
    if (term.kind == TermKind::operation) {
      switch (term.operation) {
        case Operation::add:
        case Operation::subtract: return combined(term);
        case Operation::negate:
          return scaled(read(term.a), [&](TermId c) { return terms_.apply(Operation::negate, c); });
        case Operation::multiply: return product(term);
        case Operation::divide:
          if (!speaks_[term.b])
            return scaled(read(term.a), [&](TermId c) { return terms_.apply(Operation::divide, c, term.b); });
          break;
        default: break;
      }
    }
    return Polynomial{id, {std::nullopt, terms_.literal(1), std::nullopt}};
  }

  template <typename Scale>
  static std::optional<Polynomial> scaled(std::optional<Polynomial> polynomial, Scale scale) {
    if (polynomial)
      for (auto& coefficient : polynomial->coefficients)
        if (coefficient) coefficient = scale(*coefficient);
    return polynomial;
  }

  /// The common atom of both; empty if they have different ones.
  std::optional<TermId> common_atom(const Polynomial& a, const Polynomial& b) const {
    if (a.constant()) return b.atom;
    if (b.constant() || first_[a.atom] == first_[b.atom]) return a.atom;
    return std::nullopt;
  }

  std::optional<Polynomial> combined(const Term& term) {
    const auto a = read(term.a), b = read(term.b);
    const auto atom = a && b ? common_atom(*a, *b) : std::nullopt;
    if (!atom) return std::nullopt;
    Polynomial sum{*atom, a->coefficients};
    for (std::size_t i = 0; i < sum.coefficients.size(); ++i) {
      const auto& other = b->coefficients[i];
      if (!other) continue;
      if (sum.coefficients[i])
        sum.coefficients[i] = terms_.apply(term.operation, *sum.coefficients[i], *other);
      else
        sum.coefficients[i] = term.operation == Operation::add ? *other : terms_.apply(Operation::negate, *other);
    }
    return sum;
  }

  std::optional<Polynomial> product(const Term& term) {
    const auto a = read(term.a), b = read(term.b);
    const auto atom = a && b ? common_atom(*a, *b) : std::nullopt;
    if (!atom) return std::nullopt;
    Polynomial result{*atom, {}};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        if (!a->coefficients[i] || !b->coefficients[j]) continue;
        if (i + j > 2) return std::nullopt;
        const TermId part = terms_.apply(Operation::multiply, *a->coefficients[i], *b->coefficients[j]);
        auto& sum = result.coefficients[i + j];
        sum = sum ? terms_.apply(Operation::add, *sum, part) : part;
      }
    return result;
  }

  Terms& terms_;
  std::vector<bool> speaks_;   ///< of the unknown, for each of the terms that there were
  std::vector<TermId> first_;  ///< for each of them, the first that is the same
  std::map<TermId, std::optional<Polynomial>> known_;
};

/// Linear interpolation between knots, and extrapolation beyond the first and the last: the first line, plus a change
/// of slope at each inner knot.
TermId through_knots(Terms& terms, TermId at, const std::vector<std::array<double, 2>>& knots) {
  const auto slope = [&](std::size_t i) { return (knots[i + 1][1] - knots[i][1]) / (knots[i + 1][0] - knots[i][0]); };
  const auto from = [&](std::size_t i) { return terms.apply(Operation::subtract, at, terms.literal(knots[i][0])); };
  TermId value = terms.apply(Operation::add, terms.literal(knots[0][1]),
                             terms.apply(Operation::multiply, terms.literal(slope(0)), from(0)));
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    const TermId beyond = terms.apply(Operation::maximum, from(i), terms.literal(0));
    value = terms.apply(Operation::add, value,
                        terms.apply(Operation::multiply, terms.literal(slope(i) - slope(i - 1)), beyond));
  }
  return value;
}

/// An array of values, initially 0. It has room for the terms of nearly every law without an allocation.
template <typename T>
class Room {
 public:
  explicit Room(std::size_t size) {
    if (size > few_.size()) more_.resize(size);
  }
  T* data() { return more_.empty() ? few_.data() : more_.data(); }

 private:
  std::array<T, 48> few_{};
  std::vector<T> more_;
};

template <typename Build>
double number_of(Build build) {
  Terms terms;
  const std::optional<TermId> term = build(terms);
  return term ? constant_value(terms, *term).value_or(std::nan("")) : std::nan("");
}

Law::Sizes literals(Terms& terms, const std::vector<double>& values) {
  Law::Sizes sizes;
  for (const double value : values) sizes.push_back(terms.literal(value));
  return sizes;
}

/// Copies the map's law to other terms, with the given terms for its magnitude and carriers.
std::array<TermId, 2> copied(const Map& map, Terms& terms, TermId magnitude, TermId carrier,
                             const Law::Sizes& couples) {
  TermCopier copier(map.terms, terms);
  for (TermId id = 0; id < map.terms.size(); ++id) {
    const Term& term = map.terms[id];
    if (term.kind == TermKind::magnitude) copier.replace(id, magnitude);
    if (term.kind != TermKind::carrier) continue;
    if (term.index == 0)
      copier.replace(id, carrier);
    else
      copier.replace(id, term.index <= couples.size() ? couples[term.index - 1] : terms.literal(0));
  }
  const TermId left = copier(map.left);
  return {left, copier(map.right)};
}

/// The term of the magnitude or the carrier in a map's law.
TermId quantity(const Map& map, TermKind kind) {
  for (TermId id = 0; id < map.terms.size(); ++id)
    if (map.terms[id].kind == kind && map.terms[id].index == 0) return id;
  return 0;  // for a table, which has no terms
}

bool is_quantity(const Term& term) { return term.kind == TermKind::magnitude || term.kind == TermKind::carrier; }

}  // namespace

Law::Law(const Map& map, const Percept& percept)
    : map_(map),
      percept_(percept),
      of_magnitude_(map.terms, std::max(map.left, map.right), quantity(map, TermKind::magnitude)),
      of_carrier_(map.terms, std::max(map.left, map.right), quantity(map, TermKind::carrier)) {
  if (!map_.table.empty()) return;
  magnitude_stands_alone_ = stands_alone(of_magnitude_);
  carrier_stands_alone_ = stands_alone(of_carrier_);
  if (magnitude_stands_alone_) magnitude_of_one_ = magnitude_of(map_.one.value_or(percept_.one));
  if (carrier_stands_alone_) return;
  // Of the two roots of a quadratic, find the one that inverts the law.
  const Way way = map_.branch == Branch::rising    ? Way::rising
                  : map_.branch == Branch::falling ? Way::falling
                                                   : way_within_range();
  if (way == Way::both) return;
  for (const bool upper : {true, false}) {
    upper_root_ = upper;
    const double middle = carrier_of(level_of(std::sqrt(map_.valid_low * map_.valid_high)));
    const double slope = exponent_at(middle);
    if (!std::isnan(slope) && (slope > 0) == (way == Way::rising)) return;
  }
}

bool Law::stands_alone(const Occurrences& counts) const {
  const auto always = [](auto...) { return true; };
  return isolated(map_.terms, map_.left, map_.right, counts, always, always).has_value();
}

std::optional<TermId> Law::solved_for(const Occurrences& counts, Terms& terms, TermId given,
                                      const Sizes& couples) const {
  const TermId last = std::max(map_.left, map_.right);
  Room<TermId> room(last + 1);
  TermId* const copies = room.data();
  for (TermId id = 0; id <= last; ++id) {
    Term term = map_.terms[id];
    if (counts[id] > 0) continue;
    if (is_quantity(term)) {
      copies[id] = term.index == 0 ? given : term.index <= couples.size() ? couples[term.index - 1] : terms.literal(0);
      continue;
    }
    const auto count = operands(term).size();
    if (count > 0) term.a = copies[term.a];
    if (count > 1) term.b = copies[term.b];
    if (count > 2) term.c = copies[term.c];
    copies[id] = terms.add(term);
  }
  return isolated(
      map_.terms, map_.left, map_.right, counts, [&](TermId id) { return copies[id]; },
      [&](Operation operation, TermId a, TermId b) {
        return facts(operation).operands == 1 ? terms.apply(operation, a) : terms.apply(operation, a, b);
      });
}

double Law::solved_for(const Occurrences& counts, double given, const std::vector<double>& couples) const {
  const TermId last = std::max(map_.left, map_.right);
  Room<double> room(last + 1);
  double* const worth = room.data();
  for (TermId id = 0; id <= last; ++id) {
    const Term& term = map_.terms[id];
    if (term.known())
      worth[id] = term.value;
    else if (is_quantity(term))
      worth[id] = term.index == 0 ? given : term.index <= couples.size() ? couples[term.index - 1] : 0;
    else if (counts[id] == 0)
      worth[id] = term.kind == TermKind::operation
                      ? result_in_double(term.operation, worth[term.a], worth[term.b], worth[term.c])
                      : std::nan("");
  }
  return isolated(
             map_.terms, map_.left, map_.right, counts, [&](TermId id) { return worth[id]; },
             [](Operation operation, double a, double b) { return result_in_double(operation, a, b, 0); })
      .value_or(std::nan(""));
}

Law::Way Law::way_within_range() const {
  constexpr int samples = 32;
  bool rises = false, falls = false;
  double before = magnitude_of(map_.valid_low);
  for (int i = 1; i <= samples; ++i) {
    const double now = magnitude_of(map_.valid_low * std::pow(map_.valid_high / map_.valid_low, double(i) / samples));
    (now < before ? falls : rises) = true;
    before = now;
  }
  return rises && falls ? Way::both : falls ? Way::falling : Way::rising;
}

std::optional<TermId> Law::looked_up(Terms& terms, TermId value, bool inverse) const {
  std::vector<std::array<double, 2>> knots;
  for (const auto& [size, magnitude] : map_.table)
    knots.push_back({std::log2(inverse ? magnitude : size), std::log2(inverse ? size : magnitude)});
  if (inverse && knots.front()[0] > knots.back()[0]) std::ranges::reverse(knots);
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (!(knots[i][0] > knots[i - 1][0])) return std::nullopt;  // the law is not monotonic
  return terms.apply(Operation::exp2, through_knots(terms, terms.apply(Operation::log2, value), knots));
}

std::optional<TermId> Law::solved_quadratic(Terms& terms, TermId left, TermId right, TermId unknown) const {
  if (map_.branch == Branch::only && way_within_range() == Way::both) return std::nullopt;
  PolynomialReader reader(terms, unknown);
  if (reader.speaks_of_unknown(left)) std::swap(left, right);
  if (reader.speaks_of_unknown(left)) return std::nullopt;
  const auto polynomial = reader.read(right);
  if (!polynomial || polynomial->constant()) return std::nullopt;
  const auto& [c0, c1, c2] = polynomial->coefficients;
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms.apply(operation, a, b); };
  const TermId rest = c0 ? apply(Operation::subtract, left, *c0) : left;
  TermId atom = 0;
  if (!c2) {
    atom = apply(Operation::divide, rest, *c1);
  } else {
    // c2 u^2 + c1 u - rest = 0. Beyond the vertex there is no real root, and the vertex is the nearest value.
    const TermId linear = c1 ? *c1 : terms.literal(0);
    const TermId four = apply(Operation::multiply, terms.literal(4), apply(Operation::multiply, *c2, rest));
    const TermId square = apply(Operation::add, apply(Operation::multiply, linear, linear), four);
    const TermId root = terms.apply(Operation::square_root, apply(Operation::maximum, square, terms.literal(0)));
    const TermId above = apply(upper_root_ ? Operation::subtract : Operation::add, root, linear);
    const TermId top = upper_root_ ? above : terms.apply(Operation::negate, above);
    atom = apply(Operation::divide, top, apply(Operation::multiply, terms.literal(2), *c2));
  }
  return isolate(terms, polynomial->atom, atom, unknown);
}

std::optional<TermId> Law::magnitude(Terms& terms, TermId carrier, const Sizes& couples) const {
  if (!map_.table.empty()) return looked_up(terms, carrier, false);
  if (!magnitude_stands_alone_) return std::nullopt;
  return solved_for(of_magnitude_, terms, carrier, couples);
}

std::optional<TermId> Law::level(Terms& terms, TermId carrier, const Sizes& couples) const {
  const auto asked = magnitude(terms, carrier, couples);
  return asked ? level_of_magnitude(terms, *asked) : std::nullopt;
}

std::optional<TermId> Law::level_of_magnitude(Terms& terms, TermId asked) const {
  const auto one = magnitude(terms, terms.literal(map_.one.value_or(percept_.one)));
  if (!one) return std::nullopt;
  return terms.apply(Operation::divide, asked, *one);
}

std::optional<TermId> Law::carrier(Terms& terms, TermId level, const Sizes& couples) const {
  const auto one = magnitude(terms, terms.literal(map_.one.value_or(percept_.one)));
  if (!one) return std::nullopt;
  const TermId magnitude = terms.apply(Operation::multiply, level, *one);
  if (!map_.table.empty()) return looked_up(terms, magnitude, true);
  if (carrier_stands_alone_) return solved_for(of_carrier_, terms, magnitude, couples);
  const TermId unknown = terms.add({.kind = TermKind::carrier});
  const auto [left, right] = copied(map_, terms, magnitude, unknown, couples);
  return solved_quadratic(terms, left, right, unknown);
}

bool Law::has_inverse() const {
  if (magnitude_stands_alone_ && carrier_stands_alone_) return true;
  Terms terms;
  return carrier(terms, terms.literal(0.5)).has_value();
}

double Law::level_of(double carrier, const std::vector<double>& couples) const {
  if (magnitude_stands_alone_) return magnitude_of(carrier, couples) / magnitude_of_one_;
  return number_of([&](Terms& terms) { return level(terms, terms.literal(carrier), literals(terms, couples)); });
}

double Law::magnitude_of(double carrier, const std::vector<double>& couples) const {
  if (magnitude_stands_alone_) return solved_for(of_magnitude_, carrier, couples);
  return number_of([&](Terms& terms) { return magnitude(terms, terms.literal(carrier), literals(terms, couples)); });
}

double Law::carrier_of(double level, const std::vector<double>& couples) const {
  if (magnitude_stands_alone_ && carrier_stands_alone_)
    return solved_for(of_carrier_, level * magnitude_of_one_, couples);
  return number_of([&](Terms& terms) { return this->carrier(terms, terms.literal(level), literals(terms, couples)); });
}

double Law::exponent_at(double carrier) const {
  constexpr double step = 1e-4;
  return std::log(magnitude_of(carrier * (1 + step)) / magnitude_of(carrier / (1 + step))) / (2 * std::log1p(step));
}

bool Law::reaches(double level, const std::vector<double>& couples) const {
  const double size = carrier_of(level, couples);
  return std::isfinite(size) && size >= 0 && std::abs(level_of(size, couples) - level) <= 1e-6 * std::max(1.0, level);
}

}  // namespace wale
