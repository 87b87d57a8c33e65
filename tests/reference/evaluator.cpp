#include "tests/reference/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "tests/reference/bounded_arithmetic.hpp"

namespace wale::reference {

namespace {

using Dimension = std::array<double, 3>;

struct Unit {
  double size;
  Dimension dimension;
};

// From the SI brochure and NIST SP 811, not from schema/units.wale.
const std::map<std::string, Unit> units{
    {"m", {1, {1, 0, 0}}},
    {"km", {1e3, {1, 0, 0}}},
    {"cm", {1e-2, {1, 0, 0}}},
    {"mm", {1e-3, {1, 0, 0}}},
    {"um", {1e-6, {1, 0, 0}}},
    {"inch", {0.0254, {1, 0, 0}}},
    {"kg", {1, {0, 1, 0}}},
    {"g", {1e-3, {0, 1, 0}}},
    {"mg", {1e-6, {0, 1, 0}}},
    {"s", {1, {0, 0, 1}}},
    {"ms", {1e-3, {0, 0, 1}}},
    {"us", {1e-6, {0, 0, 1}}},
    {"Hz", {1, {0, 0, -1}}},
    {"kHz", {1e3, {0, 0, -1}}},
    {"N", {1, {1, 1, -2}}},
    {"mN", {1e-3, {1, 1, -2}}},
    {"kN", {1e3, {1, 1, -2}}},
    {"gf", {9.80665e-3, {1, 1, -2}}},
    {"J", {1, {2, 1, -2}}},
    {"mJ", {1e-3, {2, 1, -2}}},
    {"W", {1, {2, 1, -3}}},
    {"Pa", {1, {-1, 1, -2}}},
    {"pu", {10.0 / 512, {1, 1, -2}}},
    {"ozf", {9.80665e-3 * 28.349523125, {1, 1, -2}}},
    {"rad", {1, {}}},
    {"deg", {std::acos(-1.0) / 180, {}}},
    {"%", {0.01, {}}},
    {"counts", {1, {}}},
};

using Names = std::map<std::string, Quantity>;

std::string text_of(const Word& word) { return std::string(word.text); }

Quantity number(double value, Dimension dimension = {}, double error = -1) {
  return {Quantity::Type::number, {value, 0}, {error < 0 ? std::abs(value) * rounding : error, 0}, dimension};
}

void require(bool good, const char* what) {
  if (!good) throw std::runtime_error(what);
}

Dimension sum(const Dimension& a, const Dimension& b, double factor = 1) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// One component of a quantity, and its bound.
Component part(const Quantity& of, int i) { return {of.value[i], of.error[i]}; }

class Evaluator {
 public:
  Evaluator(const SyntaxTree& tree, const HandState& hand) : tree_(tree), hand_(hand) {}

  Quantity evaluate(ExprId id, const Names& names) {
    return std::visit([&](const auto& node) { return (*this)(node, names); }, tree_.expr(id));
  }

  /// `force = … limit …`: the force's length is limited, its direction is kept.
  Quantity limited(const Quantity& force, const Quantity& ceiling) {
    require(force.type == Quantity::Type::vector && ceiling.type == Quantity::Type::number &&
                force.dimension == ceiling.dimension,
            "no limit of that force");
    const Component x = part(force, 0), y = part(force, 1);
    const Component size = square_root(add(multiply(x, x), multiply(y, y)));
    return product(force, of(smaller({1, 0}, divide(part(ceiling, 0), size))), false);
  }

 private:
  Quantity operator()(const NumberLiteral& node, const Names& names) {
    Quantity result = number(node.value);
    double size = 1;
    for (const auto& factor : tree_.suffix(node)) {
      const double exponent = factor.divides ? -factor.exponent : factor.exponent;
      if (const auto unit = units.find(text_of(factor.name)); unit != units.end()) {
        size *= std::pow(unit->second.size, exponent);
        result.dimension = sum(result.dimension, unit->second.dimension, exponent);
        continue;
      }
      require(factor.exponent == 1, "a power of a name behind a number");
      result = number(result.value[0] * size, result.dimension);
      size = 1;
      result = product(result, lookup(text_of(factor.name), names), factor.divides);
    }
    return size == 1 ? result : number(result.value[0] * size, result.dimension);
  }

  Quantity operator()(const NameUse& node, const Names& names) { return lookup(std::string(node.name), names); }

  Quantity operator()(const Unary& node, const Names& names) {
    Quantity result = evaluate(node.operand, names);
    if (node.op == UnaryOperator::complement) {
      require(result.type == Quantity::Type::condition, "not before no condition");
      result.value[0] = 1 - result.value[0];
      return result;
    }
    require(result.type != Quantity::Type::condition, "a sign before a condition");
    if (node.op == UnaryOperator::negate)
      for (double& value : result.value) value = -value;
    return result;
  }

  Quantity operator()(const Binary& node, const Names& names) {
    const Quantity a = evaluate(node.left, names), b = evaluate(node.right, names);
    switch (node.op) {
      case BinaryOperator::multiply: return product(a, b, false);
      case BinaryOperator::divide: return product(a, b, true);
      case BinaryOperator::power: return raised(a, b);
      case BinaryOperator::add: return parts(a, b, add);
      case BinaryOperator::subtract: return parts(a, b, [](Component p, Component q) { return add(p, negated(q)); });
      case BinaryOperator::less: return compared(a, b, true, true);
      case BinaryOperator::less_equal: return compared(a, b, true, false);
      case BinaryOperator::greater: return compared(a, b, false, true);
      case BinaryOperator::greater_equal: return compared(a, b, false, false);
      case BinaryOperator::conjunction: return joined(a, b, true);
      case BinaryOperator::disjunction: return joined(a, b, false);
    }
    throw std::runtime_error("an operator");
  }

  Quantity operator()(const Conditional& node, const Names& names) {
    // Both sides are checked, and one is taken. If the other is undecided, that does not matter.
    const Quantity condition = evaluate(node.condition, names);
    require(condition.type == Quantity::Type::condition, "no condition");
    return evaluate(condition.value[0] != 0 ? node.yes : node.no, names);
  }

  Quantity operator()(const Call& node, const Names& names) {
    for (const auto& declaration : tree_.declarations)
      if (const auto* function = std::get_if<FunctionDecl>(&declaration);
          function && function->name.text == node.callee.text) {
        Names inner;
        std::size_t position = 0;
        for (const auto& argument : tree_.arguments(node)) {
          const std::string formal =
              std::string(argument.name ? argument.name->text : function->parameters.at(position++).name.text);
          inner[formal] = evaluate(argument.value, names);
        }
        for (const auto& formal : function->parameters)
          if (!inner.contains(text_of(formal.name)))
            inner[text_of(formal.name)] = evaluate(formal.default_value.value(), {});
        return evaluate(function->body, inner);
      }
    std::vector<Quantity> arguments;
    for (const auto& argument : tree_.arguments(node)) arguments.push_back(evaluate(argument.value, names));
    return built_in(text_of(node.callee), arguments);
  }

  Quantity operator()(const Part& node, const Names& names) {
    return component(evaluate(node.whole, names), node.part);
  }

  static Quantity component(const Quantity& whole, char which) {
    require(whole.type == Quantity::Type::vector, "a part of no vector");
    const int i = which == 'x' ? 0 : 1;
    return {Quantity::Type::number, {whole.value[i], 0}, {whole.error[i], 0}, whole.dimension};
  }

  static Quantity joined(const Quantity& a, const Quantity& b, bool both) {
    require(a.type == Quantity::Type::condition && b.type == Quantity::Type::condition, "no conditions");
    const bool p = a.value[0] != 0, q = b.value[0] != 0;
    return {Quantity::Type::condition, {(both ? p && q : p || q) ? 1.0 : 0.0, 0}, {}, {}};
  }

  Quantity operator()(const TextLiteral&, const Names&) { throw std::runtime_error("a text"); }
  Quantity operator()(const Erroneous&, const Names&) { throw std::runtime_error("an error"); }

  Quantity lookup(const std::string& name, const Names& names) {
    if (const auto known = names.find(name); known != names.end()) return known->second;
    if (name == "x") return number(hand_.x, {1, 0, 0}, 0);
    if (name == "y") return number(hand_.y, {1, 0, 0}, 0);
    if (name == "hand") return {Quantity::Type::vector, {hand_.x, hand_.y}, {}, {1, 0, 0}};
    if (name == "velocity") return {Quantity::Type::vector, {hand_.vx, hand_.vy}, {}, {1, 0, -1}};
    if (name == "acceleration") return {Quantity::Type::vector, {hand_.ax, hand_.ay}, {}, {1, 0, -2}};
    if (name == "time") return number(hand_.time, {0, 0, 1});
    if (name == "dt") return number(hand_.seconds_per_tick, {0, 0, 1});
    if (name == "button") return {Quantity::Type::condition, {hand_.button ? 1.0 : 0.0, 0}, {}, {}};
    if (name == "true" || name == "false") return {Quantity::Type::condition, {name == "true" ? 1.0 : 0.0, 0}, {}, {}};
    if (name == "pi") return number(std::acos(-1.0));
    if (const auto dot = name.rfind('.'); dot != std::string::npos)
      return component(lookup(name.substr(0, dot), names), name.back());
    for (const auto& declaration : tree_.declarations)
      if (const auto* constant = std::get_if<Constant>(&declaration); constant && constant->name.text == name)
        return evaluate(constant->value, {});
    throw std::runtime_error("no name " + name);
  }

  template <typename F>
  Quantity parts(const Quantity& a, const Quantity& b, F f) {
    require(a.type == b.type && a.type != Quantity::Type::condition && a.dimension == b.dimension, "unlike operands");
    Quantity result = a;
    for (int i = 0; i < (a.type == Quantity::Type::vector ? 2 : 1); ++i) {
      const Component p = f(part(a, i), part(b, i));
      result.value[i] = p.value;
      result.error[i] = p.error;
    }
    return result;
  }

  Quantity of(Component part, const Dimension& dimension = {}) {
    return {Quantity::Type::number, {part.value, 0}, {part.error, 0}, dimension};
  }

  Quantity product(const Quantity& a, const Quantity& b, bool divides) {
    require(a.type != Quantity::Type::condition && b.type != Quantity::Type::condition, "a condition in a product");
    require(a.type == Quantity::Type::number || b.type == Quantity::Type::number, "two vectors multiplied");
    require(!divides || b.type == Quantity::Type::number, "divided by a vector");
    Quantity result;
    const bool vector = a.type == Quantity::Type::vector || b.type == Quantity::Type::vector;
    result.type = vector ? Quantity::Type::vector : Quantity::Type::number;
    result.dimension = sum(a.dimension, b.dimension, divides ? -1 : 1);
    for (int i = 0; i < (vector ? 2 : 1); ++i) {
      const Component left = part(a, a.type == Quantity::Type::vector ? i : 0);
      const Component right = part(b, b.type == Quantity::Type::vector ? i : 0);
      const Component p = divides ? divide(left, right) : multiply(left, right);
      result.value[i] = p.value;
      result.error[i] = p.error;
    }
    return result;
  }

  Quantity compared(const Quantity& a, const Quantity& b, bool less_than, bool) {
    require(a.type == Quantity::Type::number && b.type == Quantity::Type::number && a.dimension == b.dimension,
            "unlike sides");
    // Ties are undecided, so whether equality counts makes no difference here.
    const bool holds = less_than ? less(part(a, 0), part(b, 0)) : less(part(b, 0), part(a, 0));
    return {Quantity::Type::condition, {holds ? 1.0 : 0.0, 0}, {}, {}};
  }

  Quantity raised(const Quantity& base, const Quantity& exponent) {
    require(base.type == Quantity::Type::number && exponent.type == Quantity::Type::number, "a power of no number");
    require(exponent.dimension == Dimension{}, "an exponent with a dimension");
    const double power = exponent.value[0];
    const Dimension dimension = sum({}, base.dimension, power);
    if (power == 0.5) return of(square_root(part(base, 0)), dimension);
    if (power == std::floor(power) && std::abs(power) <= 16) {
      Component product{1, 0};
      for (int i = 0; i < std::abs(power); ++i) product = multiply(product, part(base, 0));
      return of(power < 0 ? divide({1, 0}, product) : product, dimension);
    }
    return of(exponential(multiply(part(exponent, 0), logarithm(part(base, 0), 2)), 2), dimension);
  }

  /// Arguments by position, each as schema/LANGUAGE.md describes the function.
  Quantity built_in(const std::string& name, const std::vector<Quantity>& arguments) {
    const auto scalar = [&](std::size_t i) {
      require(arguments.at(i).type == Quantity::Type::number, "a number is due");
      return part(arguments[i], 0);
    };
    const auto plain = [&](std::size_t i) {
      require(arguments.at(i).dimension == Dimension{}, "a plain number is due");
      return scalar(i);
    };
    const auto dimension = [&](std::size_t i) { return arguments.at(i).dimension; };
    const auto alike = [&] {
      for (const auto& argument : arguments) require(argument.dimension == arguments[0].dimension, "unlike arguments");
    };
    constexpr double e = 2.718281828459045;
    if (name == "atan2") {
      alike();
      const Component y = scalar(0), x = scalar(1);
      const double size = std::hypot(x.value, y.value), error = x.error + y.error;
      // At the cut the angle jumps by a whole turn. Near the middle it may have any value.
      if (size <= 4 * error || (x.value < 0 && std::abs(y.value) <= y.error)) throw Undecided{};
      return of(rounded(std::atan2(y.value, x.value), error / (size - 2 * error) + function_rounding));
    }
    if (name == "sign") {
      if (std::abs(scalar(0).value) <= scalar(0).error) throw Undecided{};
      return of({scalar(0).value > 0 ? 1.0 : -1.0, 0});
    }
    if (name == "round") return of(floor_of(add(plain(0), {0.5, 0})));
    if (name == "ceil") return of(negated(floor_of(negated(plain(0)))));
    if (name == "fract") return of(add(plain(0), negated(floor_of(plain(0)))));
    if (name == "tanh") return of(smooth(std::tanh(plain(0).value), plain(0), 1));
    if (name == "mix") {
      const Quantity rise =
          parts(arguments.at(1), arguments.at(0), [](Component p, Component q) { return add(p, negated(q)); });
      return parts(arguments[0], product(rise, of(plain(2)), false), add);
    }
    if (name == "abs") return of({std::abs(scalar(0).value), scalar(0).error}, dimension(0));
    if (name == "floor") return of(floor_of(plain(0)));
    if (name == "sqrt") return of(square_root(scalar(0)), sum({}, dimension(0), 0.5));
    if (name == "sin") return of(smooth(std::sin(plain(0).value), plain(0), 1));
    if (name == "cos") return of(smooth(std::cos(plain(0).value), plain(0), 1));
    if (name == "exp") return of(exponential(plain(0), e));
    if (name == "log") return of(logarithm(plain(0), e));
    if (name == "log2") return of(logarithm(plain(0), 2));
    if (name == "log10") return of(logarithm(plain(0), 10));
    if (name == "normal") return of(smooth(0.5 * std::erfc(-plain(0).value / std::sqrt(2.0)), plain(0), 0.4));
    if (name == "min" || name == "max") {
      alike();
      return of(name == "min" ? smaller(scalar(0), scalar(1)) : larger(scalar(0), scalar(1)), dimension(0));
    }
    if (name == "clamp") {
      alike();
      return of(smaller(larger(scalar(0), scalar(1)), scalar(2)), dimension(0));
    }
    if (name == "smoothstep") {
      const Component t = smaller(larger(plain(0), {0, 0}), {1, 0});
      return of(multiply(multiply(t, t), add({3, 0}, negated(multiply({2, 0}, t)))));
    }
    if (name == "modulo") {
      alike();
      const Component whole = floor_of(divide(scalar(0), scalar(1)));
      return of(add(scalar(0), negated(multiply(scalar(1), whole))), dimension(0));
    }
    return of_vectors(name, arguments);
  }

  static Component dot(const Quantity& a, const Quantity& b) {
    require(a.type == Quantity::Type::vector && b.type == Quantity::Type::vector, "a vector is due");
    return add(multiply(part(a, 0), part(b, 0)), multiply(part(a, 1), part(b, 1)));
  }

  /// Those of `built_in` that take or give vectors.
  Quantity of_vectors(const std::string& name, const std::vector<Quantity>& arguments) {
    const auto dimension = [&](std::size_t i) { return arguments.at(i).dimension; };
    if (name == "rotate") {
      require(arguments.at(0).type == Quantity::Type::vector, "a vector is due");
      require(arguments.at(1).type == Quantity::Type::number && dimension(1) == Dimension{}, "an angle is due");
      const Component angle = part(arguments[1], 0);
      const Component cosine = smooth(std::cos(angle.value), angle, 1), sine = smooth(std::sin(angle.value), angle, 1);
      const Component vx = part(arguments[0], 0), vy = part(arguments[0], 1);
      const Component x = add(multiply(vx, cosine), negated(multiply(vy, sine)));
      const Component y = add(multiply(vx, sine), multiply(vy, cosine));
      return {Quantity::Type::vector, {x.value, y.value}, {x.error, y.error}, dimension(0)};
    }
    if (name == "normalise") {
      const Component size = square_root(dot(arguments.at(0), arguments.at(0)));
      return product(arguments[0], of(size, dimension(0)), true);
    }
    if (name == "vector") {
      require(arguments.at(0).type == Quantity::Type::number && arguments.at(1).type == Quantity::Type::number &&
                  dimension(0) == dimension(1),
              "two alike numbers are due");
      const Component vx = part(arguments[0], 0), vy = part(arguments[1], 0);
      return {Quantity::Type::vector, {vx.value, vy.value}, {vx.error, vy.error}, dimension(0)};
    }
    if (name == "dot") return of(dot(arguments.at(0), arguments.at(1)), sum(dimension(0), dimension(1)));
    if (name == "length") return of(square_root(dot(arguments.at(0), arguments.at(0))), dimension(0));
    if (name == "viscous") {
      require(dimension(0) == Dimension{0, 1, -1}, "a viscosity is due");
      return product(arguments[0], {Quantity::Type::vector, {-hand_.vx, -hand_.vy}, {}, {1, 0, -1}}, false);
    }
    if (name == "spring") {
      require(dimension(0) == Dimension{0, 1, -2}, "a stiffness is due");
      return product(arguments[0], {Quantity::Type::vector, {-hand_.x, -hand_.y}, {}, {1, 0, 0}}, false);
    }
    throw std::runtime_error("no function " + name);
  }

  const SyntaxTree& tree_;
  HandState hand_;
};

/// The range of a state, in the dimension of its initial value. A state without a declared range gets a wide one.
std::array<double, 2> range_of(Evaluator& evaluator, const StateStatement& state, const Names& names) {
  if (!state.range) return {-1e30, 1e30};
  return {evaluator.evaluate(state.range->low, names).value[0], evaluator.evaluate(state.range->high, names).value[0]};
}

/// Treats each component of a state's new value separately.
Quantity held(Quantity value, Evaluator& evaluator, const StateStatement& state, const Names& names) {
  const auto [low, high] = range_of(evaluator, state, names);
  for (int i = 0; i < (value.type == Quantity::Type::vector ? 2 : 1); ++i) {
    const Component within =
        larger(smaller(part(value, i), {high, std::abs(high) * rounding}), {low, std::abs(low) * rounding});
    value.value[i] = within.value;
    value.error[i] = within.error;
  }
  return value;
}

const MaterialDecl& only_material(const SyntaxTree& tree) {
  for (const auto& declaration : tree.declarations)
    if (const auto* material = std::get_if<MaterialDecl>(&declaration)) return *material;
  throw std::runtime_error("no material");
}

}  // namespace

Simulation::Simulation(const SyntaxTree& tree, std::map<std::string, double> parameters)
    : tree_(tree), parameters_(std::move(parameters)) {}

void Simulation::enter(const HandState& hand) {
  states_.clear();
  tick(hand, true);
}

Quantity Simulation::tick(const HandState& hand) { return tick(hand, false); }

Quantity Simulation::tick(const HandState& hand, bool entering) {
  Evaluator evaluator(tree_, hand);
  Names names;
  std::optional<Quantity> sum;
  const auto& statements = only_material(tree_).physical;
  // Everything except the updates reads the states of this tick.
  for (const auto& statement : statements) {
    if (const auto* param = std::get_if<ParamStatement>(&statement.what)) {
      Quantity value = evaluator.evaluate(param->value, names);
      // A parameter's value is already a float.
      if (const auto set = parameters_.find(text_of(param->name)); set != parameters_.end())
        value = number(set->second, value.dimension, 0);
      names[text_of(param->name)] = value;
    }
    if (const auto* let = std::get_if<LetStatement>(&statement.what))
      names[text_of(let->name)] = evaluator.evaluate(let->value, names);
    if (const auto* state = std::get_if<StateStatement>(&statement.what)) {
      if (entering)
        states_[text_of(state->name)] = held(evaluator.evaluate(state->value, names), evaluator, *state, names);
      names[text_of(state->name)] = states_.at(text_of(state->name));
    }
    if (const auto* force = std::get_if<ForceStatement>(&statement.what)) {
      Quantity term = evaluator.evaluate(force->value, names);
      if (force->limit) term = evaluator.limited(term, evaluator.evaluate(*force->limit, names));
      require(term.type == Quantity::Type::vector && term.dimension == Dimension{1, 1, -2}, "no force");
      if (force->name) names[text_of(*force->name)] = term;
      if (sum)
        for (int i = 0; i < 2; ++i) {
          const Component added = add(part(*sum, i), part(term, i));
          sum->value[i] = added.value;
          sum->error[i] = added.error;
        }
      else
        sum = term;
    }
  }
  if (entering) return {};
  // Updates run in order, and a state updated above reads as its new value.
  Names updating = names;
  for (const auto& statement : statements)
    if (const auto* update = std::get_if<UpdateStatement>(&statement.what)) {
      const Quantity before = names.at(text_of(update->name)), change = evaluator.evaluate(update->value, updating);
      Quantity after = change;
      for (int i = 0; i < (before.type == Quantity::Type::vector ? 2 : 1); ++i) {
        Component next = part(change, i);
        if (update->derivative)
          next = add(part(before, i), multiply(next, {hand.seconds_per_tick, hand.seconds_per_tick * rounding}));
        after.value[i] = next.value;
        after.error[i] = next.error;
      }
      after.dimension = before.dimension;
      for (const auto& other : statements)
        if (const auto* state = std::get_if<StateStatement>(&other.what);
            state && text_of(state->name) == text_of(update->name))
          after = held(after, evaluator, *state, names);
      updating[text_of(update->name)] = states_[text_of(update->name)] = after;
    }
  require(sum.has_value(), "no material with a force");
  return *sum;
}

Quantity force(const SyntaxTree& tree, const HandState& hand, const std::map<std::string, double>& parameters) {
  Simulation simulation(tree, parameters);
  simulation.enter(hand);
  return simulation.tick(hand);
}

}  // namespace wale::reference
