#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/check_expression.hpp"
#include "compiler/image.hpp"
#include "compiler/spelling.hpp"

namespace wale {

namespace {

/// A material that needs more terms than this is far beyond what a patch program holds.
constexpr std::size_t most_terms = std::size_t{1} << 18;

/// A function of the compiler's own: its name, its arguments, how many of them are needed.
struct Builtin {
  std::string_view name;
  std::vector<std::string> formals;
  std::size_t needed;
};

const std::vector<Builtin>& builtins() {
  static const std::vector<Builtin> table{
      {"abs", {"value"}, 1},
      {"floor", {"value"}, 1},
      {"sqrt", {"value"}, 1},
      {"sin", {"angle"}, 1},
      {"cos", {"angle"}, 1},
      {"exp", {"value"}, 1},
      {"log", {"value"}, 1},
      {"log2", {"value"}, 1},
      {"log10", {"value"}, 1},
      {"normal", {"value"}, 1},
      {"min", {"a", "b"}, 2},
      {"max", {"a", "b"}, 2},
      {"vector", {"x", "y"}, 2},
      {"length", {"vector"}, 1},
      {"dot", {"a", "b"}, 2},
      {"within", {"value", "low", "high"}, 3},
      {"grad", {"height"}, 1},
      {"peak", {"value"}, 1},
      {"hold", {"value", "ceiling"}, 2},
      {"image", {"file", "scale", "height", "smooth"}, 3},
  };
  return table;
}

constexpr double log2_e = 1.4426950408889634, log10_2 = 0.30102999566398120, ln_2 = 0.69314718055994531;

}  // namespace

bool is_builtin_function(const std::string& name) {
  return std::ranges::find(builtins(), name, &Builtin::name) != builtins().end();
}

/// The meaning of each function that the compiler knows; a member a function, so that each reads on its own.
struct BuiltinFunctions {
  using Actual = ExpressionChecker::Actual;
  ExpressionChecker& checker;
  const std::vector<Actual>& actuals;
  Span span;

  Terms& terms() const { return checker.terms_; }
  const Value& value(std::size_t i) const { return actuals[i].value; }

  bool number(std::size_t i) const {
    if (value(i).type == Value::Type::number) return true;
    checker.report(Code::wrong_type, actuals[i].span,
                   fmt::format("a number is due here, not {}", type_words(value(i).type)), "",
                   value(i).type == Value::Type::vector ? "take its `length(…)`, or work with `x` and `y`"
                                                        : "give a number, with its unit if it has one");
    return false;
  }
  bool plain(std::size_t i) const {
    if (!number(i)) return false;
    if (value(i).dimension.plain()) return true;
    const auto& dimension = value(i).dimension;
    checker.report(Code::wrong_dimension, actuals[i].span,
                   fmt::format("a plain number is due here, not {}", checker.names().words(dimension)),
                   checker.names().unit(dimension),
                   fmt::format("divide it by a quantity of its own dimension, such as `/ 1 {}`",
                               customary_unit(checker.surroundings_.declarations, dimension)));
    return false;
  }
  Value failed() const { return checker.failed(span); }
  Value scalar(TermId x, Dimension dimension = {}) const {
    return {.type = Value::Type::number, .x = x, .dimension = dimension, .span = span};
  }
  TermId scaled(TermId x, double factor) const {
    return terms().apply(Operation::multiply, x, terms().literal(factor, span), span);
  }

  Value of_plain(Operation operation, double before = 1, double after = 1) const {
    if (!plain(0)) return failed();
    TermId x = before == 1 ? value(0).x : scaled(value(0).x, before);
    x = terms().apply(operation, x, span);
    return scalar(after == 1 ? x : scaled(x, after));
  }

  Value absolute() const {
    if (!number(0)) return failed();
    return scalar(terms().apply(Operation::absolute, value(0).x, span), value(0).dimension);
  }

  Value square_root() const {
    if (!number(0)) return failed();
    const auto root = power(value(0).dimension, 1, 2);
    if (!root)
      return checker.report(Code::wrong_dimension, actuals[0].span,
                            fmt::format("the root of {} has no dimension", checker.names().words(value(0).dimension)),
                            "", "divide it by a quantity of its own dimension first");
    return scalar(terms().apply(Operation::square_root, value(0).x, span), *root);
  }

  Value extreme(Operation operation) const {
    if (!number(0) || !number(1)) return failed();
    if (value(0).dimension != value(1).dimension) return mismatched(0, 1);
    return scalar(terms().apply(operation, value(0).x, value(1).x, span), value(0).dimension);
  }

  Value mismatched(std::size_t a, std::size_t b) const {
    const auto sides = checker.names().side_by_side(value(a).dimension, value(b).dimension);
    checker.surroundings_.diagnostics.report(
        {.code = Code::mismatched_dimensions,
         .span = checker.blame(actuals[b].span),
         .message = fmt::format("{} expected, found {}{}", checker.names().words(value(a).dimension),
                                checker.names().words(value(b).dimension), checker.inside(actuals[b].span)),
         .label = checker.names().unit_beside(value(a).dimension, value(b).dimension),
         .expected = sides[0],
         .found = sides[1],
         .help = "the arguments must have one dimension"});
    return failed();
  }

  Value vector() const {
    if (!number(0) || !number(1)) return failed();
    if (value(0).dimension != value(1).dimension) return mismatched(0, 1);
    return {
        .type = Value::Type::vector, .x = value(0).x, .y = value(1).x, .dimension = value(0).dimension, .span = span};
  }

  bool is_vector(std::size_t i) const {
    if (value(i).type == Value::Type::vector) return true;
    checker.report(Code::wrong_type, actuals[i].span,
                   fmt::format("a vector is due here, not {}", type_words(value(i).type)), "",
                   "give both parts, as in `vector(a, b)`");
    return false;
  }

  TermId dot_product(const Value& a, const Value& b) const {
    return terms().apply(Operation::add, terms().apply(Operation::multiply, a.x, b.x, span),
                         terms().apply(Operation::multiply, a.y, b.y, span), span);
  }

  Value dot() const {
    if (!is_vector(0) || !is_vector(1)) return failed();
    return scalar(dot_product(value(0), value(1)), value(0).dimension * value(1).dimension);
  }

  Value length() const {
    if (!is_vector(0)) return failed();
    return scalar(terms().apply(Operation::square_root, dot_product(value(0), value(0)), span), value(0).dimension);
  }

  /// A number held between two constants; a constant outside them is an error.
  Value within() const {
    if (!number(0) || !number(1) || !number(2)) return failed();
    for (const std::size_t bound : {1, 2})
      if (value(bound).dimension != value(0).dimension) return mismatched(bound, 0);
    const auto known = constant_value(terms(), value(0).x);
    const auto low = constant_value(terms(), value(1).x), high = constant_value(terms(), value(2).x);
    if (known && low && high && !(*known >= *low && *known <= *high)) {
      const std::string unit = checker.names().unit(value(0).dimension);
      const std::string suffix = unit.empty() ? "" : " " + unit;
      return checker.report(Code::value_out_of_range, terms()[value(0).x].span,
                            fmt::format("{:.4g}{} is out of range", *known, suffix), "",
                            fmt::format("give a value from {:.4g}{} to {:.4g}{}", *low, suffix, *high, suffix));
    }
    return scalar(terms().apply(Operation::maximum, terms().apply(Operation::minimum, value(0).x, value(2).x, span),
                                value(1).x, span),
                  value(0).dimension);
  }

  Value gradient() const {
    if (!number(0)) return failed();
    const auto along = [&](std::uint32_t axis) {
      return terms().add({.kind = TermKind::gradient, .a = value(0).x, .index = axis, .span = span});
    };
    const auto length_dimension = checker.surroundings_.declarations.dimension("length");
    return {.type = Value::Type::vector,
            .x = along(0),
            .y = along(1),
            .dimension = value(0).dimension / length_dimension,
            .span = span};
  }

  Value peak() const {
    if (!number(0)) return failed();
    if (terms().dependence(value(0).x).velocity)
      return checker.report(Code::wrong_rate, actuals[0].span,
                            "a peak is taken over places, and this changes with velocity", "",
                            "let the height depend on `x` and `y` only");
    return scalar(terms().add({.kind = TermKind::peak, .a = value(0).x, .span = span}), value(0).dimension);
  }

  /// A force held at a ceiling: a vector by its length, then each part again, which is exact whatever the rounding.
  Value hold() const {
    if (!number(1)) return failed();
    if (value(0).dimension != value(1).dimension) return mismatched(1, 0);
    const TermId ceiling = value(1).x;
    Value result{.type = value(0).type, .dimension = value(0).dimension, .span = span};
    if (value(0).type == Value::Type::number) {
      result.x = terms().apply(Operation::limit, value(0).x, ceiling, span);
      return result;
    }
    if (!is_vector(0)) return failed();
    const TermId size = terms().apply(Operation::square_root, dot_product(value(0), value(0)), span);
    const TermId factor = terms().apply(Operation::minimum, terms().literal(1, span),
                                        terms().apply(Operation::divide, ceiling, size, span), span);
    result.x =
        terms().apply(Operation::limit, terms().apply(Operation::multiply, value(0).x, factor, span), ceiling, span);
    result.y =
        terms().apply(Operation::limit, terms().apply(Operation::multiply, value(0).y, factor, span), ceiling, span);
    return result;
  }

  std::optional<double> constant_argument(std::size_t i, const Dimension& dimension, const char* example) const {
    if (!number(i)) return std::nullopt;
    if (value(i).dimension != dimension) {
      const auto sides = checker.names().side_by_side(dimension, value(i).dimension);
      checker.surroundings_.diagnostics.report(
          {.code = Code::wrong_dimension,
           .span = checker.blame(actuals[i].span),
           .message = fmt::format("{} expected, found {}", checker.names().words(dimension),
                                  checker.names().words(value(i).dimension)),
           .label = checker.names().unit_beside(dimension, value(i).dimension),
           .expected = sides[0],
           .found = sides[1],
           .help = fmt::format("write something like `{}`", example)});
      return std::nullopt;
    }
    const auto known = constant_value(terms(), value(i).x);
    if (!known)
      checker.report(Code::not_constant, actuals[i].span, "a value known at compile time is due here", "it may change",
                     "use numbers, units and constants; no parameters and no places");
    return known;
  }

  /// A sampled height map, centred on the patch, mirrored at its edges; its top row lies at the largest y.
  Value image() const {
    const auto& declarations = checker.surroundings_.declarations;
    if (value(0).type != Value::Type::text)
      return checker.report(Code::wrong_type, actuals[0].span,
                            fmt::format("the name of a file is due here, not {}", type_words(value(0).type)), "",
                            "write it in quotes, as in `image(\"slate.tif\", …)`");
    const auto scale = constant_argument(1, declarations.dimension("scale"), "0.1 mm/px");
    const auto height = constant_argument(2, declarations.dimension("length"), "0.8 mm");
    const auto smooth = actuals[3].given ? constant_argument(3, declarations.dimension("length"), "0.2 mm")
                                         : std::optional<double>(0.0);
    if (!scale || !height || !smooth) return failed();
    if (!(*scale > 0))
      return checker.report(Code::value_out_of_range, actuals[1].span, "the scale must be more than nothing", "",
                            "write something like `0.1 mm/px`");
    if (!(*smooth >= 0))
      return checker.report(Code::value_out_of_range, actuals[3].span, "smoothing cannot be negative", "",
                            "write something like `0.2 mm`");
    if (!checker.surroundings_.resolver)
      return checker.report(Code::not_constant, span, "no image can be read here", "",
                            "use images in a material's physical block");

    const Source& source = checker.surroundings_.sources[span.source];
    auto resolved = checker.surroundings_.resolver->file(value(0).text, source.name);
    if (const auto* problem = std::get_if<ResolveProblem>(&resolved))
      return checker.report(Code::unreadable_file, actuals[0].span,
                            fmt::format("`{}` cannot be read: {}", value(0).text, problem->reason), "",
                            "give the path from the folder of this file");
    const auto& file = std::get<ResolvedFile>(resolved);
    auto read = read_height_image(std::as_bytes(std::span(file.bytes)), file.name, *smooth / *scale);
    if (const auto* problem = std::get_if<ImageProblem>(&read))
      return checker.report(problem->size ? Code::image_size : Code::unreadable_image, actuals[0].span,
                            fmt::format("`{}` {}", value(0).text, problem->reason), "",
                            problem->size
                                ? fmt::format("give it at least {0} x {0} pixels, and at most {1} million in all",
                                              smallest_image_side, most_image_pixels / 1'000'000)
                                : "save it as PNG, TIFF, JPEG or EXR");
    auto& picture = std::get<HeightImage>(read);

    const double column = *scale * picture.pixels_per_column, row = *scale * picture.pixels_per_row;
    const TermId centre_u = terms().literal((picture.table.width - 1) / 2.0, span);
    const TermId centre_v = terms().literal((picture.table.height - 1) / 2.0, span);
    const TermId u = terms().apply(Operation::add, scaled(terms().input(Input::x, span), 1 / column), centre_u, span);
    const TermId v = terms().apply(Operation::subtract, centre_v, scaled(terms().input(Input::y, span), 1 / row), span);
    const auto existing = std::ranges::find(checker.tables_, picture.table);
    const auto table = static_cast<std::uint32_t>(existing - checker.tables_.begin());
    if (existing == checker.tables_.end()) checker.tables_.push_back(std::move(picture.table));
    const TermId sampled = terms().add(
        {.kind = TermKind::operation, .operation = Operation::sample, .a = u, .b = v, .index = table, .span = span});
    const TermId code = terms().add({.kind = TermKind::component, .a = sampled, .index = 0, .span = span});
    return scalar(scaled(code, *height), declarations.dimension("length"));
  }

  Value dispatch(std::string_view name) const {
    if (name == "abs") return absolute();
    if (name == "sqrt") return square_root();
    if (name == "floor") return of_plain(Operation::floor);
    if (name == "sin") return of_plain(Operation::sine);
    if (name == "cos") return of_plain(Operation::cosine);
    if (name == "exp") return of_plain(Operation::exp2, log2_e);
    if (name == "log") return of_plain(Operation::log2, 1, ln_2);
    if (name == "log2") return of_plain(Operation::log2);
    if (name == "log10") return of_plain(Operation::log2, 1, log10_2);
    if (name == "normal") return of_plain(Operation::normal);
    if (name == "min") return extreme(Operation::minimum);
    if (name == "max") return extreme(Operation::maximum);
    if (name == "vector") return vector();
    if (name == "length") return length();
    if (name == "dot") return dot();
    if (name == "within") return within();
    if (name == "grad") return gradient();
    if (name == "peak") return peak();
    if (name == "hold") return hold();
    return image();
  }
};

std::optional<std::string> ExpressionChecker::spelling_help(const std::string& word, const Scope* scope,
                                                            bool functions) const {
  std::vector<std::string> candidates;
  if (functions) {
    for (const auto& [name, declared] : surroundings_.declarations.functions) candidates.push_back(name);
    for (const auto& builtin : builtins()) candidates.emplace_back(builtin.name);
  } else {
    if (scope)
      for (const auto& [name, binding] : scope->names) candidates.push_back(name);
    if (scope && scope->hand) candidates.insert(candidates.end(), {"hand", "velocity"});
    for (const auto& [name, declared] : surroundings_.declarations.constants) candidates.push_back(name);
  }
  const auto near = nearest_spelling(word, candidates);
  if (!near) return std::nullopt;
  return fmt::format("did you mean `{}`?", *near);
}

bool ExpressionChecker::bind_arguments(const SyntaxTree& tree, const Call& call,
                                       const std::vector<std::string>& formals, Scope& scope,
                                       std::vector<Actual>& actuals) {
  actuals.assign(formals.size(), {});
  bool good = true;
  std::size_t position = 0;
  for (const auto& argument : call.arguments) {
    const Span span = tree.span(argument.value);
    const Value value = check(tree, argument.value, scope);
    std::size_t index = position;
    if (argument.name) {
      index = static_cast<std::size_t>(std::ranges::find(formals, argument.name->text) - formals.begin());
      if (index == formals.size()) {
        const auto near = nearest_spelling(argument.name->text, formals);
        report(Code::unknown_argument, argument.name->span,
               fmt::format("`{}` takes no argument `{}`", call.callee.text, argument.name->text), "",
               near ? fmt::format("did you mean `{}`?", *near) : fmt::format("it takes: {}", fmt::join(formals, ", ")));
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
               formals.empty() ? "write it without arguments" : fmt::format("it takes: {}", fmt::join(formals, ", ")));
        good = false;
        continue;
      }
    }
    if (actuals[index].given) {
      report(Code::declared_twice, span, fmt::format("the argument `{}` is given twice", formals[index]), "",
             "give it once");
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
  const auto& functions = surroundings_.declarations.functions;
  if (const auto found = functions.find(call.callee.text); found != functions.end())
    return call_function(tree, expr, call, found->second, scope);
  const auto builtin = std::ranges::find(builtins(), call.callee.text, &Builtin::name);
  if (builtin == builtins().end()) {
    for (const auto& argument : call.arguments) check(tree, argument.value, scope);  // they have errors of their own
    return report(Code::unknown_name, call.callee.span, fmt::format("no function is called `{}`", call.callee.text), "",
                  spelling_help(call.callee.text, nullptr, true)
                      .value_or("schema/LANGUAGE.md lists them; `function name(…) = …` declares one"));
  }
  std::vector<Actual> actuals;
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
  if ((builtin->name == "grad" || builtin->name == "peak" || builtin->name == "image") && !scope.hand)
    return report(Code::not_constant, span,
                  fmt::format("`{}` is of places on a patch, and a constant is due here", builtin->name), "",
                  "use it in a material's physical block");
  return BuiltinFunctions{*this, actuals, span}.dispatch(builtin->name);
}

Value ExpressionChecker::call_function(const SyntaxTree& tree, ExprId expr, const Call& call,
                                       const Declared<FunctionDecl>& function, Scope& scope) {
  const Span span = tree.span(expr);
  const auto& declaration = *function.node;
  if (std::ranges::find(callees_, call.callee.text) != callees_.end())
    return report(Code::recursive_definition, call.callee.span, fmt::format("`{}` would call itself", call.callee.text),
                  "", "functions are written out where they are called, so none may lead back to itself");
  if (callees_.size() >= deepest_call)
    return report(Code::nested_too_deep, call.callee.span,
                  fmt::format("more than {} definitions lead to one another here", deepest_call), "",
                  "write some of them out");
  if (terms_.size() > most_terms) {
    if (!std::exchange(too_large_, true))
      surroundings_.diagnostics.report(
          {.code = Code::program_too_large,
           .span = call_sites_.empty() ? span : call_sites_.front(),
           .message = fmt::format("written out, this comes to more than {} operations", most_terms),
           .help = "functions are written out at every call; let them call each other less often"});
    return failed(span);
  }
  std::vector<std::string> formals;
  for (const auto& parameter : declaration.parameters) formals.push_back(parameter.name.text);
  std::vector<Actual> actuals;
  const bool bound = bind_arguments(tree, call, formals, scope, actuals);

  Scope inner;
  inner.hand = scope.hand;
  bool good = bound;
  for (std::size_t i = 0; i < formals.size(); ++i) {
    const auto& formal = declaration.parameters[i];
    if (!actuals[i].given && !formal.default_value) {
      if (bound)
        report(Code::missing_argument, span, fmt::format("`{}` needs its argument `{}`", call.callee.text, formals[i]),
               "", fmt::format("it takes: {}", fmt::join(formals, ", ")));
      good = false;
      continue;
    }
    std::optional<Dimension> dimension;
    if (formal.dimension)
      if (const auto known = surroundings_.declarations.dimensions.find(formal.dimension->text);
          known != surroundings_.declarations.dimensions.end())
        dimension = known->second;
    Value value = actuals[i].value;
    if (!actuals[i].given) {
      Scope defaults;
      defaults.hand = inner.hand;
      value = check(*function.tree, *formal.default_value, defaults);
      value.span = span;
    }
    if (value.type == Value::Type::open && good) {
      value = {.type = Value::Type::number,
               .x = terms_.add(
                   {.kind = TermKind::open, .index = static_cast<std::uint32_t>(open_spans_.size()), .span = span}),
               .dimension = dimension.value_or(Dimension{}),
               .span = span};
      open_spans_.push_back(blame(span));
    }
    const bool measurable = value.type == Value::Type::number || value.type == Value::Type::vector;
    if (dimension && measurable && value.dimension != *dimension) {
      for (std::size_t a = 0; a < call.arguments.size(); ++a)
        if (tree.span(call.arguments[a].value) == actuals[i].span)
          report_dimension(tree, call.arguments[a].value, scope, value, *dimension);
      good = false;
    }
    inner.names[formals[i]] = {.value = value, .declared = formal.name.span};
    good = good && !value.failed();
  }
  if (!good) return failed(span);

  call_sites_.push_back(span);
  callees_.push_back(call.callee.text);
  Value result = check(*function.tree, declaration.body, inner);
  call_sites_.pop_back();
  callees_.pop_back();
  if (!result.failed()) record_carrier(call, declaration, inner, result, span);
  return result;
}

void ExpressionChecker::record_carrier(const Call& call, const FunctionDecl& function, Scope& formals,
                                       const Value& result, Span span) {
  // A function with an argument that may be left open renders a percept: that argument is the carrier's size.
  for (const auto& formal : function.parameters) {
    if (!formal.default_value || result.type != Value::Type::vector) continue;
    const Value& size = formals.names.at(formal.name.text).value;
    const auto& carriers = surroundings_.declarations.percepts;
    const std::string name = call.callee.text + " " + formal.name.text;
    const bool renders = std::ranges::any_of(carriers, [&](const auto& entry) { return entry.second.carrier == name; });
    if (!renders) continue;
    Carrier carrier{.name = name,
                    .size = size.x,
                    .open = terms_[size.x].kind == TermKind::open,
                    .dimension = size.dimension,
                    .force_x = result.x,
                    .force_y = result.y,
                    .relief = {},
                    .span = blame(span)};
    if (const auto fixed = carrier.open ? std::nullopt : constant_value(terms_, size.x); fixed && *fixed < 0) {
      report(Code::value_out_of_range, span, fmt::format("`{}` is less than nothing", formal.name.text), "",
             "give its size; to push the other way, turn the height around with a minus");
      continue;
    }
    if (const auto* height = formals.find("height"); height && !terms_.dependence(height->value.x).position) {
      report(Code::flat_height, span, "this height is the same everywhere, and a flat height pushes nothing", "",
             "let it change with `x` or `y`, as in `grating(x, period: 2.5 mm)`");
      continue;
    }
    if (const auto* height = formals.find("height")) carrier.relief = height->value.x;
    carriers_.push_back(carrier);
  }
}

}  // namespace wale
