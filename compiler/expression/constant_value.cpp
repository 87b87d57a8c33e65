#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <unordered_map>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

std::optional<double> constant_value(const Terms& terms, TermId id, const std::vector<Parameter>* parameters) {
  const Term& sought = terms[id];
  if (sought.known()) return sought.value;
  if (!parameters || !sought.dependence.without(Dependence::parameter).constant()) return std::nullopt;
  if (sought.kind == TermKind::parameter && sought.index < parameters->size()) return (*parameters)[sought.index].value;
  // A term may have many users. Each is evaluated once, operands first, without recursion. Most constants need only a
  // few terms, which fit into this buffer.
  std::array<std::byte, 4096> room;
  std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
  std::pmr::unordered_map<TermId, double> known(&memory);
  std::pmr::vector<TermId> waiting({id}, &memory);
  while (!waiting.empty()) {
    const TermId current = waiting.back();
    const Term& term = terms[current];
    if (known.contains(current)) {
      waiting.pop_back();
      continue;
    }
    if (term.known()) {
      known[current] = term.value;
      continue;
    }
    if (term.kind == TermKind::parameter && term.index < parameters->size()) {
      known[current] = (*parameters)[term.index].value;
      continue;
    }
    if (term.kind != TermKind::operation || term.operation == Operation::sample ||
        term.operation == Operation::recall || term.operation == Operation::cell)
      return std::nullopt;
    const TermOperands needed = operands(term);
    bool ready = true;
    for (const TermId operand : needed)
      if (!known.contains(operand)) waiting.push_back(operand), ready = false;
    if (!ready) continue;
    const auto value = [&](std::size_t i) { return i < needed.size() ? known[needed[i]] : 0.0; };
    known[current] = result_in_double(term.operation, value(0), value(1), value(2));
  }
  return known[id];
}

}  // namespace wale
