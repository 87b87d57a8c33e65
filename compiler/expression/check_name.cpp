// What a name means.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/expression/builtin_functions.hpp"

namespace wale {

namespace {

/// A name that the machine itself fills in.
struct InputName {
  std::string_view name;
  Input x;
  std::optional<Input> y;  ///< of a vector
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
};

const InputName* input_named(const NameKey& name) {
  static const auto index = [] {
    NameIndex<const InputName*> by_name;
    for (const InputName& each : input_names) by_name.add(each.name, &each);
    return by_name;
  }();
  const auto* found = index.find(name);
  return found ? *found : nullptr;
}

}  // namespace

bool names_hand_or_patch(const NameKey& name) { return input_named(name) != nullptr; }

bool ExpressionChecker::has_meaning(std::string_view name, const Scope& scope) const {
  const std::string_view whole = name.substr(0, name.find('.'));
  return scope.find(whole) || declarations_->constants.contains(whole) || names_hand_or_patch(whole);
}

std::optional<Value> ExpressionChecker::input(const Word& word, const Scope& scope) {
  const InputName* found = scope.hand ? input_named(word.text) : nullptr;
  if (!found) return std::nullopt;
  if (word.text.starts_with("raw_") && callees_.empty())
    surroundings_.diagnostics.report(
        {.code = Code::raw_signal,
         .span = blame(word.span),
         .message =
             fmt::format("`{}` is the difference of neighbouring positions: it jumps by whole counts", word.text),
         .help = fmt::format("use `{}`, which the device's filter has smoothed, unless the noise is what you want",
                             word.text.substr(4))});
  Value value{.type = found->condition ? Value::Type::boolean : Value::Type::number,
              .x = terms_.input(found->x, word.span),
              .dimension = found->condition ? Dimension{} : declarations_->dimension(found->dimension),
              .span = word.span};
  if (found->y) {
    value.type = Value::Type::vector;
    value.y = terms_.input(*found->y, word.span);
  }
  return value;
}

/// What a `let` outside the materials is worth.
std::optional<Value> ExpressionChecker::constant_named(const Word& word) {
  const auto* found = declarations_->constants.find(word.text);
  if (!found) return std::nullopt;
  const Callee definition{word.text, true};
  if (std::ranges::find(callees_, definition) != callees_.end())
    return report(Code::recursive_definition, word.span, fmt::format("`{}` is defined by itself", word.text), "",
                  "a `let` may use only what does not need it");
  const auto known = constants_.find(found->node);
  if (known == constants_.end()) {
    if (callees_.size() >= deepest_call)
      return report(Code::nested_too_deep, word.span,
                    fmt::format("more than {} definitions lead to one another here", deepest_call), "",
                    "write some of them out");
    callees_.push_back(definition);
    enter_call(word.span);
    const auto* outside_names = std::exchange(declarations_, found->home);
    Scope outside;
    const Value value = check(*found->tree, found->node->value, outside);
    declarations_ = outside_names;
    leave_call();
    callees_.pop_back();
    constants_[found->node] = value;
  }
  Value value = constants_.at(found->node);
  value.span = word.span;
  return value;
}

/// `hand.x`, `p.y`: one part of a vector.
std::optional<Value> ExpressionChecker::part_of_vector(const Word& word, Scope& scope) {
  const auto dot = word.text.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string_view whole = word.text.substr(0, dot), part = word.text.substr(dot + 1);
  if (!has_meaning(whole, scope)) return std::nullopt;
  Value value = name({whole, word.span}, scope);
  if (value.failed()) return value;
  if (value.type != Value::Type::vector || (part != "x" && part != "y"))
    return report(Code::wrong_type, word.span,
                  value.type == Value::Type::vector
                      ? fmt::format("a vector has no part `{}`", part)
                      : fmt::format("`{}` is {} and has no parts", whole, type_words(value.type)),
                  "", value.type == Value::Type::vector ? "its parts are `.x` and `.y`" : "use it as it is");
  value.type = Value::Type::number;
  if (part == "y") value.x = value.y;
  value.y = 0;
  return value;
}

std::optional<Value> ExpressionChecker::private_name(const Word& word) {
  const auto found = declarations_->private_names.find(word.text);
  if (found == declarations_->private_names.end()) return std::nullopt;
  return report(Code::private_name, word.span,
                fmt::format("`{}` belongs to {} alone", word.text, surroundings_.sources[found->second.source].name),
                "",
                Advice(fmt::format("write `export` before its declaration there (line {}), if others may use it",
                                   surroundings_.sources.place(found->second).line))
                    .see(found->second, "declared here, without `export`"));
}

/// The value of a name that the scope declares.
Value ExpressionChecker::bound(Scope::Binding& binding, Span span, Scope& scope) {
  binding.used = true;
  Value value = binding.value;
  // A memory's name alone is what it holds under the hand.
  if (value.type == Value::Type::field && value.field->kind == Field::Kind::memory)
    value = at(*value.field, *input({"hand", span}, scope), span);
  value.span = span;
  return value;
}

Value ExpressionChecker::name(const Word& word, Scope& scope) {
  auto* binding = scope.find(word.text);
  return binding ? bound(*binding, word.span, scope) : free_name(word, scope);
}

/// The value of a name that the scope does not declare.
Value ExpressionChecker::free_name(const Word& word, Scope& scope) {
  if (const auto filled_in = input(word, scope)) return *filled_in;
  if (word.text == "open") return {.type = Value::Type::open, .span = word.span};
  if (const auto constant = constant_named(word)) return *constant;
  if (const auto part = part_of_vector(word, scope)) return *part;
  if (unit(word.text))
    return report(Code::unknown_name, word.span, fmt::format("`{}` is a unit, and a unit follows a number", word.text),
                  "", fmt::format("write `1 {}`", word.text));
  if (declarations_->functions.contains(word.text) || is_builtin_function(word.text))
    return report(Code::unknown_name, word.span, fmt::format("`{}` is a function and needs its arguments", word.text),
                  "", fmt::format("write `{}(…)`", word.text));
  if (names_hand_or_patch(word.text))
    return report(Code::not_constant, word.span,
                  fmt::format("`{}` changes as the hand moves, and a constant is due here", word.text), "",
                  "use numbers, units and other constants");
  if (const auto hidden = private_name(word)) return *hidden;
  return report(Code::unknown_name, word.span, fmt::format("nothing here is called `{}`", word.text), "",
                spelling_mend(word, &scope, false, fmt::format("declare it above, as in `let {} = …`", word.text)));
}

}  // namespace wale
