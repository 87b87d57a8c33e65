#include <algorithm>

#include "compiler/solve.hpp"

namespace wale {

namespace {

/// How often the unknown stands in each term up to `last`: 0, 1, or 2 for more. One pass, since operands stand before
/// what uses them.
std::vector<int> occurrences(const Terms& terms, TermId last, TermId unknown) {
  std::vector<int> counts(last + 1, 0);
  for (TermId id = 0; id <= last; ++id) {
    const Term& term = terms[id];
    if (id == unknown) {
      counts[id] = 1;
    } else if (term.kind == TermKind::operation) {
      const TermId operands[] = {term.a, term.b, term.c};
      for (int i = 0; i < operand_count(term.operation); ++i)
        counts[id] = std::min(2, counts[id] + counts[operands[i]]);
    }
  }
  return counts;
}

}  // namespace

std::optional<TermId> isolate(Terms& terms, TermId left, TermId right, TermId unknown) {
  const auto counts = occurrences(terms, std::max(left, right), unknown);
  if (counts[left] + counts[right] != 1) return std::nullopt;
  TermId side = counts[left] == 1 ? left : right;
  TermId other = side == left ? right : left;
  while (side != unknown) {
    const Term term = terms[side];
    const bool in_a = counts[term.a] == 1;
    switch (term.operation) {
      case Operation::add: other = terms.apply(Operation::subtract, other, in_a ? term.b : term.a); break;
      case Operation::subtract:
        other = in_a ? terms.apply(Operation::add, other, term.b) : terms.apply(Operation::subtract, term.a, other);
        break;
      case Operation::multiply: other = terms.apply(Operation::divide, other, in_a ? term.b : term.a); break;
      case Operation::divide:
        other = in_a ? terms.apply(Operation::multiply, other, term.b) : terms.apply(Operation::divide, term.a, other);
        break;
      case Operation::negate: other = terms.apply(Operation::negate, other); break;
      case Operation::exp2: other = terms.apply(Operation::log2, other); break;
      case Operation::log2: other = terms.apply(Operation::exp2, other); break;
      case Operation::square_root: other = terms.apply(Operation::multiply, other, other); break;
      default: return std::nullopt;
    }
    side = in_a ? term.a : term.b;
  }
  return other;
}

}  // namespace wale
