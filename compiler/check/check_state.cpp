// Checks the declarations and updates of states and memories.

#include <fmt/format.h>

#include <algorithm>

#include "compiler/check/check_statements.hpp"
#include "compiler/expression/fields.hpp"

namespace wale {

namespace {

constexpr std::size_t most_memories = 16;
constexpr double most_float = 3.4e38;

}  // namespace

std::optional<Dimension> StatementChecker::declared_dimension(const std::optional<Word>& dimension) {
  const auto* known = dimension ? declarations().dimensions.find(dimension->text) : nullptr;
  if (dimension && !known && !checker_.report_private(*dimension))
    report(
        Code::unknown_name, dimension->span, fmt::format("nothing declares a dimension `{}`", dimension->text),
        did_you_mean(dimension->span, dimension->text, declarations().dimensions.spellings(),
                     fmt::format("use one of schema/units.wale, or declare it: `dimension {} = …`", dimension->text)));
  return known ? std::optional(*known) : std::nullopt;
}

/// The bounds that the author wrote, or else those of the dimension.
std::optional<StateBounds> StatementChecker::bounds(const Word& name, const std::optional<Word>& declared,
                                                    const std::optional<Range>& range, const Dimension& dimension) {
  if (range) return checker_.bounds(tree(), *range, scope_, dimension);
  const auto found = checker_.bounds_of(dimension, declared ? declared->text : std::string_view{});
  if (!found)
    report(Code::missing_setting, name.span, fmt::format("`{}` has no bounds", name.text),
           fmt::format("give it bounds, as in `state {} = … in LOW .. HIGH`", name.text));
  return found;
}

bool StatementChecker::fits(const Value& value, ExprId expr, const Dimension& dimension) {
  if (value.dimension == dimension) return true;
  // `check_as` reports it, with its usual message.
  return !checker_.check_as(tree(), expr, scope_, value.type, dimension).failed();
}

void StatementChecker::operator()(const StateStatement& node) {
  const auto dimension = declared_dimension(node.dimension);
  const Value initial = checker_.check(tree(), node.value, scope_);
  if (initial.failed() || (node.dimension && !dimension)) return declare_failed(node.name);
  if (initial.type != Value::Type::number && initial.type != Value::Type::vector) {
    report(Code::wrong_type, initial.span,
           fmt::format("a state must be a number or a vector, not {}", type_words(initial.type)),
           "for a condition, use a number that is 0 or 1");
    return declare_failed(node.name);
  }
  if (dimension && !fits(initial, node.value, *dimension)) return declare_failed(node.name);
  if (material_.terms.dependence(initial.x).on(Dependence::state)) {
    report(Code::wrong_rate, initial.span,
           "the initial value of a state must be known when the hand enters, but this depends on a state",
           "use the hand, parameters and constants; write the other state's initial value here");
    return declare_failed(node.name);
  }
  const auto range = bounds(node.name, node.dimension, node.range, initial.dimension);
  if (!range) return declare_failed(node.name);
  for (const TermId part : {initial.x, initial.type == Value::Type::vector ? initial.y : initial.x})
    if (const auto known = constant_value(material_.terms, part);
        known && !(*known >= range->low && *known <= range->high)) {
      report(Code::value_out_of_range, initial.span,
             fmt::format("the initial value of `{}` is outside its range", node.name.text),
             "widen the range or change the initial value");
      return declare_failed(node.name);
    }
  Value value = initial;
  value.span = node.name.span;
  const std::string name = free_name(std::string(node.name.text), [&](const std::string& taken) {
    if (!checker_.charge(1 + checker_.record().states.size(), node.name.span)) return false;
    return std::ranges::any_of(checker_.record().states,
                               [&](const auto& other) { return other.name == taken || other.name == taken + ".x"; });
  });
  const auto add = [&](TermId first, const char* part) {
    const auto index = static_cast<std::uint32_t>(checker_.record().states.size());
    const TermId now = material_.terms.add({.kind = TermKind::state, .index = index, .span = node.name.span});
    checker_.record().states.push_back({.name = name + part,
                                        .low = range->low,
                                        .high = range->high,
                                        .initial = first,
                                        .next = now,
                                        .si_unit = declarations().names().unit(initial.dimension),
                                        .span = node.name.span});
    return now;
  };
  KnownState known{.first = static_cast<std::uint32_t>(checker_.record().states.size()), .updated = {}, .next = {}};
  const bool vector = initial.type == Value::Type::vector;
  value.x = add(initial.x, vector ? ".x" : "");
  if (vector) value.y = add(initial.y, ".y");
  declare(node.name, value);
  states_.emplace(node.name.text, known);
}

void StatementChecker::operator()(const MemoryStatement& node) {
  const auto dimension = declared_dimension(node.dimension);
  const Value initial = checker_.check(tree(), node.value, scope_);
  if (initial.failed() || (node.dimension && !dimension)) return declare_failed(node.name);
  if (dimension && !fits(initial, node.value, *dimension)) return declare_failed(node.name);
  const auto start = checker_.constant(tree(), node.value, scope_, initial.dimension);
  const auto cell = checker_.constant(tree(), node.cell, scope_, declarations().dimension("length"));
  const auto range = bounds(node.name, node.dimension, node.range, initial.dimension);
  if (!start || !cell || !range) return declare_failed(node.name);
  if (!(*cell > 0)) {
    report(Code::value_out_of_range, tree().span(node.cell), "the width of a cell must be greater than zero",
           "write, for example, `cell 1 mm`");
    return declare_failed(node.name);
  }
  if (!(*start >= range->low && *start <= range->high)) {
    report(Code::value_out_of_range, initial.span,
           fmt::format("the initial value of `{}` is outside its range", node.name.text),
           "widen the range or change the initial value");
    return declare_failed(node.name);
  }
  if (material_.memories.size() == most_memories) {
    report(Code::unbounded_memory, node.name.span, fmt::format("more than {} memories", most_memories),
           "use one memory for quantities that change together");
    return declare_failed(node.name);
  }
  const auto index = static_cast<std::uint32_t>(material_.memories.size());
  const std::string name = free_name(std::string(node.name.text), [&](const std::string& taken) {
    return std::ranges::find(material_.memories, taken, &CheckedMemory::name) != material_.memories.end();
  });
  material_.memories.push_back({.name = name,
                                .dimension = initial.dimension,
                                .initial = *start,
                                .low = range->low,
                                .high = range->high,
                                .cell = *cell,
                                .next = {},
                                .si_unit = declarations().names().unit(initial.dimension),
                                .span = node.name.span});
  const Field field{
      .kind = Field::Kind::memory, .from = declarations().dimension("length"), .to = initial.dimension, .index = index};
  declare(node.name, {.type = Value::Type::field,
                      .dimension = initial.dimension,
                      .field = checker_.record().keep(field),
                      .span = node.name.span});
  memories_.emplace(node.name.text, KnownMemory{index, {}});
}

void StatementChecker::operator()(const UpdateStatement& node) {
  auto* binding = scope_.find(node.name.text);
  if (binding && binding->value.failed()) return;  // already reported
  const auto memory = memories_.find(node.name.text);
  if (memory != memories_.end() && !node.derivative) return update_memory(node, memory->second);
  if (states_.contains(node.name.text)) return update_state(node);
  if (memory != memories_.end())
    return report(Code::wrong_type, node.name.span,
                  fmt::format("`{}` is a memory, which has no rate of change", node.name.text),
                  fmt::format("write `next {} = …`, the new value of the cell under the hand", node.name.text));
  report(binding ? Code::wrong_type : Code::unknown_name, node.name.span,
         binding ? fmt::format("`{}` is not a state", node.name.text)
                 : fmt::format("no state is called `{}`", node.name.text),
         did_you_mean(node.name.span, node.name.text, remembered(),
                      fmt::format("declare it above, as in `state {} = 0 mm in -10 mm .. 10 mm`", node.name.text)));
}

/// The names of all states and memories.
std::vector<std::string> StatementChecker::remembered() const {
  std::vector<std::string> names;
  for (const auto& [name, state] : states_) names.emplace_back(name);
  for (const auto& [name, memory] : memories_) names.emplace_back(name);
  return names;
}

/// The value of an update. Only here, a state that was updated above has its new value.
Value StatementChecker::check_update(const UpdateStatement& node, Value::Type type, const Dimension& dimension) {
  std::vector<std::pair<std::string_view, Value>> before;
  for (const auto& [name, known] : states_)
    if (!known.updated.failed()) {
      before.emplace_back(name, scope_.at(name).value);
      scope_.at(name).value = known.updated;
    }
  const Value value = checker_.check_as(tree(), node.value, scope_, type, dimension);
  for (auto& [name, old] : before) scope_.at(name).value = old;
  return value;
}

void StatementChecker::update_state(const UpdateStatement& node) {
  KnownState& state = states_.at(node.name.text);
  if (state.next)
    return report(Code::declared_twice, node.name.span,
                  fmt::format("`{}` is updated already, on line {}", node.name.text,
                              surroundings_.sources.place(*state.next).line),
                  Advice("a state can be updated only once per tick; combine both into one")
                      .see(*state.next, "updated here first"));
  state.next = node.name.span;
  const Value now = scope_.at(node.name.text).value;
  const Dimension due = node.derivative ? now.dimension / declarations().dimension("time") : now.dimension;
  const Value value = check_update(node, now.type, due);
  if (value.failed()) return;

  auto& terms = material_.terms;
  const Span span = tree().span(node.value);
  Value updated = now;
  const bool vector = now.type == Value::Type::vector;
  for (std::uint32_t part = 0; part < (vector ? 2u : 1u); ++part) {
    CheckedState& checked = checker_.record().states[state.first + part];
    TermId next = part == 0 ? value.x : value.y;
    if (node.derivative)
      next =
          terms.apply(Operation::add, part == 0 ? now.x : now.y,
                      terms.apply(Operation::multiply, next, terms.input(Input::seconds_per_tick, span), span), span);
    next = terms.apply(Operation::minimum, next, terms.literal(std::min(checked.high, most_float), span), span);
    next = terms.apply(Operation::maximum, next, terms.literal(std::max(checked.low, -most_float), span), span);
    checked.next = next;
    (part == 0 ? updated.x : updated.y) = next;
  }
  state.updated = updated;
}

void StatementChecker::update_memory(const UpdateStatement& node, KnownMemory& known) {
  const std::uint32_t index = known.index;
  CheckedMemory& memory = material_.memories[index];
  if (known.next)
    return report(Code::declared_twice, node.name.span, fmt::format("`{}` is written already", node.name.text),
                  Advice("a memory can be written only once per tick; combine both into one")
                      .see(*known.next, "written here first"));
  known.next = node.name.span;
  auto& terms = material_.terms;
  const Span span = tree().span(node.value);
  const Value hand{.type = Value::Type::vector,
                   .x = terms.input(Input::x, span),
                   .y = terms.input(Input::y, span),
                   .dimension = declarations().dimension("length"),
                   .span = span};
  const auto [u, v] = memory_place(material_.terms, index, hand, span);
  // Here the name means the one cell that is written, not an interpolation between cells, which would blur the memory.
  auto& binding = scope_.at(node.name.text);
  const Value whole = binding.value;
  binding.used = true;
  binding.value = {
      .type = Value::Type::number,
      .x = terms.add(
          {.kind = TermKind::operation, .operation = Operation::cell, .a = u, .b = v, .index = index, .span = span}),
      .dimension = memory.dimension,
      .span = span};
  const Value value = check_update(node, Value::Type::number, memory.dimension);
  scope_.at(node.name.text).value = whole;
  if (!value.failed()) material_.memories[index].next = {u, v, value.x};
}

}  // namespace wale
