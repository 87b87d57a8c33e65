#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/graph/term.hpp"

namespace wale {

/// How often an unknown occurs in each term up to `last`.
class Occurrences {
 public:
  Occurrences(const Terms& terms, TermId last, TermId unknown);

  /// 0, 1, or 2 for two or more.
  int operator[](TermId id) const { return id < unknown_ ? 0 : counts_[id - unknown_]; }

 private:
  TermId unknown_;
  std::vector<std::uint8_t> counts_;
};

/// Solves the equation `left = right` for the unknown. Empty if the unknown occurs in several places, or if an
/// operation has no known inverse. `worth(id)` gives the value of a term without the unknown (a number, or a term of
/// another set), and `apply(operation, a, b)` the result of an operation on such values; operations with one operand
/// ignore `b`.
template <typename WorthOf, typename Apply>
auto isolated(const Terms& terms, TermId left, TermId right, const Occurrences& counts, WorthOf worth, Apply apply)
    -> std::optional<decltype(worth(left))> {
  if (counts[left] + counts[right] != 1) return std::nullopt;
  TermId side = counts[left] == 1 ? left : right;
  auto other = worth(side == left ? right : left);
  while (terms[side].kind == TermKind::operation) {
    const Term term = terms[side];  // a copy: `apply` may add terms
    const bool in_a = counts[term.a] == 1;
    const auto known = [&] { return worth(in_a ? term.b : term.a); };
    switch (term.operation) {
      case Operation::add: other = apply(Operation::subtract, other, known()); break;
      case Operation::subtract:
        other = in_a ? apply(Operation::add, other, known()) : apply(Operation::subtract, known(), other);
        break;
      case Operation::multiply: other = apply(Operation::divide, other, known()); break;
      case Operation::divide:
        other = in_a ? apply(Operation::multiply, other, known()) : apply(Operation::divide, known(), other);
        break;
      case Operation::negate: other = apply(Operation::negate, other, other); break;
      case Operation::exp2: other = apply(Operation::log2, other, other); break;
      case Operation::log2: other = apply(Operation::exp2, other, other); break;
      case Operation::square_root: other = apply(Operation::multiply, other, other); break;
      default: return std::nullopt;
    }
    side = in_a ? term.a : term.b;
  }
  return other;
}

/// The same for an `unknown` among `terms`; new terms are added there.
std::optional<TermId> isolate(Terms& terms, TermId left, TermId right, TermId unknown);

}  // namespace wale
