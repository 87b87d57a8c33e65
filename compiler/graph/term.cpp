#include "compiler/graph/term.hpp"

namespace wale {

namespace {

void operator|=(Dependence& a, const Dependence& b) {
  a.parameter |= b.parameter;
  a.position |= b.position;
  a.velocity |= b.velocity;
  a.open |= b.open;
  a.moment |= b.moment;
  a.state |= b.state;
}

}  // namespace

void Terms::reserve(std::size_t terms) {
  terms_.reserve(terms);
  dependences_.reserve(terms);
}

TermId Terms::add(const Term& term) {
  Dependence dependence;
  switch (term.kind) {
    case TermKind::literal: break;
    case TermKind::input:
      switch (term.input()) {
        case Input::x:
        case Input::y: dependence.position = true; break;
        case Input::velocity_x:
        case Input::velocity_y:
        case Input::raw_velocity_x:
        case Input::raw_velocity_y: dependence.velocity = true; break;
        case Input::patch_half_width:
        case Input::patch_half_height:
        case Input::patch_rim:
        case Input::probe:
        case Input::seconds_per_tick: dependence.parameter = true; break;
        default: dependence.moment = true;
      }
      break;
    case TermKind::state: dependence.state = true; break;
    case TermKind::cells: dependence.parameter = true; break;
    case TermKind::parameter:
    case TermKind::magnitude:
    case TermKind::carrier: dependence.parameter = true; break;
    case TermKind::open: dependence.open = dependence.parameter = true; break;
    case TermKind::operation: {
      for (const TermId operand : operands(term)) dependence |= dependences_[operand];
      if (term.operation == Operation::recall || term.operation == Operation::cell) dependence.state = true;
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
  if (place_ && (term.span == Span{} || term.span.source != place_->source)) terms_.back().span = *place_;
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
