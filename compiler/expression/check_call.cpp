#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "compiler/expression/builtin_functions.hpp"

namespace wale {

std::string what_changes(const Dependence& dependence) {
  return dependence.on(Dependence::velocity) ? "velocity"
         : dependence.on(Dependence::state)  ? "what the material remembers"
                                             : "time";
}

Advice ExpressionChecker::spelling_mend(const Word& word, const Scope* scope, bool functions, Advice otherwise) {
  // A function's body is read at each of its calls, and says what is wrong with a word of it once.
  const Span place = blame(word.span);
  if (!misspelt_.emplace(place.source, place.begin).second) return otherwise;
  if (surroundings_.diagnostics.is_full()) return otherwise;  // all the names there are, for nobody
  std::vector<std::string> candidates;
  if (functions) {
    candidates = declarations_->functions.spellings();
    candidates.emplace_back("curve");
    for (const auto& builtin : builtins()) candidates.emplace_back(builtin.name);
  } else {
    if (scope) candidates = scope->spellings();
    if (scope && scope->hand)
      candidates.insert(candidates.end(), {"hand", "velocity", "acceleration", "time", "button"});
    const auto constants = declarations_->constants.spellings();
    candidates.insert(candidates.end(), constants.begin(), constants.end());
  }
  return did_you_mean(word.span, word.text, candidates, std::move(otherwise));
}

std::vector<std::string> ExpressionChecker::Formals::spellings() const {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < size_; ++i) all.emplace_back((*this)[i]);
  return all;
}

bool ExpressionChecker::bind_arguments(const SyntaxTree& tree, const Call& call, const Formals& formals, Scope& scope,
                                       std::vector<Actual>& actuals) {
  actuals.assign(formals.size(), {});
  bool good = true;
  std::size_t position = 0;
  for (const auto& argument : tree.arguments(call)) {
    const Span span = tree.span(argument.value);
    const Value value = check(tree, argument.value, scope);
    std::size_t index = position;
    if (argument.name) {
      index = formals.find(argument.name->text);
      if (index == formals.size()) {
        report(Code::unknown_argument, argument.name->span,
               fmt::format("`{}` takes no argument `{}`", call.callee.text, argument.name->text), "",
               did_you_mean(argument.name->span, argument.name->text, formals.spellings(),
                            fmt::format("it takes: {}", fmt::join(formals.spellings(), ", "))));
        good = false;
        continue;
      }
    } else {
      ++position;
      if (index >= formals.size()) {
        report(Code::unknown_argument, span,
               fmt::format("`{}` takes {} argument{}, and this is one more", call.callee.text, formals.size(),
                           formals.size() == 1 ? "" : "s"),
               "",
               formals.size() == 0 ? "write it without arguments"
                                   : fmt::format("it takes: {}", fmt::join(formals.spellings(), ", ")));
        good = false;
        continue;
      }
    }
    if (actuals[index].given) {
      report(Code::declared_twice, span, fmt::format("the argument `{}` is given twice", formals[index]), "",
             Advice("give it once").see(actuals[index].span, "given here first"));
      good = false;
      continue;
    }
    actuals[index] = {.value = value, .span = span, .given = true};
    if (value.failed()) good = false;
  }
  return good;
}

Value ExpressionChecker::call(const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope) {
  const Span span = tree.span(expr);
  const NameKey callee = call.callee.text;
  auto* binding = scope.find(callee);
  if (binding && binding->value.type == Value::Type::field) {
    binding->used = true;
    return call_field(tree, expr, call, binding->value, scope);
  }
  const Builtin* builtin = builtin_named(callee);
  const auto* function = builtin ? nullptr : declarations_->functions.find(callee);  // no name is both
  if (binding && !function && binding->value.failed()) {
    binding->used = true;
    return failed(span);  // reported where it was declared
  }
  if (function) return call_function(tree, expr, call, *function, scope);
  if (call.callee.text == "curve") return curve(tree, expr, call, scope);
  if (!builtin) {
    if (declarations_->constants.contains(call.callee.text)) {
      const Value constant = name(call.callee, scope);
      if (constant.failed()) return constant;
      if (constant.type == Value::Type::field) return call_field(tree, expr, call, constant, scope);
    }
    for (const auto& argument : tree.arguments(call))
      check(tree, argument.value, scope);  // they have errors of their own
    return unknown_function(call, scope);
  }
  const OpenFrame open(*this);
  std::vector<Actual>& actuals = (*open).actuals;
  if (!bind_arguments(tree, call, builtin->formals, scope, actuals)) return failed(span);
  for (std::size_t i = 0; i < builtin->needed; ++i)
    if (!actuals[i].given)
      return report(Code::missing_argument, span,
                    fmt::format("`{}` needs its argument `{}`", call.callee.text, builtin->formals[i]), "",
                    fmt::format("it takes: {}", fmt::join(builtin->formals, ", ")));
  for (const auto& actual : actuals)
    if (actual.given && actual.value.type == Value::Type::open)
      return report(Code::wrong_type, actual.span, "`open` is the default of a function's argument, not a value", "",
                    "leave the argument out");
  if (builtin->of_places && !scope.hand)
    return report(Code::not_constant, span,
                  fmt::format("`{}` is of places on a patch, and a constant is due here", builtin->name), "",
                  "use it in a material's physical block");
  return builtin->apply(BuiltinFunctions{*this, actuals, span});
}

Value ExpressionChecker::unknown_function(const Call& call, Scope& scope) {
  const std::string_view name = call.callee.text;
  if (scope.find(name) || declarations_->constants.contains(name) || names_hand_or_patch(name))
    return report(Code::wrong_type, call.callee.span, fmt::format("`{}` is no function", name), "",
                  fmt::format("to multiply, write `{} * (…)`", name));
  if (const auto hidden = private_name(call.callee)) return *hidden;
  return report(
      Code::unknown_name, call.callee.span, fmt::format("no function is called `{}`", name), "",
      spelling_mend(call.callee, nullptr, true, "schema/LANGUAGE.md lists them; `function name(…) = …` declares one"));
}

bool ExpressionChecker::may_expand(std::string_view name, Span callee, Span span) {
  if (std::ranges::find(callees_, Callee{name}) != callees_.end()) {
    report(Code::recursive_definition, callee, fmt::format("`{}` would call itself", name), "",
           "functions are written out where they are called, so none may lead back to itself");
    return false;
  }
  if (callees_.size() >= deepest_call) {
    report(Code::nested_too_deep, callee,
           fmt::format("more than {} definitions lead to one another here", deepest_call), "",
           "write some of them out");
    return false;
  }
  if (terms_.size() <= most_terms) return true;
  if (!std::exchange(too_large_, true))
    surroundings_.diagnostics.report(
        {.code = Code::program_too_large,
         .span = call_sites_.empty() ? span : call_sites_.front(),
         .message = fmt::format("written out, this comes to more than {} operations", most_terms),
         .help = "functions are written out at every call; let them call each other less often"});
  return false;
}

Value ExpressionChecker::call_function(const SyntaxTree& tree, ExprId expr, const Call& call,
                                       const Declared<FunctionDecl>& function, Scope& scope) {
  const Span span = tree.span(expr);
  if (!may_expand(call.callee.text, call.callee.span, span)) return failed(span);
  const auto& parameters = function.node->parameters;
  const OpenFrame open(*this);
  Frame& frame = *open;
  const auto& actuals = frame.actuals;
  const Formals formals = parameters;
  const bool bound = bind_arguments(tree, call, formals, scope, frame.actuals);
  bool good = bound;
  for (std::size_t i = 0; i < formals.size(); ++i) {
    if (!actuals[i].given && !parameters[i].default_value && bound) {
      report(Code::missing_argument, span, fmt::format("`{}` needs its argument `{}`", call.callee.text, formals[i]),
             "", fmt::format("it takes: {}", fmt::join(formals.spellings(), ", ")));
      good = false;
    }
    const auto dimension = dimension_of(parameters[i], *function.home);
    const Value& value = actuals[i].value;
    const bool measurable = value.type == Value::Type::number || value.type == Value::Type::vector;
    if (!actuals[i].given || !dimension || !measurable || value.dimension == *dimension) continue;
    for (const auto& argument : tree.arguments(call))
      if (tree.span(argument.value) == actuals[i].span)
        report_dimension(tree, argument.value, scope, value, *dimension);
    good = false;
  }
  if (!good) return failed(span);
  return expanded(function, frame, scope, span);
}

std::optional<Dimension> ExpressionChecker::dimension_of(const FormalParameter& formal,
                                                         const Declarations& home) const {
  const auto* known = formal.dimension ? home.dimensions.find(formal.dimension->text) : nullptr;
  return known ? std::optional(*known) : std::nullopt;
}

Value ExpressionChecker::call_with(const Declared<FunctionDecl>& function, std::vector<Actual> actuals,
                                   const Scope& scope, Span span) {
  const OpenFrame open(*this);
  (*open).actuals = std::move(actuals);
  (*open).actuals.resize(function.node->parameters.size());
  return expanded(function, *open, scope, span);
}

/// The function's body with the frame's actual arguments; gives those that are missing their defaults.
Value ExpressionChecker::expanded(const Declared<FunctionDecl>& function, Frame& frame, const Scope& scope, Span span) {
  const auto& declaration = *function.node;
  bool good = true;
  const auto* outside_names = std::exchange(declarations_, function.home);
  for (std::size_t i = 0; i < frame.actuals.size(); ++i) {
    const auto& formal = declaration.parameters[i];
    Value& value = frame.actuals[i].value;
    if (!frame.actuals[i].given) {
      Scope defaults;
      defaults.hand = scope.hand;
      value = check(*function.tree, *formal.default_value, defaults);
      value.span = span;
    }
    if (value.type == Value::Type::open) {
      value = {.type = Value::Type::number,
               .x = terms_.add(
                   {.kind = TermKind::open, .index = static_cast<std::uint32_t>(open_spans_.size()), .span = span}),
               .dimension = dimension_of(formal, *function.home).value_or(Dimension{}),
               .span = span};
      open_spans_.push_back(blame(span));
    }
    if (formal.name.text == "period" && value.type == Value::Type::number &&
        value.dimension == declarations_->dimension("length"))
      periods_.push_back({value.x, blame(frame.actuals[i].given ? frame.actuals[i].span : span)});
    good = good && !value.failed();
  }
  Value result = failed(span);
  if (good) {
    enter_call(span);
    callees_.push_back({declaration.name.text});
    deepest_ = std::max(deepest_, callees_.size());
    result = body(function, frame, scope.hand);
    leave_call();
    callees_.pop_back();
  }
  declarations_ = outside_names;
  result.span = span;
  if (!result.failed()) record_carrier(declaration, frame.actuals, result, span);
  return result;
}

void ExpressionChecker::record_carrier(const FunctionDecl& function, const std::vector<Actual>& actuals,
                                       const Value& result, Span span) {
  if (result.type != Value::Type::vector) return;
  const auto actual = [&](std::string_view name) -> const Value* {
    for (std::size_t i = actuals.size(); i-- > 0;)  // of two formals with one name, which is an error, the last
      if (function.parameters[i].name.text == name) return &actuals[i].value;
    return nullptr;
  };
  // A function with an argument that may be left open renders a percept: that argument is the carrier's size.
  for (const auto& formal : function.parameters) {
    if (!formal.default_value) continue;
    const std::string_view words[] = {function.name.text, formal.name.text};
    const auto is_carrier = [&](std::string_view carrier) {
      return carrier.size() == words[0].size() + 1 + words[1].size() && carrier.starts_with(words[0]) &&
             carrier[words[0].size()] == ' ' && carrier.ends_with(words[1]);
    };
    bool renders = false;
    surroundings_.declarations.percepts.each(
        [&](const std::string&, const Percept& percept) { renders = renders || is_carrier(percept.carrier); });
    if (!renders) continue;
    const Value& size = *actual(formal.name.text);
    Carrier carrier{.name = fmt::format("{} {}", words[0], words[1]),
                    .size = size.x,
                    .open = terms_[size.x].kind == TermKind::open,
                    .dimension = size.dimension,
                    .force_x = result.x,
                    .force_y = result.y,
                    .relief = {},
                    .span = blame(span),
                    .size_span = blame(size.span)};
    ask_of(size.x);
    const Value* height = actual("height");
    if (height) ask_of(height->x);
    if (const auto fixed = carrier.open ? std::nullopt : constant_value(terms_, size.x); fixed && *fixed < 0) {
      if (!height) continue;  // what pushes along with the motion, or away, is nothing that a percept tells of
      report(Code::value_out_of_range, span, fmt::format("`{}` is less than nothing", formal.name.text), "",
             "give its size; to push the other way, turn the height around with a minus");
      continue;
    }
    if (height && !terms_.dependence(height->x).on(Dependence::position)) {
      report(Code::flat_height, span, "this height is the same everywhere, and a flat height pushes nothing", "",
             "let it change with `x` or `y`, as in `grating(x, period: 2.5 mm)`");
      continue;
    }
    if (height) {
      carrier.relief = height->x;
      carrier.relief_dimension = height->dimension;
    }
    carriers_.push_back(std::move(carrier));
  }
}

}  // namespace wale
