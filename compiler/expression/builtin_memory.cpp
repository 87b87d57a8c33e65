#include <fmt/format.h>

#include "compiler/expression/builtin_functions.hpp"

// Functions that remember. Their states have no names in the text: nothing else can read or change them.

#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// Adds a state that begins as `initial`, and returns the term of its value. Set its `next` afterwards.
TermId add_state(const BuiltinCall& call, std::string name, const StateBounds& bounds, TermId initial,
                 const Dimension& dimension = {}) {
  auto& states = call.reading.record.states;
  const auto index = static_cast<std::uint32_t>(states.size());
  const TermId now = call.terms().add({.kind = TermKind::state, .index = index, .span = call.span});
  states.push_back({.name = std::move(name),
                    .low = bounds.low,
                    .high = bounds.high,
                    .initial = initial,
                    .next = now,
                    .si_unit = dimension.plain() ? "" : call.reading.dimension_names().unit(dimension),
                    .span = call.span});
  return now;
}

/// Whether the place of a `stretch` can be remembered: it is known when the hand enters, and has bounds. Otherwise it
/// is reported.
std::optional<StateBounds> remembered_bounds(const BuiltinCall& call) {
  const Value& place = call.value(0);
  const auto changes = [&](TermId part) { return call.terms().dependence(part).on(Dependence::state); };
  if (changes(place.x) || (place.type == Value::Type::vector && changes(place.y))) {
    call.reading.calls.report(
        Code::wrong_rate, call.actuals[0].span,
        "`stretch` takes a place that is known when the hand enters, but this depends on a state", "",
        "use the hand, parameters and constants; or declare a state of your own for the end that is dragged along");
    return std::nullopt;
  }
  const auto bounds = state_bounds(call.reading, place.dimension);
  if (!bounds)
    call.reading.calls.report(Code::missing_setting, call.actuals[0].span,
                              fmt::format("`stretch` remembers {}, for which nothing declares bounds",
                                          with_article(call.reading.dimension_names().words(place.dimension))),
                              "", "declare them, as in `dimension NAME = … in LOW .. HIGH`");
  return bounds;
}

}  // namespace

/// `phase(frequency)`: a state that runs from 0 to 1 `frequency` times per second.
Value phase(const BuiltinCall& call) {
  if (!call.number(0)) return call.failed();
  const auto frequency = call.reading.names->dimension("frequency");
  if (call.value(0).dimension != frequency) {
    const auto known = constant_value(call.terms(), call.value(0).x);
    const bool is_period = known && *known > 0 && call.value(0).dimension == Dimension{} / frequency;
    return call.reading.calls.report(
        Code::wrong_dimension, call.actuals[0].span,
        fmt::format("expected a frequency, found {}",
                    with_article(call.reading.dimension_names().words(call.value(0).dimension))),
        call.reading.dimension_names().unit(call.value(0).dimension),
        is_period ? typeable("for this period write `phase({:.6g} Hz)`", 1 / *known)
                  : "write something like `phase(2 Hz)`");
  }
  const auto [known, added] = call.reading.record.phases.try_emplace(call.value(0).x, 0);
  if (!added) return call.scalar(known->second);
  call.reading.record.rates.push_back({call.value(0).x, call.reading.calls.blame(call.actuals[0].span)});
  auto& states = call.reading.record.states;
  const std::size_t index = states.size();
  const TermId now = add_state(call, fmt::format("phase {}", index), {0, 1}, call.terms().literal(0, call.span));
  const TermId step =
      call.terms().apply(Operation::multiply, call.value(0).x, call.terms().input(Input::seconds_per_tick), call.span);
  const TermId sum = call.terms().apply(Operation::add, now, step, call.span);
  states[index].next =
      call.terms().apply(Operation::subtract, sum, call.terms().apply(Operation::floor, sum, call.span), call.span);
  known->second = now;
  return call.scalar(now);
}

/// `stretch(place, reach)`: how far a place has moved away from the end that it drags behind it on a thread of length
/// `reach`: the stop operator of hysteresis. The end begins at the place.
Value stretch(const BuiltinCall& call) {
  const Value& place = call.value(0);
  if ((place.type != Value::Type::vector && !call.number(0)) || !call.number(1)) return call.failed();
  if (place.dimension != call.value(1).dimension) return call.mismatched(0, 1);
  const auto bounds = remembered_bounds(call);
  if (!bounds) return call.failed();
  const bool vector = place.type == Value::Type::vector;
  Terms& terms = call.terms();
  auto& states = call.reading.record.states;
  const std::size_t first = states.size();
  const auto away = [&](TermId part, const char* name) {
    const TermId end = add_state(call, fmt::format("stretch {}{}", first, name), *bounds, part, place.dimension);
    return terms.apply(Operation::subtract, part, end, call.span);
  };
  Value whole = place;
  whole.x = away(place.x, vector ? ".x" : "");
  if (vector) whole.y = away(place.y, ".y");
  Value kept = held(terms, whole, call.value(1).x, call.span);
  const auto dragged = [&](TermId part, TermId kept_part) {
    TermId end = terms.apply(Operation::subtract, part, kept_part, call.span);
    end = terms.apply(Operation::minimum, end, terms.literal(bounds->high, call.span), call.span);
    return terms.apply(Operation::maximum, end, terms.literal(bounds->low, call.span), call.span);
  };
  states[first].next = dragged(place.x, kept.x);
  if (vector) states[first + 1].next = dragged(place.y, kept.y);
  return kept;
}

}  // namespace wale
