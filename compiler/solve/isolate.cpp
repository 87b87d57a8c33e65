#include "compiler/solve/isolate.hpp"

#include <algorithm>
#include <vector>

namespace wale {

namespace {

/// How often the unknown stands in each term up to `last`. One pass from the unknown on, since operands stand before
/// what uses them.
class Occurrences {
 public:
  Occurrences(const Terms& terms, TermId last, TermId unknown) : unknown_(unknown) {
    counts_.assign(last >= unknown ? last - unknown + 1 : 1, 0);
    counts_[0] = 1;
    for (TermId id = unknown + 1; id <= last; ++id)
      if (terms[id].kind == TermKind::operation)
        for (const TermId operand : operands(terms[id]))
          counts_[id - unknown] = std::min(2, counts_[id - unknown] + (*this)[operand]);
  }

  /// 0, 1, or 2 for more.
  int operator[](TermId id) const { return id < unknown_ ? 0 : counts_[id - unknown_]; }

 private:
  TermId unknown_;
  std::vector<int> counts_;
};

}  // namespace

std::optional<TermId> isolate(Terms& terms, TermId left, TermId right, TermId unknown) {
  const Occurrences counts(terms, std::max(left, right), unknown);
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
