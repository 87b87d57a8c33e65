#include "compiler/expression/check_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/expression/builtin_functions.hpp"
#include "compiler/expression/fields.hpp"
#include "compiler/expression/other_languages.hpp"
#include "schema/spelling.hpp"

namespace wale {

namespace {

/// A name for an input of the machine.
struct InputName {
  std::string_view name;
  Input x;
  std::optional<Input> y;  ///< y part, if it is a vector
  const char* dimension;
  bool condition = false;
};

constexpr InputName input_names[] = {
    {"hand", Input::x, Input::y, "length"},
    {"x", Input::x, {}, "length"},
    {"y", Input::y, {}, "length"},
    {"velocity", Input::velocity_x, Input::velocity_y, "velocity"},
    {"acceleration", Input::acceleration_x, Input::acceleration_y, "acceleration"},
    {"raw_velocity", Input::raw_velocity_x, Input::raw_velocity_y, "velocity"},
    {"raw_acceleration", Input::raw_acceleration_x, Input::raw_acceleration_y, "acceleration"},
    {"hand_on_workspace", Input::workspace_x, Input::workspace_y, "length"},
    {"time", Input::time, {}, "time"},
    {"dt", Input::seconds_per_tick, {}, "time"},
    {"button", Input::button, {}, "number", true},
    {"patch_half_width", Input::patch_half_width, {}, "length"},
    {"patch_half_height", Input::patch_half_height, {}, "length"},
    {"patch_rim", Input::patch_rim, {}, "length"},
    {"shape_edge", Input::shape_edge, {}, "length"},
};

const InputName* input_named(std::string_view name) {
  const auto* found = std::ranges::find(input_names, name, &InputName::name);
  return found == std::end(input_names) ? nullptr : found;
}

/// The value of `hand`, `x`, `velocity` and the like, if the scope has a hand.
std::optional<Value> input(ExpressionReading& reading, const Word& word, const Scope& scope) {
  const InputName* found = scope.hand ? input_named(word.text) : nullptr;
  if (!found) return std::nullopt;
  if (word.text.starts_with("raw_") && reading.calls.empty())
    reading.surroundings.diagnostics.report(
        {.code = Code::raw_signal,
         .span = word.span,
         .message = fmt::format(
             "`{}` is computed from the difference of successive positions, so it jumps by whole encoder counts",
             word.text),
         .help = fmt::format("use `{}`, which the device's filter smooths, unless you want the noise",
                             word.text.substr(4))});
  Value value{.type = found->condition ? Value::Type::boolean : Value::Type::number,
              .x = reading.terms.input(found->x, word.span),
              .dimension = found->condition ? Dimension{} : reading.names->dimension(found->dimension),
              .span = word.span};
  if (found->y) {
    value.type = Value::Type::vector;
    value.y = reading.terms.input(*found->y, word.span);
  }
  return value;
}

/// The value of a `let` outside the materials. It is evaluated once.
std::optional<Value> constant_named(ExpressionReading& reading, const Word& word) {
  const auto* found = reading.names->constants.find(word.text);
  if (!found) return std::nullopt;
  CallStack& calls = reading.calls;
  if (calls.contains(word.text, true))
    return calls.report(
        Code::recursive_definition, word.span, fmt::format("`{}` is defined by itself", word.text), "",
        fmt::format("a `let` cannot use itself, directly or through others{}", calls.circle(word.text)));
  const auto known = reading.known.constants.find(found->node);
  if (known == reading.known.constants.end()) {
    if (calls.depth() >= deepest_call)
      return calls.report(Code::nested_too_deep, word.span,
                          fmt::format("more than {} definitions are nested here", deepest_call), "",
                          "write some of them out");
    if (!reading.charge(operations_of_text(found->tree->span(found->node->value)), word.span))
      return failed_value(word.span);
    calls.enter(word.text, true, word.span);
    const auto* outside_names = std::exchange(reading.names, found->home);
    Scope outside;
    const Value value = check_expression(reading, *found->tree, found->node->value, outside);
    reading.names = outside_names;
    calls.leave();
    reading.known.constants[found->node] = value;
  }
  Value value = reading.known.constants.at(found->node);
  value.span = word.span;
  return value;
}

/// Each part of a name is a call deeper.
constexpr int most_parts = 64;

/// The value of `hand.x` or `p.y`: one part of a vector.
std::optional<Value> part_of_vector(ExpressionReading& reading, const Word& word, Scope& scope) {
  const auto dot = word.text.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  if (std::ranges::count(word.text, '.') >= most_parts)
    return reading.calls.report(Code::nested_too_deep, word.span,
                                fmt::format("a name of more than {} parts", most_parts), "",
                                "a vector has the parts `.x` and `.y`, which have none");
  const std::string_view whole = word.text.substr(0, dot), part = word.text.substr(dot + 1);
  if (!has_value(reading, whole, scope)) return std::nullopt;
  const Value value = value_of_name(reading, {whole, word.span}, scope);
  if (value.failed()) return value;
  const bool vector = value.type == Value::Type::vector;
  if (!vector || (part != "x" && part != "y"))
    return reading.calls.report(Code::wrong_type, word.span,
                                vector ? fmt::format("a vector has no part `{}`", part)
                                       : fmt::format("`{}` is {} and has no parts", whole, type_words(value.type)),
                                "", vector ? "its parts are `.x` and `.y`" : "use it as it is");
  return value.part(part.front());
}

}  // namespace

bool names_hand_or_patch(std::string_view name) { return input_named(name) != nullptr; }

std::optional<Advice> import_mend(const Surroundings& surroundings, std::string_view name,
                                  std::initializer_list<std::string_view> kinds) {
  if (!surroundings.find_exporter) return std::nullopt;
  const auto exporter = (*surroundings.find_exporter)(name);
  if (!exporter || std::ranges::find(kinds, exporter->what) == kinds.end()) return std::nullopt;
  return Advice(fmt::format("`{}` is a {} of `{}`; write `import {}`", name, exporter->what, exporter->module,
                            exporter->module))
      .fact("import", exporter->module);
}

bool has_value(const ExpressionReading& reading, std::string_view name, const Scope& scope) {
  const std::string_view whole = name.substr(0, name.find('.'));
  return scope.find(whole) || reading.names->constants.contains(whole) || names_hand_or_patch(whole);
}

std::optional<Value> private_name(ExpressionReading& reading, const Word& word) {
  const auto found = reading.names->private_names.find(word.text);
  if (found == reading.names->private_names.end()) return std::nullopt;
  const SourceSet& sources = reading.surroundings.sources;
  return reading.calls.report(
      Code::private_name, word.span,
      fmt::format("`{}` is private to {}", word.text, sources[found->second.source].name), "",
      Advice(fmt::format("write `export` before its declaration there (line {}), if other files may use it",
                         sources.place(found->second).line))
          .see(found->second, "declared here, without `export`"));
}

std::vector<std::string> functions_that_take(const Declarations& names, std::size_t arguments) {
  std::vector<std::string> all = names.functions.spellings();
  std::erase_if(all, [&](const std::string& name) {
    const auto* known = names.functions.find(name);
    return known && known->node && known->node->parameters.size() < arguments;
  });
  all.emplace_back("curve");
  for (const Builtin& builtin : builtins())
    if (builtin.formals.size() >= arguments) all.emplace_back(builtin.name);
  return all;
}

Advice spelling_mend(ExpressionReading& reading, const Word& word, const Scope* scope, Sought sought,
                     Advice otherwise, std::size_t arguments) {
  // A function's body is read at each of its calls, but a misspelt word in it is looked up only once.
  const Span place = reading.calls.blame(word.span);
  if (!reading.known.misspelt.emplace(place.source, place.begin).second) return otherwise;
  const Surroundings& surroundings = reading.surroundings;
  if (surroundings.diagnostics.is_full()) return otherwise;  // the advice would not be shown
  std::vector<std::string> candidates;
  if (sought == Sought::function) {
    candidates = functions_that_take(*reading.names, arguments);
  } else {
    if (scope) candidates = scope->spellings();
    if (scope && scope->hand)
      candidates.insert(candidates.end(), {"hand", "velocity", "acceleration", "time", "button"});
    const auto constants = reading.names->constants.spellings();
    candidates.insert(candidates.end(), constants.begin(), constants.end());
  }
  const bool in_file = reading.names == &surroundings.declarations;
  if (auto imported =
          in_file ? import_mend(surroundings, word.text, {"function", "constant", "unit", "dimension"}) : std::nullopt)
    return *std::move(imported);
  if (const auto ours = sought == Sought::function ? instead_of_function(word.text) : instead_of_value(word.text))
    return std::string(*ours);
  if (const std::size_t dot = word.text.rfind('.');
      dot != std::string_view::npos && !nearest_spelling(word.text, candidates)) {
    // `self.k`
    const std::string last(word.text.substr(dot + 1));
    if (std::ranges::find(candidates, last) != candidates.end())
      return Advice(fmt::format("write `{}`", last)).fix(replace(word.span, last, {}, false)).fact("meant", last);
    return did_you_mean(word.span, word.text.substr(dot + 1), candidates, std::move(otherwise), false);
  }
  return did_you_mean(word.span, word.text, candidates, std::move(otherwise));
}

/// The advice for a name that is declared further down; empty if none is.
std::optional<Advice> below_mend(const ExpressionReading& reading, const Word& word) {
  if (!reading.calls.empty() || !reading.declared_below) return std::nullopt;
  const auto below = reading.declared_below(word.text);
  if (!below) return std::nullopt;
  const unsigned line = reading.surroundings.sources.place(*below).line;
  return Advice(fmt::format("it is declared further down, in line {}; move that above this line", line))
      .see(*below, "declared here");
}

Value bound_value(ExpressionReading& reading, Scope::Binding& binding, Span span, Scope& scope) {
  binding.used = true;
  Value value = binding.value;
  // The name of a memory alone means its value under the hand.
  if (value.type == Value::Type::field && value.field->kind == Field::Kind::memory)
    value = value_at(reading.terms, *value.field, *input(reading, {"hand", span}, scope), span);
  value.span = span;
  return value;
}

Value value_of_name(ExpressionReading& reading, const Word& word, Scope& scope) {
  auto* binding = scope.find(word.text);
  return binding ? bound_value(reading, *binding, word.span, scope) : free_value(reading, word, scope);
}

Value free_value(ExpressionReading& reading, const Word& word, Scope& scope) {
  if (const auto filled_in = input(reading, word, scope)) return *filled_in;
  if (word.text == "open") return {.type = Value::Type::open, .span = word.span};
  if (const auto constant = constant_named(reading, word)) return *constant;
  if (const auto part = part_of_vector(reading, word, scope)) return *part;
  const auto report = [&](Code code, std::string message, Advice advice) {
    return reading.calls.report(code, word.span, std::move(message), "", std::move(advice));
  };
  if (reading.names->units.contains(word.text))
    return report(Code::unknown_name, fmt::format("`{}` is a unit, and a unit follows a number", word.text),
                  fmt::format("write `1 {}`", word.text));
  if (reading.names->functions.contains(word.text) || is_builtin_function(word.text))
    return report(Code::unknown_name, fmt::format("`{}` is a function and needs its arguments", word.text),
                  fmt::format("write `{}(…)`", word.text));
  if (names_hand_or_patch(word.text))
    return report(Code::not_constant, fmt::format("expected a constant, but `{}` changes as the hand moves", word.text),
                  "use numbers, units and other constants");
  if (const auto hidden = private_name(reading, word)) return *hidden;
  auto below = below_mend(reading, word);
  return report(Code::unknown_name, fmt::format("nothing here is called `{}`", word.text),
                below ? *std::move(below)
                      : spelling_mend(reading, word, &scope, Sought::value,
                                      fmt::format("declare it above, as in `let {} = …`",
                                                  word.text.substr(0, word.text.find('.')))));
}

}  // namespace wale
