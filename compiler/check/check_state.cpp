// States and memories, and how they change.

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

/// The bounds written, or else those of the dimension.
std::optional<StatementChecker::Bounds> StatementChecker::bounds(const Word& name, const std::optional<Word>& declared,
                                                                 const std::optional<Range>& range,
                                                                 const Dimension& dimension) {
  const auto read = [&](const SyntaxTree& tree, const Range& written, Scope& scope) -> std::optional<Bounds> {
    const auto low = checker_.constant(tree, written.low, scope, dimension);
    const auto high = checker_.constant(tree, written.high, scope, dimension);
    if (!low || !high) return std::nullopt;
    if (*low <= *high) return Bounds{*low, *high};
    report(Code::value_out_of_range, tree.span(written.low), "the range runs from high to low", "exchange its ends");
    return std::nullopt;
  };
  if (range) return read(tree(), *range, scope_);
  std::optional<Bounds> found;
  const auto take = [&](const DimensionBounds& of_dimension) {
    Scope outside;
    if (of_dimension.range) found = read(*of_dimension.tree, *of_dimension.range, outside);
  };
  if (declared)
    if (const auto* of_dimension = declarations().dimension_bounds.find(declared->text)) take(*of_dimension);
  if (!found)
    declarations().dimensions.each([&](const std::string& known, const Dimension& other) {
      if (!found && other == dimension) take(*declarations().dimension_bounds.find(known));
    });
  if (!found)
    report(Code::missing_setting, name.span, fmt::format("nothing says how far `{}` may go", name.text),
           fmt::format("give it bounds, as in `state {} = … in LOW .. HIGH`", name.text));
  return found;
}

bool StatementChecker::fits(const Value& value, ExprId expr, const Dimension& dimension) {
  if (value.dimension == dimension) return true;
  // The checker's own words for it.
  return !checker_.check_as(tree(), expr, scope_, value.type, dimension).failed();
}

void StatementChecker::operator()(const StateStatement& node) {
  const auto dimension = declared_dimension(node.dimension);
  const Value initial = checker_.check(tree(), node.value, scope_);
  if (initial.failed() || (node.dimension && !dimension)) return declare_failed(node.name);
  if (initial.type != Value::Type::number && initial.type != Value::Type::vector) {
    report(Code::wrong_type, initial.span,
           fmt::format("a state is a number or a vector, not {}", type_words(initial.type)),
           "for a condition use a number that is 0 or 1");
    return declare_failed(node.name);
  }
  if (dimension && !fits(initial, node.value, *dimension)) return declare_failed(node.name);
  if (material_.terms.dependence(initial.x).on(Dependence::state)) {
    report(Code::wrong_rate, initial.span, "a state begins with what is known as the hand enters, and this is a state",
           "use the hand, parameters and constants; write the other state's own beginning here");
    return declare_failed(node.name);
  }
  const auto range = bounds(node.name, node.dimension, node.range, initial.dimension);
  if (!range) return declare_failed(node.name);
  for (const TermId part : {initial.x, initial.type == Value::Type::vector ? initial.y : initial.x})
    if (const auto known = constant_value(material_.terms, part);
        known && !(*known >= range->low && *known <= range->high)) {
      report(Code::value_out_of_range, initial.span, fmt::format("`{}` begins outside its range", node.name.text),
             "widen the range or begin elsewhere");
      return declare_failed(node.name);
    }
  Value value = initial;
  value.span = node.name.span;
  const std::string name = free_name(std::string(node.name.text), [&](const std::string& taken) {
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
    report(Code::value_out_of_range, tree().span(node.cell), "a cell is wider than nothing",
           "write, for example, `cell 1 mm`");
    return declare_failed(node.name);
  }
  if (!(*start >= range->low && *start <= range->high)) {
    report(Code::value_out_of_range, initial.span, fmt::format("`{}` begins outside its range", node.name.text),
           "widen the range or begin elsewhere");
    return declare_failed(node.name);
  }
  if (material_.memories.size() == most_memories) {
    report(Code::unbounded_memory, node.name.span, fmt::format("more than {} memories", most_memories),
           "keep what changes together in one");
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
  if (binding && binding->value.failed()) return;  // reported
  const auto memory = memories_.find(node.name.text);
  if (memory != memories_.end() && !node.derivative) return update_memory(node, memory->second);
  if (states_.contains(node.name.text)) return update_state(node);
  if (memory != memories_.end())
    return report(Code::wrong_type, node.name.span,
                  fmt::format("`{}` is a memory and has no rate of change", node.name.text),
                  fmt::format("write `next {} = …`: what the cell under the hand becomes", node.name.text));
  report(binding ? Code::wrong_type : Code::unknown_name, node.name.span,
         binding ? fmt::format("`{}` is no state", node.name.text)
                 : fmt::format("no state is called `{}`", node.name.text),
         did_you_mean(node.name.span, node.name.text, remembered(),
                      fmt::format("declare it above, as in `state {} = 0 mm in -10 mm .. 10 mm`", node.name.text)));
}

/// The names of what changes from tick to tick.
std::vector<std::string> StatementChecker::remembered() const {
  std::vector<std::string> names;
  for (const auto& [name, state] : states_) names.emplace_back(name);
  for (const auto& [name, memory] : memories_) names.emplace_back(name);
  return names;
}

/// The value of an update: a state that was updated above reads as its new value here, and nowhere else.
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
                  Advice("a state changes once a tick; put both into one").see(*state.next, "updated here first"));
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
                  Advice("a memory is written once a tick; put both into one").see(*known.next, "written here first"));
  known.next = node.name.span;
  auto& terms = material_.terms;
  const Span span = tree().span(node.value);
  const Value hand{.type = Value::Type::vector,
                   .x = terms.input(Input::x, span),
                   .y = terms.input(Input::y, span),
                   .dimension = declarations().dimension("length"),
                   .span = span};
  const auto [u, v] = memory_place(material_.terms, index, hand, span);
  // Here its name is the one cell that is written, not what lies between cells: nothing blurs by being read.
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
