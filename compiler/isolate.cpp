#include "compiler/solve.hpp"

namespace wale {

namespace {

/// How often the unknown stands in an expression; laws are a dozen terms long.
int occurrences(const Terms& terms, TermId id, TermId unknown) {
  if (id == unknown) return 1;
  const Term& term = terms[id];
  if (term.kind != TermKind::operation) return 0;
  const TermId operands[] = {term.a, term.b, term.c};
  int count = 0;
  for (int i = 0; i < operand_count(term.operation); ++i) count += occurrences(terms, operands[i], unknown);
  return count;
}

}  // namespace

std::optional<TermId> isolate(Terms& terms, TermId left, TermId right, TermId unknown) {
  if (occurrences(terms, left, unknown) + occurrences(terms, right, unknown) != 1) return std::nullopt;
  TermId side = occurrences(terms, left, unknown) == 1 ? left : right;
  TermId other = side == left ? right : left;
  while (side != unknown) {
    const Term term = terms[side];
    const bool in_a = occurrences(terms, term.a, unknown) == 1;
    switch (term.operation) {
      case Operation::add:
        other = terms.apply(Operation::subtract, other, in_a ? term.b : term.a);
        break;
      case Operation::subtract:
        other = in_a ? terms.apply(Operation::add, other, term.b) : terms.apply(Operation::subtract, term.a, other);
        break;
      case Operation::multiply:
        other = terms.apply(Operation::divide, other, in_a ? term.b : term.a);
        break;
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
