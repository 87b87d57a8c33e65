#include "compiler/term.hpp"

#include <algorithm>

namespace wale {

int operand_count(Operation operation) { return static_cast<int>(std::ranges::count(facts(operation).fields, 'r')); }

namespace {

Dependence operator|(Dependence a, Dependence b) {
  return {a.parameter || b.parameter, a.position || b.position, a.velocity || b.velocity, a.open || b.open};
}

}  // namespace

TermId Terms::add(const Term& term) {
  Dependence dependence;
  switch (term.kind) {
    case TermKind::literal: break;
    case TermKind::input:
      dependence.position = term.input() == Input::x || term.input() == Input::y;
      dependence.velocity = term.input() == Input::velocity_x || term.input() == Input::velocity_y;
      dependence.parameter = !dependence.position && !dependence.velocity;
      break;
    case TermKind::parameter:
    case TermKind::magnitude:
    case TermKind::carrier: dependence.parameter = true; break;
    case TermKind::open: dependence.open = dependence.parameter = true; break;
    case TermKind::operation: {
      const int operands = operand_count(term.operation);
      if (operands > 0) dependence = dependences_[term.a];
      if (operands > 1) dependence = dependence | dependences_[term.b];
      if (operands > 2) dependence = dependence | dependences_[term.c];
      break;
    }
    case TermKind::component: dependence = dependences_[term.a]; break;
    case TermKind::gradient: dependence = dependences_[term.a]; break;
    case TermKind::peak:
      // The patch's extents are setup inputs: the peak may change with them even if nothing else does.
      dependence.parameter = true;
      dependence.open = dependences_[term.a].open;
      break;
  }
  terms_.push_back(term);
  dependences_.push_back(dependence);
  return static_cast<TermId>(terms_.size() - 1);
}

TermId Terms::literal(double value, Span span) {
  return add({.kind = TermKind::literal, .value = value, .span = span});
}

TermId Terms::input(Input input, Span span) {
  return add({.kind = TermKind::input, .index = static_cast<std::uint32_t>(input), .span = span});
}

TermId Terms::parameter(std::uint32_t index, Span span) {
  return add({.kind = TermKind::parameter, .index = index, .span = span});
}

TermId Terms::apply(Operation operation, TermId a, Span span) {
  return add({.kind = TermKind::operation, .operation = operation, .a = a, .span = span});
}

TermId Terms::apply(Operation operation, TermId a, TermId b, Span span) {
  return add({.kind = TermKind::operation, .operation = operation, .a = a, .b = b, .span = span});
}

TermId Terms::apply(Operation operation, TermId a, TermId b, TermId c, Span span) {
  return add({.kind = TermKind::operation, .operation = operation, .a = a, .b = b, .c = c, .span = span});
}

}  // namespace wale
