#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/graph/term.hpp"

namespace wale {

/// How often an unknown stands in each term up to `last`.
class Occurrences {
 public:
  Occurrences(const Terms& terms, TermId last, TermId unknown);

  /// 0, 1, or 2 for more.
  int operator[](TermId id) const { return id < unknown_ ? 0 : counts_[id - unknown_]; }

 private:
  TermId unknown_;
  std::vector<std::uint8_t> counts_;
};

/// The equation `left = right` solved for the one place where the unknown stands, or nothing where its inverse is not
/// known or it stands in several places. `worth(id)` says what a term without the unknown comes to, a number or a term
/// elsewhere, and `apply(operation, a, b)` what an operation makes of two of those; one of a single operand ignores
/// `b`.
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

/// The same where `unknown` is a term of `terms`; new terms are added there.
std::optional<TermId> isolate(Terms& terms, TermId left, TermId right, TermId unknown);

}  // namespace wale
