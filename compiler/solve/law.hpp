#pragma once

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

/// Copies an expression from one set of terms to another, some of its terms replaced.
class TermCopier {
 public:
  TermCopier(const Terms& from, Terms& to)
      : from_(from), to_(to), copies_(from.size(), none), needed_(from.size(), false) {}

  void replace(TermId from, TermId to) { copies_[from] = to; }

  TermId operator()(TermId root) {
    // Operands stand before their users, so one pass over what the root needs copies everything in order.
    if (copies_[root] != none) return copies_[root];
    TermId first = root;      // of what is needed and not there yet
    std::size_t waiting = 1;  // of them: not looked at yet
    needed_[root] = true;
    for (TermId id = root; waiting > 0; --id) {
      if (!needed_[id]) continue;
      first = id;
      --waiting;
      for (const TermId operand : operands(from_[id]))
        if (copies_[operand] == none && !std::exchange(needed_[operand], true)) ++waiting;
    }
    for (TermId id = first; id <= root; ++id) {
      if (!needed_[id]) continue;
      needed_[id] = false;
      Term term = from_[id];
      const auto count = operands(term).size();
      if (count > 0) term.a = copies_[term.a];
      if (count > 1) term.b = copies_[term.b];
      if (count > 2) term.c = copies_[term.c];
      copies_[id] = to_.add(term);
    }
    return copies_[root];
  }

 private:
  static constexpr TermId none = ~TermId{0};

  const Terms& from_;
  Terms& to_;
  std::vector<TermId> copies_;  ///< by the term copied; `none` where there is none yet
  std::vector<char> needed_;    ///< by term, as bool; all false between calls
};

/// A map's law as expressions: the magnitude of a carrier, the level of a carrier, the carrier of a level.
class Law {
 public:
  Law(const Map& map, const Percept& percept) : map_(map), percept_(percept) {}

  std::optional<TermId> magnitude(Terms& terms, TermId carrier) const {
    const TermId unknown = terms.add({.kind = TermKind::magnitude});
    const auto [left, right] = copy(terms, unknown, carrier);
    return isolate(terms, left, right, unknown);
  }

  std::optional<TermId> level(Terms& terms, TermId carrier) const {
    const auto asked = magnitude(terms, carrier), one = magnitude(terms, terms.literal(percept_.one));
    if (!asked || !one) return std::nullopt;
    return terms.apply(Operation::divide, *asked, *one);
  }

  std::optional<TermId> carrier(Terms& terms, TermId level) const {
    const auto one = magnitude(terms, terms.literal(percept_.one));
    if (!one) return std::nullopt;
    const TermId unknown = terms.add({.kind = TermKind::carrier});
    const auto [left, right] = copy(terms, terms.apply(Operation::multiply, level, *one), unknown);
    return isolate(terms, left, right, unknown);
  }

  /// The same as numbers.
  double level_of(double carrier) const {
    return number([&](Terms& terms) { return level(terms, terms.literal(carrier)); });
  }
  double magnitude_of(double carrier) const {
    return number([&](Terms& terms) { return magnitude(terms, terms.literal(carrier)); });
  }
  double carrier_of(double level) const {
    return number([&](Terms& terms) { return this->carrier(terms, terms.literal(level)); });
  }

 private:
  std::pair<TermId, TermId> copy(Terms& terms, TermId magnitude, TermId carrier) const {
    TermCopier copier(map_.terms, terms);
    for (TermId id = 0; id < map_.terms.size(); ++id) {
      if (map_.terms[id].kind == TermKind::magnitude) copier.replace(id, magnitude);
      if (map_.terms[id].kind == TermKind::carrier) copier.replace(id, carrier);
    }
    const TermId left = copier(map_.left);
    return {left, copier(map_.right)};
  }

  template <typename Build>
  static double number(Build build) {
    Terms terms;
    const auto term = build(terms);
    return term ? constant_value(terms, *term).value_or(std::nan("")) : std::nan("");
  }

  const Map& map_;
  const Percept& percept_;
};

}  // namespace wale
