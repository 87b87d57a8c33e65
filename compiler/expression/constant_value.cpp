#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <unordered_map>
#include <vector>

#include "compiler/expression/check_expression.hpp"
#include "runtime/machine/arithmetic.hpp"

namespace wale {

namespace {

double evaluate(Operation operation, double a, double b, double c) {
  switch (operation) {
    case Operation::add: return a + b;
    case Operation::subtract: return a - b;
    case Operation::multiply: return a * b;
    case Operation::divide: return a / b;
    case Operation::negate: return -a;
    case Operation::absolute: return std::abs(a);
    case Operation::minimum: return b < a ? b : a;
    case Operation::maximum: return a < b ? b : a;
    case Operation::floor: return std::floor(a);
    case Operation::square_root: return std::sqrt(a);
    case Operation::less: return a < b ? 1 : 0;
    case Operation::select: return a != 0 ? b : c;
    case Operation::sine: return std::sin(a);
    case Operation::cosine: return std::cos(a);
    case Operation::exp2: return std::exp2(a);
    case Operation::log2: return std::log2(a);
    case Operation::normal: return 0.5 * std::erfc(-a * M_SQRT1_2);
    case Operation::limit: return std::isnan(a) || !(b >= 0) ? 0 : std::min(std::max(a, -b), b);
    case Operation::arctangent: return std::atan2(a, b);
    case Operation::hash: return hash_of(static_cast<float>(a), static_cast<float>(b), static_cast<float>(c));
    case Operation::sample:
    case Operation::peak:
    case Operation::recall:
    case Operation::cell: break;
  }
  return std::nan("");
}

}  // namespace

std::optional<double> constant_value(const Terms& terms, TermId id, const std::vector<Parameter>* parameters) {
  Dependence dependence = terms.dependence(id);
  if (parameters) dependence = dependence.without(Dependence::parameter);
  if (!dependence.constant()) return std::nullopt;
  if (terms[id].kind == TermKind::literal) return terms[id].value;
  // A term may be used many times over: each is evaluated once, operands first, without recursion. Most constants are
  // worked out of a few, for which there is room here.
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
    if (term.kind == TermKind::literal) {
      known[current] = term.value;
      continue;
    }
    if (term.kind == TermKind::parameter && parameters && term.index < parameters->size()) {
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
    known[current] = evaluate(term.operation, value(0), value(1), value(2));
  }
  return known[id];
}

}  // namespace wale
