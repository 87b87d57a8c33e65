#include "compiler/solve/isolate.hpp"

namespace wale {

Occurrences::Occurrences(const Terms& terms, TermId last, TermId unknown)
    : unknown_(unknown), counts_(last >= unknown ? last - unknown + 1 : 1) {
  counts_[0] = 1;
  // One pass beginning at the unknown, since operands precede their users.
  for (TermId id = unknown + 1; id <= last; ++id) {
    if (terms[id].kind != TermKind::operation) continue;
    int count = 0;
    for (const TermId operand : operands(terms[id])) count += (*this)[operand];
    counts_[id - unknown] = static_cast<std::uint8_t>(std::min(2, count));
  }
}

std::optional<TermId> isolate(Terms& terms, TermId left, TermId right, TermId unknown) {
  const auto apply = [&](Operation operation, TermId a, TermId b) {
    return facts(operation).operands == 1 ? terms.apply(operation, a) : terms.apply(operation, a, b);
  };
  return isolated(
      terms, left, right, Occurrences(terms, std::max(left, right), unknown), [](TermId id) { return id; }, apply);
}

}  // namespace wale
