#include "compiler/graph/term.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/machine/arithmetic.hpp"

namespace wale {

double result_in_double(Operation operation, double a, double b, double c) {
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

namespace {

Dependence dependence_of_input(Input input) {
  switch (input) {
    case Input::x:
    case Input::y:
    case Input::shape_edge:
    case Input::shape_edge_x:
    case Input::shape_edge_y: return Dependence::position;
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
}

/// The dependence that an operation adds to those of its operands, by its number.
constexpr auto own_dependence = [] {
  std::array<std::uint8_t, operation_table.size()> table{};
  table[static_cast<std::size_t>(Operation::sample)] = Dependence::table;
  table[static_cast<std::size_t>(Operation::recall)] = Dependence::table | Dependence::state;
  table[static_cast<std::size_t>(Operation::cell)] = Dependence::table | Dependence::state;
  return table;
}();

}  // namespace

[[gnu::always_inline]] inline void Terms::find_dependence(Term& term) const {
  if (term.kind == TermKind::operation) {  // as nearly always
    const auto number = static_cast<std::size_t>(term.operation);
    const int count = operation_table[number].operands;
    Dependence all = own_dependence[number];
    if (count > 0) all |= dependence(term.a);
    if (count > 1) all |= dependence(term.b);
    if (count > 2) all |= dependence(term.c);
    term.dependence = all;
    term.operands = static_cast<std::uint8_t>(count);
    // Unused operands are 0, which is the number of another term.
    if (all.known())
      term.value = result_in_double(term.operation, terms_[term.a].value, terms_[term.b].value, terms_[term.c].value);
    return;
  }
  switch (term.kind) {
    case TermKind::operation:
    case TermKind::literal: term.dependence = {}; return;
    case TermKind::input: term.dependence = dependence_of_input(term.input()); return;
    case TermKind::state: term.dependence = Dependence::state; return;
    case TermKind::cells:
    case TermKind::parameter:
    case TermKind::magnitude:
    case TermKind::carrier: term.dependence = Dependence::parameter; return;
    case TermKind::open: term.dependence = Dependence::open | Dependence::parameter; return;
    case TermKind::component:
    case TermKind::gradient:
      term.dependence = dependence(term.a);
      term.dependence |= Dependence::table;
      term.operands = 1;
      return;
    case TermKind::settled:
      term.dependence = dependence(term.a);
      term.operands = 1;
      return;
    case TermKind::peak:
      term.operands = 1;
      // The patch's extents are setup inputs, so the peak changes with them even if the height has no parameters.
      term.dependence = Dependence::parameter | (dependence(term.a).on(Dependence::open) ? Dependence::open : 0);
  }
}

/// Fills in the facts about the term that is being added.
[[gnu::always_inline]] inline TermId Terms::entered(Term& term) {
  if (place_ && (term.span == Span{} || term.span.source != place_->source)) term.span = *place_;
  find_dependence(term);
  return static_cast<TermId>(terms_.size() - 1);
}

TermId Terms::add(const Term& term) { return entered(terms_.emplace_back(term)); }

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
  Term& term = terms_.emplace_back();
  term.kind = TermKind::operation;
  term.operation = operation;
  term.a = a;
  term.b = b;
  term.span = span;
  return entered(term);
}

TermId Terms::apply(Operation operation, TermId a, TermId b, TermId c, Span span) {
  return add({.kind = TermKind::operation, .operation = operation, .a = a, .b = b, .c = c, .span = span});
}

TermId Terms::append(const Terms& others) {
  const auto first = static_cast<TermId>(terms_.size());
  terms_.insert(terms_.end(), others.terms_.begin(), others.terms_.end());
  // Unused operands are shifted too, which is harmless.
  for (auto term = terms_.begin() + first; term != terms_.end(); ++term)
    term->a += first, term->b += first, term->c += first;
  return first;
}

void Terms::settle(TermId open, TermId solution) {
  Term& term = terms_[open];
  term.kind = TermKind::settled;
  term.operands = 1;
  term.a = solution;
}

}  // namespace wale
