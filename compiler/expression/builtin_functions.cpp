#include "compiler/expression/builtin_functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "compiler/expression/plain_number_mend.hpp"
#include "compiler/text/characters.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

bool BuiltinCall::number(std::size_t i) const {
  if (value(i).type == Value::Type::number) return true;
  reading.calls.report(Code::wrong_type, actuals[i].span,
                       fmt::format("expected a number, found {}", type_words(value(i).type)), "",
                       value(i).type == Value::Type::vector ? "take its `length(…)`, or work with `x` and `y`"
                                                            : "give a number, with its unit if it has one");
  return false;
}
bool BuiltinCall::plain(std::size_t i) const {
  if (!number(i)) return false;
  if (value(i).dimension.plain()) return true;
  const auto& dimension = value(i).dimension;
  std::optional<Advice> mend;
  for (const Argument& argument : tree.arguments(call))
    if (tree.span(argument.value) == actuals[i].span)
      mend = quotient_mend(reading, tree, argument.value, scope, dimension);
  reading.calls.report(Code::wrong_dimension, actuals[i].span,
                       fmt::format("expected a plain number, found {}", reading.dimension_names().words(dimension)),
                       reading.dimension_names().unit(dimension),
                       mend ? *std::move(mend)
                            : Advice(fmt::format("divide it by a quantity of its own dimension, such as `/ 1 {}`",
                                                 customary_unit(*reading.names, dimension))));
  return false;
}

Value BuiltinCall::mismatched(std::size_t a, std::size_t b) const {
  // The number without a unit is the one that lacks it, wherever it stands.
  if (value(a).dimension.plain() && !value(b).dimension.plain()) std::swap(a, b);
  const auto known = value(b).type == Value::Type::number && value(b).dimension.plain()
                         ? constant_value(terms(), value(b).x)
                         : std::nullopt;
  const bool zero = known == 0.0;
  const std::string unit = customary_unit(*reading.names, value(a).dimension);
  const std::string_view text = reading.surroundings.sources.text(actuals[b].span);
  const auto sides = reading.dimension_names().side_by_side(value(a).dimension, value(b).dimension);
  const Dimension mass = reading.names->dimension("mass"), force = reading.names->dimension("force");
  const bool weighs = (value(a).dimension == mass && value(b).dimension == force) ||
                      (value(a).dimension == force && value(b).dimension == mass);
  reading.calls.say(
      {.code = Code::mismatched_dimensions,
       .span = actuals[b].span,
       .message = fmt::format("expected {}, found {}", reading.dimension_names().words(value(a).dimension),
                              reading.dimension_names().words(value(b).dimension)),
       .label = reading.dimension_names().unit_beside(value(a).dimension, value(b).dimension),
       .expected = sides[0],
       .found = sides[1],
       .help =
           weighs ? "a mass is no force: on earth 100 g weigh 0.98 N"
           : zero  ? fmt::format("zero has a unit too: write `0 {}`", unit)
           : known ? fmt::format("a plain number needs its unit: write `{} {}`", text, unit)
           : value(b).dimension.plain() ? fmt::format("give it a unit: write `0.5 {} * {}`", unit, as_factor(text))
                                        : "the arguments must have the same dimension"});
  return failed();
}

bool BuiltinCall::is_vector(std::size_t i) const {
  if (value(i).type == Value::Type::vector) return true;
  reading.calls.report(Code::wrong_type, actuals[i].span,
                       fmt::format("expected a vector, found {}", type_words(value(i).type)), "",
                       "give both parts, as in `vector(a, b)`");
  return false;
}

std::optional<double> BuiltinCall::constant_argument(std::size_t i, const Dimension& dimension,
                                                     const char* example) const {
  if (!number(i)) return std::nullopt;
  if (value(i).dimension != dimension) {
    const auto sides = reading.dimension_names().side_by_side(dimension, value(i).dimension);
    reading.calls.say({.code = Code::wrong_dimension,
                       .span = actuals[i].span,
                       .message = fmt::format("expected {}, found {}", reading.dimension_names().words(dimension),
                                              reading.dimension_names().words(value(i).dimension)),
                       .label = reading.dimension_names().unit_beside(dimension, value(i).dimension),
                       .expected = sides[0],
                       .found = sides[1],
                       .help = fmt::format("write something like `{}`", example)});
    return std::nullopt;
  }
  const auto known = constant_value(terms(), value(i).x);
  if (!known)
    reading.calls.report(Code::not_constant, actuals[i].span, "expected a value known at compile time", "it may change",
                         "use numbers, units and constants, but no parameters and no places");
  return known;
}

bool BuiltinCall::text(std::size_t i, const char* example) const {
  if (value(i).type == Value::Type::text) return true;
  reading.calls.report(Code::wrong_type, actuals[i].span,
                       fmt::format("expected a text, found {}", type_words(value(i).type)), "",
                       fmt::format("write it in quotes, as in `{}`", example));
  return false;
}

namespace {

constexpr double log2_e = 1.4426950408889634, log10_2 = 0.30102999566398120, ln_2 = 0.69314718055994531;

TermId scaled(const BuiltinCall& call, TermId x, double factor) {
  return call.terms().apply(Operation::multiply, x, call.terms().literal(factor, call.span), call.span);
}

Value of_plain(const BuiltinCall& call, Operation operation, double before = 1, double after = 1) {
  if (!call.plain(0)) return call.failed();
  TermId x = before == 1 ? call.value(0).x : scaled(call, call.value(0).x, before);
  x = call.terms().apply(operation, x, call.span);
  return call.scalar(after == 1 ? x : scaled(call, x, after));
}

/// Keeps what a function of no negative numbers is taken of, for a warning.
void keep_operand(const BuiltinCall& call, const char* words) {
  call.reading.record.operands.push_back({call.value(0).x, words, call.reading.calls.blame(call.actuals[0].span)});
}

Value logarithm(const BuiltinCall& call, double after) {
  const Value result = of_plain(call, Operation::log2, 1, after);
  if (!result.failed()) keep_operand(call, "the logarithm");
  return result;
}

Value absolute(const BuiltinCall& call) {
  if (!call.number(0)) return call.failed();
  return call.scalar(call.terms().apply(Operation::absolute, call.value(0).x, call.span), call.value(0).dimension);
}

Value square_root(const BuiltinCall& call) {
  if (!call.number(0)) return call.failed();
  const auto root = power(call.value(0).dimension, 1, 2);
  if (!root)
    return call.reading.calls.report(
        Code::wrong_dimension, call.actuals[0].span,
        fmt::format("the root of {} has no dimension", call.reading.dimension_names().words(call.value(0).dimension)),
        "", "divide it by a quantity of its own dimension first");
  keep_operand(call, "the root");
  return call.scalar(call.terms().apply(Operation::square_root, call.value(0).x, call.span), *root);
}

Value extreme(const BuiltinCall& call, Operation operation) {
  if (!call.number(0) || !call.number(1)) return call.failed();
  if (call.value(0).dimension != call.value(1).dimension) return call.mismatched(0, 1);
  return call.scalar(call.terms().apply(operation, call.value(0).x, call.value(1).x, call.span),
                     call.value(0).dimension);
}

Value vector(const BuiltinCall& call) {
  if (!call.number(0) || !call.number(1)) return call.failed();
  if (call.value(0).dimension != call.value(1).dimension) return call.mismatched(0, 1);
  return {.type = Value::Type::vector,
          .x = call.value(0).x,
          .y = call.value(1).x,
          .dimension = call.value(0).dimension,
          .span = call.span};
}

TermId dot_product(const BuiltinCall& call, const Value& a, const Value& b) {
  return call.terms().apply(Operation::add, call.terms().apply(Operation::multiply, a.x, b.x, call.span),
                            call.terms().apply(Operation::multiply, a.y, b.y, call.span), call.span);
}

Value dot(const BuiltinCall& call) {
  if (!call.is_vector(0) || !call.is_vector(1)) return call.failed();
  return call.scalar(dot_product(call, call.value(0), call.value(1)),
                     call.value(0).dimension * call.value(1).dimension);
}

Value length(const BuiltinCall& call) {
  if (!call.is_vector(0)) return call.failed();
  return call.scalar(
      call.terms().apply(Operation::square_root, dot_product(call, call.value(0), call.value(0)), call.span),
      call.value(0).dimension);
}

/// `normalise(v)`: a vector's direction; zero for a very short vector. For lengths below about 1e-19 the squares flush
/// to zero in float32, so the computed length would be too small and the direction too long.
Value normalise(const BuiltinCall& call) {
  if (!call.is_vector(0)) return call.failed();
  constexpr double shortest = 1e-15;  // in SI units of any dimension
  const auto apply = [&](Operation operation, TermId a, TermId b) {
    return call.terms().apply(operation, a, b, call.span);
  };
  const TermId size =
      call.terms().apply(Operation::square_root, dot_product(call, call.value(0), call.value(0)), call.span);
  const TermId has_direction = apply(Operation::less, call.terms().literal(shortest, call.span), size);
  const auto share = [&](TermId part) {
    return call.terms().apply(Operation::select, has_direction, apply(Operation::divide, part, size),
                              call.terms().literal(0, call.span), call.span);
  };
  return {.type = Value::Type::vector, .x = share(call.value(0).x), .y = share(call.value(0).y), .span = call.span};
}

/// `within(…)`: a number limited to the range between two constants; a constant outside it is an error.
Value within(const BuiltinCall& call) {
  if (!call.number(0) || !call.number(1) || !call.number(2)) return call.failed();
  for (const std::size_t bound : {1, 2})
    if (call.value(bound).dimension != call.value(0).dimension) return call.mismatched(bound, 0);
  const auto known = constant_value(call.terms(), call.value(0).x);
  const auto low = constant_value(call.terms(), call.value(1).x), high = constant_value(call.terms(), call.value(2).x);
  if (known && low && high && !(*known >= *low && *known <= *high)) {
    const std::string unit = call.reading.dimension_names().unit(call.value(0).dimension);
    const std::string suffix = unit.empty() ? "" : " " + unit;
    // Inside a function the argument that it limits has the name that the author knows.
    const std::string_view text = call.reading.surroundings.sources.text(call.actuals[0].span);
    const bool is_name = !text.empty() && begins_name(text.front()) && std::ranges::all_of(text, continues_name);
    const double share = *known / 100;
    const bool percent = unit.empty() && *known > 1 && share >= *low && share <= *high;
    return call.reading.calls.report(
        Code::value_out_of_range, call.terms()[call.value(0).x].span,
        is_name ? readable("`{}` is {:.4g}{}, outside its range, {:.4g}{} .. {:.4g}{}", text, *known, suffix, *low,
                           suffix, *high, suffix)
                : readable("{:.4g}{} is out of range", *known, suffix),
        "",
        percent ? Advice(typeable("for {0:.4g} per cent write `{0:.4g} %`", *known))
                : Advice(readable("give a value from {:.4g}{} to {:.4g}{}", *low, suffix, *high, suffix)));
  }
  return call.scalar(
      call.terms().apply(Operation::maximum,
                         call.terms().apply(Operation::minimum, call.value(0).x, call.value(2).x, call.span),
                         call.value(1).x, call.span),
      call.value(0).dimension);
}

/// `usual(…)`: the value itself. `check_usage` warns if it is known and outside the range of the two others, the second
/// of which may be missing.
Value usual(const BuiltinCall& call) {
  const std::size_t given = call.actuals[2].given ? 3 : 2;
  for (std::size_t i = 0; i < given; ++i) {
    if (!call.number(i)) return call.failed();
    if (call.value(i).dimension != call.value(0).dimension) return call.mismatched(i, 0);
  }
  const auto low = constant_value(call.terms(), call.value(1).x);
  const auto high = given == 3 ? constant_value(call.terms(), call.value(2).x)
                               : std::optional(std::numeric_limits<double>::infinity());
  if (low && high)
    call.reading.record.usual.push_back(
        {.name = std::string(call.reading.surroundings.sources.text(call.actuals[0].span)),
         .value = call.value(0).x,
         .low = *low,
         .high = *high,
         .dimension = call.value(0).dimension,
         .span = call.reading.calls.blame(call.actuals[0].span)});
  return call.value(0);
}

/// The sine or cosine of an angle, which is recorded for `check_usage`.
Value of_angle(const BuiltinCall& call, Operation operation) {
  const Value result = of_plain(call, operation);
  if (!result.failed())
    call.reading.record.angles.push_back({call.value(0).x, call.reading.calls.blame(call.actuals[0].span)});
  return result;
}

Value gradient(const BuiltinCall& call) {
  if (!call.number(0)) return call.failed();
  const auto along = [&](std::uint32_t axis) {
    return call.terms().add({.kind = TermKind::gradient, .a = call.value(0).x, .index = axis, .span = call.span});
  };
  const auto length_dimension = call.reading.names->dimension("length");
  return {.type = Value::Type::vector,
          .x = along(0),
          .y = along(1),
          .dimension = call.value(0).dimension / length_dimension,
          .span = call.span};
}

Value peak(const BuiltinCall& call) {
  if (!call.number(0)) return call.failed();
  if (const auto dependence = call.terms().dependence(call.value(0).x); dependence.changing())
    return call.reading.calls.report(
        Code::wrong_rate, call.actuals[0].span,
        fmt::format("`peak` takes a height that depends on the place only, but this changes with {}",
                    what_changes(dependence)),
        "", "let the height depend on `x` and `y` only; multiply the force by whatever changes");
  return call.scalar(call.terms().add({.kind = TermKind::peak, .a = call.value(0).x, .span = call.span}),
                     call.value(0).dimension);
}

Value hold(const BuiltinCall& call) {
  if (!call.number(1)) return call.failed();
  if (call.value(0).dimension != call.value(1).dimension) return call.mismatched(1, 0);
  if (call.value(0).type != Value::Type::number && !call.is_vector(0)) return call.failed();
  call.reading.record.usual.push_back({.name = "ceiling",
                                       .value = call.value(1).x,
                                       .low = 0,
                                       .high = std::numeric_limits<double>::infinity(),
                                       .dimension = call.value(1).dimension,
                                       .span = call.reading.calls.blame(call.actuals[1].span)});
  return held(call.terms(), call.value(0), call.value(1).x, call.span);
}

Value arctangent(const BuiltinCall& call) {
  if (!call.number(0) || !call.number(1)) return call.failed();
  if (call.value(0).dimension != call.value(1).dimension) return call.mismatched(0, 1);
  return call.scalar(call.terms().apply(Operation::arctangent, call.value(0).x, call.value(1).x, call.span));
}

/// `lattice(…)`: a fixed random number for a point with whole coordinates; missing coordinates are 0.
Value lattice(const BuiltinCall& call) {
  TermId place[3];
  for (std::size_t i = 0; i < 3; ++i) {
    if (call.actuals[i].given && !call.plain(i)) return call.failed();
    place[i] = call.actuals[i].given ? call.value(i).x : call.terms().literal(0, call.span);
    if (call.actuals[i].given)
      call.reading.record.cycles.push_back({place[i], false, call.reading.calls.blame(call.actuals[i].span)});
  }
  return call.scalar(call.terms().apply(Operation::hash, place[0], place[1], place[2], call.span));
}

}  // namespace

Value held(Terms& terms, const Value& value, TermId ceiling, Span span) {
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms.apply(operation, a, b, span); };
  Value result{.type = value.type, .dimension = value.dimension, .span = span};
  if (value.type == Value::Type::number) {
    result.x = apply(Operation::limit, value.x, ceiling);
    return result;
  }
  const TermId square =
      apply(Operation::add, apply(Operation::multiply, value.x, value.x), apply(Operation::multiply, value.y, value.y));
  const TermId size = terms.apply(Operation::square_root, square, span);
  const TermId factor = apply(Operation::minimum, terms.literal(1, span), apply(Operation::divide, ceiling, size));
  result.x = apply(Operation::limit, apply(Operation::multiply, value.x, factor), ceiling);
  result.y = apply(Operation::limit, apply(Operation::multiply, value.y, factor), ceiling);
  return result;
}

const std::vector<Builtin>& builtins() {
  using Call = const BuiltinCall&;
  static const std::vector<Builtin> all{
      {"abs", {"value"}, 1, absolute},
      {"floor", {"value"}, 1, [](Call call) { return of_plain(call, Operation::floor); }},
      {"sqrt", {"value"}, 1, square_root},
      {"sin", {"angle"}, 1, [](Call call) { return of_angle(call, Operation::sine); }},
      {"cos", {"angle"}, 1, [](Call call) { return of_angle(call, Operation::cosine); }},
      {"atan2", {"y", "x"}, 2, arctangent},
      {"exp", {"value"}, 1, [](Call call) { return of_plain(call, Operation::exp2, log2_e); }},
      {"log", {"value"}, 1, [](Call call) { return logarithm(call, ln_2); }},
      {"log2", {"value"}, 1, [](Call call) { return logarithm(call, 1); }},
      {"log10", {"value"}, 1, [](Call call) { return logarithm(call, log10_2); }},
      {"normal", {"value"}, 1, [](Call call) { return of_plain(call, Operation::normal); }},
      {"lattice", {"a", "b", "c"}, 1, lattice},
      {"min", {"a", "b"}, 2, [](Call call) { return extreme(call, Operation::minimum); }},
      {"max", {"a", "b"}, 2, [](Call call) { return extreme(call, Operation::maximum); }},
      {"vector", {"x", "y"}, 2, vector},
      {"length", {"vector"}, 1, length},
      {"dot", {"a", "b"}, 2, dot},
      {"normalise", {"vector"}, 1, normalise},
      {"within", {"value", "low", "high"}, 3, within},
      {"usual", {"value", "low", "high"}, 2, usual},
      {"grad", {"height"}, 1, gradient, true},
      {"peak", {"value"}, 1, peak, true},
      {"hold", {"value", "ceiling"}, 2, hold},
      {"phase", {"frequency"}, 1, phase, true},
      {"stretch", {"place", "reach"}, 2, stretch, true},
      {"image", {"file", "scale", "height", "smooth"}, 3, image, true},
      {"relief", {"file", "scale", "height", "smooth"}, 3, relief},
      {"table", {"file", "place", "value"}, 1, table},
  };
  return all;
}

const Builtin* builtin_named(std::string_view name) {
  static const auto by_name = [] {
    std::unordered_map<std::string_view, const Builtin*> all;
    for (const Builtin& each : builtins()) all.emplace(each.name, &each);
    return all;
  }();
  const auto found = by_name.find(name);
  return found == by_name.end() ? nullptr : found->second;
}

bool is_builtin_function(std::string_view name) { return name == "curve" || builtin_named(name) != nullptr; }

}  // namespace wale
