#include "compiler/solve/vibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/choose_map.hpp"
#include "compiler/solve/law.hpp"

namespace wale {

namespace {

/// The percept that a force with this name carries on devices that push; null if there is none.
const Percept* percept_of(const Carrier& carrier, const Declarations& declarations) {
  const Percept* found = nullptr;
  declarations.percepts.each([&](const std::string&, const Percept& percept) {
    if (percept.carrier == carrier.name && percept.has_reference) found = &percept;
  });
  return found;
}

/// The level of the author's own size of a force, on the device of the percept's reference stimulus.
std::optional<double> level_of(const CheckedMaterial& material, const Carrier& carrier, const Percept& percept,
                               const Declarations& declarations) {
  const DeviceDeclaration* reference = declarations.devices.find(percept.reference_device);
  const auto size = constant_value(material.terms, carrier.size, &material.parameters);
  if (carrier.open || !reference || !size) return std::nullopt;
  const Map* map = choose_map(percept, *reference, declarations).map;
  const double level = map ? Law(*map, percept).level_of(*size) : std::nan("");
  if (!(level > 0)) return std::nullopt;
  return std::min(level, 1.0);
}

/// Whether the force is a sum of only carriers and zeros.
bool is_sum_of_carriers(const CheckedMaterial& material) {
  std::vector<std::array<TermId, 2>> waiting{*material.force};
  while (!waiting.empty()) {
    const TermId x = waiting.back()[0], y = waiting.back()[1];
    waiting.pop_back();
    const auto carries = [&](const Carrier& carrier) { return carrier.force_x == x && carrier.force_y == y; };
    if (std::ranges::any_of(material.carriers, carries)) continue;
    const Term &of_x = material.terms[x], &of_y = material.terms[y];
    const auto is_zero = [](const Term& term) { return term.kind == TermKind::literal && term.value == 0; };
    const auto is_sum = [](const Term& term) {
      return term.kind == TermKind::operation && term.operation == Operation::add;
    };
    if (is_zero(of_x) && is_zero(of_y)) continue;
    if (!is_sum(of_x) || !is_sum(of_y)) return false;
    waiting.push_back({of_x.a, of_y.a});
    waiting.push_back({of_x.b, of_y.b});
  }
  return true;
}

}  // namespace

Scope shaking_scope(Terms& terms, TermId shaking, TermId period, const DeviceDeclaration& device,
                    const Declarations& declarations, Span span) {
  const auto squared = [&](Input input) {
    const TermId along = terms.input(input);
    return terms.apply(Operation::multiply, along, along);
  };
  const TermId speed = device.profile.has_position()
                           ? terms.apply(Operation::square_root, terms.apply(Operation::add, squared(Input::velocity_x),
                                                                             squared(Input::velocity_y)))
                           : terms.literal(device.profile.shaker->exploring_speed);
  Scope scope;
  scope.hand = true;
  const auto declare = [&](const char* name, TermId term, const char* dimension) {
    scope.declare(name, {.type = Value::Type::number, .x = term, .dimension = declarations.dimension(dimension)}, span);
  };
  declare("shaking", shaking, "acceleration");
  declare("speed", speed, "velocity");
  declare("period", period, "length");
  return scope;
}

Shaking together(Terms& terms, const Shaking& a, const Shaking& b) {
  const auto squared = [&](TermId term) { return terms.apply(Operation::multiply, term, term); };
  const TermId weaker = terms.apply(Operation::less, a.amplitude, b.amplitude);
  return {terms.apply(Operation::square_root, terms.apply(Operation::add, squared(a.amplitude), squared(b.amplitude))),
          terms.apply(Operation::select, weaker, b.rate, a.rate)};
}

std::optional<TermId> texture_period(const CheckedMaterial& material, const Percept& percept) {
  for (const CheckedPeriod& period : material.periods) {
    if (material.terms.dependence(period.length).in_tick()) continue;
    const auto length = constant_value(material.terms, period.length, &material.parameters);
    if (length && *length > 0 && percept.period.holds(*length)) return period.length;
  }
  return std::nullopt;
}

CheckedMaterial without_force(const CheckedMaterial& material, const DeviceDeclaration& device,
                              const Declarations& declarations, std::vector<FateRecord>& fates) {
  CheckedMaterial left = material;
  const std::string& name = device.profile.name;
  const auto tell = [&](const std::string& what, Fate fate, const std::string& reason) {
    const auto same = [&](const FateRecord& each) { return each.name == what; };
    if (std::ranges::none_of(fates, same)) fates.push_back({.name = what, .fate = fate, .reason = reason});
  };
  bool texture = false;
  for (const Carrier& carrier : material.carriers) {
    const Percept* percept = percept_of(carrier, declarations);
    if (!percept || !device.realise.contains(percept->name)) {
      tell(carrier.name, Fate::lost, fmt::format("`{}` cannot push", name));
      continue;
    }
    const auto asked = [&](const auto& each) { return each.name == percept->name; };
    const auto level = level_of(material, carrier, *percept, declarations);
    if (std::ranges::none_of(left.percepts, asked) && std::ranges::none_of(material.parameters, asked) && level)
      left.percepts.push_back({.name = percept->name, .level = *level, .span = carrier.span});
    if (std::ranges::none_of(left.percepts, asked)) {
      tell(carrier.name, Fate::lost, fmt::format("nothing says how much {} it makes", percept->name));
      continue;
    }
    tell(carrier.name, Fate::approximated, fmt::format("`{}` shakes instead of pushing", name));
    if (!carrier.relief) continue;
    texture = true;
    if (texture_period(material, *percept))
      tell("texture period", Fate::kept, "it shakes as often as periods pass under the hand");
    else
      tell("texture period", Fate::lost, fmt::format("nothing tells it, so that of the rule is taken"));
  }
  if (!is_sum_of_carriers(material)) tell("other forces", Fate::lost, fmt::format("`{}` cannot push", name));
  const auto& [x, y] = *material.force;
  const auto of_place = [&](TermId force) {
    return material.terms.dependence(force).on(Dependence::position | Dependence::moment | Dependence::state);
  };
  if (texture && device.profile.has_position())
    tell("place of features", Fate::approximated, "as many pass, and none is anywhere");
  else if (texture || of_place(x) || of_place(y))
    tell("place of features", Fate::lost,
         device.profile.has_position() ? fmt::format("`{}` cannot push", name)
                                       : fmt::format("`{}` does not know where the hand is", name));
  if (fates.empty()) tell("force", Fate::kept, "it pushes nowhere");
  left.force.reset();
  left.carriers.clear();
  left.open_spans.clear();
  left.blended_opens.clear();
  left.active_watt = 0;
  return left;
}

}  // namespace wale
