#include "compiler/graph/term.hpp"

namespace wale {

Dependence Terms::dependence_of(const Term& term) const {
  switch (term.kind) {
    case TermKind::literal: return {};
    case TermKind::input:
      switch (term.input()) {
        case Input::x:
        case Input::y: return Dependence::position;
        case Input::velocity_x:
        case Input::velocity_y:
        case Input::raw_velocity_x:
        case Input::raw_velocity_y: return Dependence::velocity;
        case Input::patch_half_width:
        case Input::patch_half_height:
        case Input::patch_rim:
        case Input::probe:
        case Input::seconds_per_tick: return Dependence::parameter;
        default: return Dependence::moment;
      }
    case TermKind::state: return Dependence::state;
    case TermKind::cells:
    case TermKind::parameter:
    case TermKind::magnitude:
    case TermKind::carrier: return Dependence::parameter;
    case TermKind::open: return Dependence::open | Dependence::parameter;
    case TermKind::operation: {
      Dependence all;
      for (const TermId operand : operands(term)) all |= dependence(operand);
      if (term.operation == Operation::recall || term.operation == Operation::cell) all |= Dependence::state;
      return all;
    }
    case TermKind::component:
    case TermKind::gradient: return dependence(term.a);
    case TermKind::peak:
      // The patch's extents are setup inputs: the peak may change with them even if nothing else does.
      return Dependence::parameter | (dependence(term.a).on(Dependence::open) ? Dependence::open : 0);
  }
  return {};
}

TermId Terms::add(const Term& term) {
  Term& added = terms_.emplace_back(term);
  if (place_ && (term.span == Span{} || term.span.source != place_->source)) added.span = *place_;
  added.dependence = dependence_of(added);
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
