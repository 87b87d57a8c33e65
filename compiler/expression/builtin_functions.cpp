#include "compiler/expression/builtin_functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wale {

namespace {

constexpr double log2_e = 1.4426950408889634, log10_2 = 0.30102999566398120, ln_2 = 0.69314718055994531;

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
  using Call = const BuiltinFunctions&;
  static const std::vector<Builtin> table{
      {"abs", {"value"}, 1, [](Call of) { return of.absolute(); }},
      {"floor", {"value"}, 1, [](Call of) { return of.of_plain(Operation::floor); }},
      {"sqrt", {"value"}, 1, [](Call of) { return of.square_root(); }},
      {"sin", {"angle"}, 1, [](Call of) { return of.of_plain(Operation::sine); }},
      {"cos", {"angle"}, 1, [](Call of) { return of.of_plain(Operation::cosine); }},
      {"atan2", {"y", "x"}, 2, [](Call of) { return of.arctangent(); }},
      {"exp", {"value"}, 1, [](Call of) { return of.of_plain(Operation::exp2, log2_e); }},
      {"log", {"value"}, 1, [](Call of) { return of.of_plain(Operation::log2, 1, ln_2); }},
      {"log2", {"value"}, 1, [](Call of) { return of.of_plain(Operation::log2); }},
      {"log10", {"value"}, 1, [](Call of) { return of.of_plain(Operation::log2, 1, log10_2); }},
      {"normal", {"value"}, 1, [](Call of) { return of.of_plain(Operation::normal); }},
      {"lattice", {"a", "b", "c"}, 1, [](Call of) { return of.lattice(); }},
      {"min", {"a", "b"}, 2, [](Call of) { return of.extreme(Operation::minimum); }},
      {"max", {"a", "b"}, 2, [](Call of) { return of.extreme(Operation::maximum); }},
      {"vector", {"x", "y"}, 2, [](Call of) { return of.vector(); }},
      {"length", {"vector"}, 1, [](Call of) { return of.length(); }},
      {"dot", {"a", "b"}, 2, [](Call of) { return of.dot(); }},
      {"normalise", {"vector"}, 1, [](Call of) { return of.normalise(); }},
      {"within", {"value", "low", "high"}, 3, [](Call of) { return of.within(); }},
      {"grad", {"height"}, 1, [](Call of) { return of.gradient(); }, true},
      {"peak", {"value"}, 1, [](Call of) { return of.peak(); }, true},
      {"hold", {"value", "ceiling"}, 2, [](Call of) { return of.hold(); }},
      {"phase", {"frequency"}, 1, [](Call of) { return of.phase(); }, true},
      {"image", {"file", "scale", "height", "smooth"}, 3, [](Call of) { return of.image(); }, true},
      {"relief", {"file", "scale", "height", "smooth"}, 3, [](Call of) { return of.relief(); }},
      {"table", {"file", "place", "value"}, 1, [](Call of) { return of.table(); }},
  };
  return table;
}

const Builtin* builtin_named(const NameKey& name) {
  static const auto index = [] {
    NameIndex<const Builtin*> by_name;
    for (const Builtin& each : builtins()) by_name.add(each.name, &each);
    return by_name;
  }();
  const auto* found = index.find(name);
  return found ? *found : nullptr;
}

bool is_builtin_function(const NameKey& name) { return name.name == "curve" || builtin_named(name) != nullptr; }

bool BuiltinFunctions::number(std::size_t i) const {
  if (value(i).type == Value::Type::number) return true;
  checker.report(Code::wrong_type, actuals[i].span,
                 fmt::format("a number is due here, not {}", type_words(value(i).type)), "",
                 value(i).type == Value::Type::vector ? "take its `length(…)`, or work with `x` and `y`"
                                                      : "give a number, with its unit if it has one");
  return false;
}
bool BuiltinFunctions::plain(std::size_t i) const {
  if (!number(i)) return false;
  if (value(i).dimension.plain()) return true;
  const auto& dimension = value(i).dimension;
  checker.report(Code::wrong_dimension, actuals[i].span,
                 fmt::format("a plain number is due here, not {}", checker.names().words(dimension)),
                 checker.names().unit(dimension),
                 fmt::format("divide it by a quantity of its own dimension, such as `/ 1 {}`",
                             customary_unit(checker.declarations(), dimension)));
  return false;
}

Value BuiltinFunctions::of_plain(Operation operation, double before, double after) const {
  if (!plain(0)) return failed();
  TermId x = before == 1 ? value(0).x : scaled(value(0).x, before);
  x = terms().apply(operation, x, span);
  return scalar(after == 1 ? x : scaled(x, after));
}

Value BuiltinFunctions::absolute() const {
  if (!number(0)) return failed();
  return scalar(terms().apply(Operation::absolute, value(0).x, span), value(0).dimension);
}

Value BuiltinFunctions::square_root() const {
  if (!number(0)) return failed();
  const auto root = power(value(0).dimension, 1, 2);
  if (!root)
    return checker.report(Code::wrong_dimension, actuals[0].span,
                          fmt::format("the root of {} has no dimension", checker.names().words(value(0).dimension)), "",
                          "divide it by a quantity of its own dimension first");
  return scalar(terms().apply(Operation::square_root, value(0).x, span), *root);
}

Value BuiltinFunctions::extreme(Operation operation) const {
  if (!number(0) || !number(1)) return failed();
  if (value(0).dimension != value(1).dimension) return mismatched(0, 1);
  return scalar(terms().apply(operation, value(0).x, value(1).x, span), value(0).dimension);
}

Value BuiltinFunctions::mismatched(std::size_t a, std::size_t b) const {
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

Value BuiltinFunctions::vector() const {
  if (!number(0) || !number(1)) return failed();
  if (value(0).dimension != value(1).dimension) return mismatched(0, 1);
  return {.type = Value::Type::vector, .x = value(0).x, .y = value(1).x, .dimension = value(0).dimension, .span = span};
}

bool BuiltinFunctions::is_vector(std::size_t i) const {
  if (value(i).type == Value::Type::vector) return true;
  checker.report(Code::wrong_type, actuals[i].span,
                 fmt::format("a vector is due here, not {}", type_words(value(i).type)), "",
                 "give both parts, as in `vector(a, b)`");
  return false;
}

TermId BuiltinFunctions::dot_product(const Value& a, const Value& b) const {
  return terms().apply(Operation::add, terms().apply(Operation::multiply, a.x, b.x, span),
                       terms().apply(Operation::multiply, a.y, b.y, span), span);
}

Value BuiltinFunctions::dot() const {
  if (!is_vector(0) || !is_vector(1)) return failed();
  return scalar(dot_product(value(0), value(1)), value(0).dimension * value(1).dimension);
}

Value BuiltinFunctions::length() const {
  if (!is_vector(0)) return failed();
  return scalar(terms().apply(Operation::square_root, dot_product(value(0), value(0)), span), value(0).dimension);
}

/// A vector's direction. Squares of what is shorter than about 1e-19 flush to zero, so that its length would be too
/// small and its direction too long; that is no direction at all.
Value BuiltinFunctions::normalise() const {
  if (!is_vector(0)) return failed();
  constexpr double shortest = 1e-15;  // in units of SI, whatever the dimension
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms().apply(operation, a, b, span); };
  const TermId size = terms().apply(Operation::square_root, dot_product(value(0), value(0)), span);
  const TermId has_direction = apply(Operation::less, terms().literal(shortest, span), size);
  const auto share = [&](TermId part) {
    return terms().apply(Operation::select, has_direction, apply(Operation::divide, part, size),
                         terms().literal(0, span), span);
  };
  return {.type = Value::Type::vector, .x = share(value(0).x), .y = share(value(0).y), .span = span};
}

/// A number held between two constants; a constant outside them is an error.
Value BuiltinFunctions::within() const {
  if (!number(0) || !number(1) || !number(2)) return failed();
  for (const std::size_t bound : {1, 2})
    if (value(bound).dimension != value(0).dimension) return mismatched(bound, 0);
  using Question = WrittenOut::Question;
  for (const std::size_t bound : {1, 2}) checker.ask_of(value(bound).x);
  const auto known = constant_value(terms(), value(0).x);
  const auto low = constant_value(terms(), value(1).x), high = constant_value(terms(), value(2).x);
  if (low && high) checker.ask({Question::About::range, value(0).x, *low, *high});
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

Value BuiltinFunctions::gradient() const {
  if (!number(0)) return failed();
  const auto along = [&](std::uint32_t axis) {
    return terms().add({.kind = TermKind::gradient, .a = value(0).x, .index = axis, .span = span});
  };
  const auto length_dimension = checker.declarations().dimension("length");
  return {.type = Value::Type::vector,
          .x = along(0),
          .y = along(1),
          .dimension = value(0).dimension / length_dimension,
          .span = span};
}

Value BuiltinFunctions::peak() const {
  if (!number(0)) return failed();
  checker.ask({WrittenOut::Question::About::change, value(0).x});
  if (const auto dependence = terms().dependence(value(0).x); dependence.changing())
    return checker.report(
        Code::wrong_rate, actuals[0].span,
        fmt::format("a peak is taken over places, and this changes with {}", what_changes(dependence)), "",
        "let the height depend on `x` and `y` only; what changes may multiply the force");
  return scalar(terms().add({.kind = TermKind::peak, .a = value(0).x, .span = span}), value(0).dimension);
}

Value BuiltinFunctions::hold() const {
  if (!number(1)) return failed();
  if (value(0).dimension != value(1).dimension) return mismatched(1, 0);
  if (value(0).type != Value::Type::number && !is_vector(0)) return failed();
  return held(terms(), value(0), value(1).x, span);
}

std::optional<double> BuiltinFunctions::constant_argument(std::size_t i, const Dimension& dimension,
                                                          const char* example) const {
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
  checker.ask_of(value(i).x);
  const auto known = constant_value(terms(), value(i).x);
  if (!known)
    checker.report(Code::not_constant, actuals[i].span, "a value known at compile time is due here", "it may change",
                   "use numbers, units and constants; no parameters and no places");
  return known;
}

Value BuiltinFunctions::arctangent() const {
  if (!number(0) || !number(1)) return failed();
  if (value(0).dimension != value(1).dimension) return mismatched(0, 1);
  return scalar(terms().apply(Operation::arctangent, value(0).x, value(1).x, span));
}

/// A fixed random number for a point of the lattice of whole numbers; what is not given is 0.
Value BuiltinFunctions::lattice() const {
  TermId place[3];
  for (std::size_t i = 0; i < 3; ++i) {
    if (actuals[i].given && !plain(i)) return failed();
    place[i] = actuals[i].given ? value(i).x : terms().literal(0, span);
  }
  return scalar(terms().apply(Operation::hash, place[0], place[1], place[2], span));
}

/// An accumulator of its own that runs from 0 to 1 `frequency` times a second.
Value BuiltinFunctions::phase() const {
  if (!number(0)) return failed();
  const auto frequency = checker.declarations().dimension("frequency");
  if (value(0).dimension != frequency)
    return checker.report(
        Code::wrong_dimension, actuals[0].span,
        fmt::format("a frequency is due here, not {}", with_article(checker.names().words(value(0).dimension))),
        checker.names().unit(value(0).dimension), "write something like `phase(2 Hz)`");
  const auto [known, added] = checker.phases_.try_emplace(value(0).x, 0);
  if (added) {
    const auto index = static_cast<std::uint32_t>(checker.states_.size());
    const TermId now = terms().add({.kind = TermKind::state, .index = index, .span = span});
    const TermId step = terms().apply(Operation::multiply, value(0).x, terms().input(Input::seconds_per_tick), span);
    const TermId sum = terms().apply(Operation::add, now, step, span);
    const TermId next = terms().apply(Operation::subtract, sum, terms().apply(Operation::floor, sum, span), span);
    checker.states_.push_back({.name = fmt::format("phase {}", index),
                               .low = 0,
                               .high = 1,
                               .initial = terms().literal(0, span),
                               .next = next,
                               .span = span});
    known->second = now;
  }
  return scalar(known->second);
}

/// A relief asked where the hand is.
Value BuiltinFunctions::image() const {
  const Value field = relief();
  if (field.failed()) return field;
  const Value hand{.type = Value::Type::vector,
                   .x = terms().input(Input::x, span),
                   .y = terms().input(Input::y, span),
                   .dimension = checker.declarations().dimension("length"),
                   .span = span};
  return checker.at(*field.field, hand, span);
}

}  // namespace wale
